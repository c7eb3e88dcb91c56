//! Visibility that gets sharper the longer it is traced.

use crate::geometry::{Geometry, Shown};
use crate::light_view::{LightView, Tally};
use crate::{Options, Tracer};
use rayon::prelude::*;
use std::sync::Arc;
use umbrage_core::{Camera, Image, Light, Texture};

/// Points of a light with an extent that a pixel gets in the first rounds; all further rounds are
/// as the last one. Few at first, so that there is a picture soon; many later, since what lies
/// between a pixel and the light is gathered once a round.
const POINTS: [u32; 6] = [4, 4, 8, 16, 32, 64];

/// The first round looks at every fourth pixel across and down, then at every second, then at all.
const COARSEST: u32 = 4;

/// Samples for each thread between two questions whether to continue: some milliseconds.
const BATCH: u32 = 2048;

/// The true visibility of a light, traced in slices: for windows, which show it while it gets
/// sharper, on a thread of their own or, in a browser, between two frames.
///
/// Round after round every pixel gets other points of the light, and the mean of all of them
/// converges to the truth without bias. Whatever the length of the slices and the number of
/// threads, the same samples give the same picture, to the bit.
///
/// ```
/// # use std::sync::Arc;
/// # use umbrage_core::scenes;
/// # use umbrage_reference::{Progressive, Tracer};
/// let scene = (scenes::find("contact").unwrap().build)(0.2);
/// let tracer = Arc::new(Tracer::new(&scene));
/// let (camera, light) = (&scene.camera, &scene.lights[0]);
/// let mut truth = Progressive::new(tracer, camera, (32, 24), light, &scene.textures);
/// while truth.samples() < 64 && truth.advance(|| false) {}
/// println!("{:?} after {} samples", truth.standard_error(), truth.samples());
/// ```
pub struct Progressive {
    tracer: Arc<Tracer>,
    camera: Camera,
    light: LightView,
    geometry: Geometry,
    /// Pixels that were looked at, whichever light there was.
    is_looked_at: Vec<bool>,
    estimates: Vec<Estimate>,
    visibility: Image<f32>,
    scored: Image<bool>,
    /// Pixels that a round visits, in its order: at first all, later those that samples decide.
    open: Vec<u32>,
    round: u32,
    /// How many of `open` this round has visited.
    done: usize,
    /// For each pixel that samples decide, in whole rounds.
    samples: u32,
}

/// What is known of a pixel's visibility.
#[derive(Clone, Copy, Default)]
struct Estimate {
    samples: u32,
    rounds: u32,
    /// No sample can change it.
    is_exact: bool,
    /// Of all samples.
    sum: f64,
    /// Sum over rounds of the samples times the round's squared mean.
    squares: f64,
}

/// What one visit to a pixel found.
struct Found {
    pixel: u32,
    /// Where the pixel had not been looked at.
    shown: Option<Shown>,
    /// `None` where the pixel is not scored.
    visibility: Option<f64>,
    is_exact: bool,
}

impl Estimate {
    fn add(&mut self, samples: u32, found: &Found, mean: f64) {
        let weight = f64::from(samples);
        self.samples += samples;
        self.rounds += 1;
        self.is_exact = found.is_exact;
        self.sum += weight * mean;
        self.squares += weight * mean * mean;
    }

    fn mean(&self) -> f64 {
        self.sum / f64::from(self.samples.max(1))
    }

    /// The square of the standard error, from how the rounds differ; `None` before the second one.
    fn variance(&self) -> Option<f64> {
        if self.is_exact {
            return Some(0.0);
        }
        let between = (self.squares - self.sum * self.mean()).max(0.0);
        let rounds = f64::from(self.rounds.checked_sub(1).filter(|rest| *rest > 0)?);
        Some(between / rounds / f64::from(self.samples))
    }
}

impl Progressive {
    /// Of what `camera` sees in `size` pixels across and down, under `light`; `textures` are the
    /// scene's. Nothing is traced yet.
    pub fn new(tracer: Arc<Tracer>, camera: &Camera, size: (u32, u32), light: &Light, textures: &[Texture]) -> Self {
        let (width, height) = size;
        let geometry = Geometry::nothing(width, height);
        let pixels = geometry.depth.data.len();
        Self {
            tracer,
            camera: camera.clone(),
            light: view(light, textures),
            geometry,
            is_looked_at: vec![false; pixels],
            estimates: vec![Estimate::default(); pixels],
            visibility: Image::filled(width, height, 0.0),
            scored: Image::filled(width, height, false),
            open: coarse_to_fine(width, height),
            round: 0,
            done: 0,
            samples: 0,
        }
    }

    /// Starts again with another light. What the camera sees stays known, so this is cheaper than a
    /// new one.
    pub fn set_light(&mut self, light: &Light, textures: &[Texture]) {
        let (width, height) = self.scored.size();
        self.light = view(light, textures);
        self.estimates.fill(Estimate::default());
        self.visibility.data.fill(0.0);
        self.scored.data.fill(false);
        self.open = coarse_to_fine(width, height);
        (self.round, self.done, self.samples) = (0, 0, 0);
    }

    /// Traces until the round ends or `go_on`, which is asked every few milliseconds, says no; at
    /// least one batch of pixels. False once more samples would change nothing: then nothing is
    /// done any more.
    ///
    /// All threads of the rayon pool that this is called in take part (`ThreadPool::install`);
    /// where there are no threads, as in browsers, the calling one does all.
    pub fn advance(&mut self, mut go_on: impl FnMut() -> bool) -> bool {
        while !self.open.is_empty() {
            self.batch();
            if self.done == 0 || !go_on() {
                break;
            }
        }
        !self.open.is_empty()
    }

    /// The mean of all samples so far, 0…1; 0 where the pixel is not scored. During the first round
    /// pixels that have none show what a neighbour above or to the left has.
    pub fn visibility(&self) -> &Image<f32> {
        &self.visibility
    }

    /// True where the pixel was looked at and is scored, as in [`crate::Truth::scored`]; whole
    /// after the first round.
    pub fn scored(&self) -> &Image<bool> {
        &self.scored
    }

    /// How many samples each pixel has that needs them, in whole rounds; 0 during the first round.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// True once every pixel has samples.
    pub fn is_whole(&self) -> bool {
        self.round > 0 || self.open.is_empty()
    }

    /// What the camera sees; `None` during the first round.
    pub fn geometry(&self) -> Option<&Geometry> {
        self.is_whole().then_some(&self.geometry)
    }

    /// The standard error of each pixel's visibility, from how its rounds differ. 0 where no sample
    /// can change it and where it is not scored; 1 before there are two rounds. A pixel that has
    /// only seen light or only shadow so far has 0, though a later round may find something else.
    pub fn errors(&self) -> Image<f32> {
        let Image { width, height, ref data } = self.scored;
        let of = |(estimate, scored): (&Estimate, &bool)| if *scored { estimate.variance() } else { Some(0.0) };
        let errors = self.estimates.iter().zip(data).map(|pair| of(pair).map_or(1.0, f64::sqrt) as f32);
        Image { width, height, data: errors.collect() }
    }

    /// The root mean square of the standard errors over all scored pixels: how noisy the picture
    /// is. `None` before there are two rounds. Early it is rather too large, since the first
    /// rounds, with few points, are worse than later ones.
    pub fn standard_error(&self) -> Option<f64> {
        if !self.is_whole() {
            return None;
        }
        let scored = self.estimates.iter().zip(&self.scored.data).filter(|(_, scored)| **scored);
        let mut sum = (0.0, 0_u64);
        for (estimate, _) in scored {
            sum = (sum.0 + estimate.variance()?, sum.1 + 1);
        }
        Some((sum.0 / sum.1.max(1) as f64).sqrt())
    }

    /// Visits the next pixels, and ends the round where there are no more.
    fn batch(&mut self) {
        if self.done == 0 {
            self.light.set_samples(POINTS[(self.round as usize).min(POINTS.len() - 1)]);
        }
        let points = self.light.samples();
        let threads = rayon::current_num_threads();
        let end = self.open.len().min(self.done + (BATCH / POINTS[0].max(points)) as usize * threads);
        let pixels = self.open[self.done..end].par_iter().with_min_len(8);
        let found: Vec<Found> = pixels.map_init(Tally::default, |tally, &pixel| self.visit(pixel, tally)).collect();
        found.iter().for_each(|found| self.take(found, points));
        self.done = end;
        if self.done == self.open.len() {
            let (estimates, scored) = (&self.estimates, &self.scored.data);
            self.open.retain(|&pixel| scored[pixel as usize] && !estimates[pixel as usize].is_exact);
            self.samples += points;
            self.round = self.round.saturating_add(1);
            self.done = 0;
        }
    }

    /// Looks at a pixel where that was not done, and traces this round's samples.
    fn visit(&self, pixel: u32, tally: &mut Tally) -> Found {
        let (width, height) = self.scored.size();
        let is_known = self.is_looked_at[pixel as usize];
        let place = (pixel % width, pixel / width);
        let shown = if is_known { None } else { self.tracer.look(&self.camera, place, (width, height)) };
        let (surface, receives) = match &shown {
            Some(shown) => (Some(&shown.surface), shown.receives),
            None => (self.geometry.surface(place.0, place.1), self.geometry.receives.data[pixel as usize]),
        };
        let surface = surface.filter(|surface| receives && self.light.is_faced_by(surface));
        // The multiplier is odd: a pixel gets the same points in no two rounds.
        let seed = pixel.wrapping_add(self.round.wrapping_mul(0x9e37_79b9));
        let visibility = surface.map(|surface| self.light.visibility(&self.tracer, surface, seed, tally));
        Found { pixel, shown, visibility, is_exact: tally.is_exact }
    }

    fn take(&mut self, found: &Found, points: u32) {
        let pixel = found.pixel as usize;
        self.is_looked_at[pixel] = true;
        if let Some(shown) = &found.shown {
            self.geometry.show(pixel, shown);
        }
        let Some(mean) = found.visibility else {
            // What a neighbour lent it in the first round is not its own.
            self.visibility.data[pixel] = 0.0;
            return;
        };
        self.scored.data[pixel] = true;
        self.estimates[pixel].add(points, found, mean);
        let mean = self.estimates[pixel].mean() as f32;
        self.visibility.data[pixel] = mean;
        if self.round == 0 {
            self.lend(found.pixel, mean);
        }
    }

    /// Gives a pixel's visibility to its block, whose other pixels come later in the order.
    fn lend(&mut self, pixel: u32, mean: f32) {
        let (width, height) = self.scored.size();
        let (x, y) = (pixel % width, pixel / width);
        let block = block_of(x, y);
        for y in y..height.min(y + block) {
            for x in x..width.min(x + block) {
                self.visibility[(x, y)] = mean;
            }
        }
    }
}

fn view(light: &Light, textures: &[Texture]) -> LightView {
    LightView::new(light, textures, &Options { samples: POINTS[0], ..Options::default() })
}

/// The size of the block of pixels whose first one (x, y) is, in the order of the first round.
fn block_of(x: u32, y: u32) -> u32 {
    1 << (x | y | COARSEST).trailing_zeros()
}

/// All pixels: first every fourth across and down, then the others of every second, then the rest.
fn coarse_to_fine(width: u32, height: u32) -> Vec<u32> {
    let mut order = Vec::with_capacity(width as usize * height as usize);
    let mut step = COARSEST;
    while step > 0 {
        for y in (0..height).step_by(step as usize) {
            let row = (0..width).step_by(step as usize);
            order.extend(row.filter(|&x| block_of(x, y) == step).map(|x| y * width + x));
        }
        step /= 2;
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_round_visits_every_pixel_once_and_coarse_ones_first() {
        for (width, height) in [(0, 0), (1, 1), (3, 5), (16, 9), (0, 4)] {
            let order = coarse_to_fine(width, height);
            let coarse = (width.div_ceil(4) * height.div_ceil(4)) as usize;
            assert!(order[..coarse].iter().all(|pixel| (pixel % width) % 4 == 0 && (pixel / width) % 4 == 0));
            let mut sorted = order;
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..width * height), "{width} × {height}");
        }
    }

    #[test]
    fn it_goes_to_a_thread_of_its_own() {
        fn is_send<T: Send>() {}
        is_send::<Progressive>();
    }
}

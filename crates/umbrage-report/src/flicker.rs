//! What changes at fixed points of the scene while the camera or the light moves: in each
//! technique, and in the truth.

use crate::{error::Error, source::Source};
use umbrage_core::{Camera, Image, Light, glam::Vec3};
use umbrage_metrics::{FixedPoint, Flicker, Frame, fixed_points};
use umbrage_reference::{Options, Tracer};
use umbrage_renderer::Renderer;

/// Share of the distance by which the ray tracer may see a surface elsewhere than the rasteriser.
const SAME_DEPTH: f64 = 1e-3;

/// Follows the points of one light's scene from frame to frame.
pub(crate) struct Follower<'a> {
    source: &'a Source,
    tracer: &'a Tracer,
    /// Rays for each point of a soft light.
    samples: u32,
    last: Option<Seen>,
    reference: Flicker,
    /// One for each technique.
    techniques: Vec<Flicker>,
}

/// A frame, and the visibility that each technique gave it; `None` where it has failed.
struct Seen {
    camera: Camera,
    light: Light,
    frame: Frame,
    visibility: Vec<Option<Image<f32>>>,
}

impl<'a> Follower<'a> {
    /// For this many techniques.
    pub(crate) fn new(
        source: &'a Source,
        tracer: &'a Tracer,
        samples: u32,
        techniques: usize,
    ) -> Self {
        let techniques = vec![Flicker::default(); techniques];
        Self { source, tracer, samples, last: None, reference: Flicker::default(), techniques }
    }

    /// Looks at the frame that `renderers`, one a technique, have just drawn of the same camera and
    /// light.
    ///
    /// # Errors
    /// What reading back gives.
    pub(crate) fn frame(
        &mut self,
        camera: &Camera,
        light: &Light,
        renderers: &[Option<&Renderer>],
    ) -> Result<(), Error> {
        let Some(any) = renderers.iter().flatten().next() else { return Ok(()) };
        let visibility = |renderer: &Option<&Renderer>| renderer.map(|r| r.visibility(0)).transpose();
        let frame = Frame::new(camera.clone(), any.depth(camera)?, any.normal()?.map(|n| Vec3::from(*n)));
        let visibility = renderers.iter().map(visibility).collect::<Result<_, _>>()?;
        let seen = Seen { camera: camera.clone(), light: light.clone(), frame, visibility };
        if let Some(last) = self.last.take() {
            self.compare(&last, &seen);
        }
        self.last = Some(seen);
        Ok(())
    }

    fn compare(&mut self, last: &Seen, seen: &Seen) {
        let mut points = fixed_points(&last.frame, &seen.frame);
        let before_truth = self.truth(last, points.iter().map(|point| point.before));
        let after_truth = self.truth(seen, points.iter().map(|point| point.after));
        points.retain(|point: &FixedPoint| before_truth.counts[point.before] && after_truth.counts[point.after]);
        self.reference.add(&points, &before_truth.visibility, &after_truth.visibility);
        for (number, flicker) in self.techniques.iter_mut().enumerate() {
            if let (Some(before), Some(after)) = (&last.visibility[number], &seen.visibility[number]) {
                let truth = [&before_truth.visibility, &after_truth.visibility];
                flicker.add_beside(&points, [before, after], truth);
            }
        }
    }

    /// What some pixels of a frame truly see of the light.
    fn truth(&self, seen: &Seen, pixels: impl Iterator<Item = (u32, u32)>) -> Truth {
        let (width, height) = seen.frame.size();
        let mut wanted = Image::filled(width, height, false);
        pixels.for_each(|pixel| wanted[pixel] = true);
        let geometry = self.tracer.geometry_where(&seen.camera, &wanted);
        let options = Options { samples: self.samples, same_points: true, ..Options::default() };
        let textures = &self.source.scene.textures;
        let traced = self.tracer.visibility(&geometry, &seen.light, textures, &options, &|_, _| ());
        let counts = Image::from_fn(width, height, |x, y| {
            let traced_depth = f64::from(geometry.depth[(x, y)]);
            let is_same = |depth: f64| (depth - traced_depth).abs() <= SAME_DEPTH * depth;
            traced.scored[(x, y)] && seen.frame.depth((x, y)).is_some_and(is_same)
        });
        Truth { visibility: traced.visibility, counts }
    }

    /// Mean change of the truth, how many changes it is the mean of, and that of each technique.
    pub(crate) fn found(&self) -> Found {
        let techniques = self.techniques.iter().map(|flicker| (flicker.mean(), flicker.mean_off())).collect();
        Found { reference: self.reference.mean(), points: self.reference.points(), techniques }
    }
}

/// What was found on the way.
pub(crate) struct Found {
    pub reference: Option<f64>,
    pub points: usize,
    /// Of each the mean change, and how far changes are off those of the truth.
    pub techniques: Vec<(Option<f64>, Option<f64>)>,
}

/// The truth about some pixels.
struct Truth {
    visibility: Image<f32>,
    /// Pixels of scored surfaces that rasteriser and ray tracer agree on.
    counts: Image<bool>,
}

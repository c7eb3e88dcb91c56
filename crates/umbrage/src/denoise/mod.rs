//! What takes the grain out of look-ups whose taps differ from pixel to pixel, for every technique
//! that has such taps: it wraps the technique.

mod history;
mod movers;
mod spatial;

use crate::choices;
use crate::inline::Lent;
use crate::shader::Shader;
use crate::technique::{InOrder, Inside, Stats, Technique, inside_of};
use crate::{Error, Gpu, Passes, Settings, View, VisibilityTarget};
pub(crate) use history::{BYTES as HISTORY_BYTES, MOST_FRAMES, MeanOverFrames, PASS as HISTORY_PASS};
use spatial::SpatialFilter;

/// Shaders of the denoiser, for the registry's tests.
pub(crate) const SHADERS: [&Shader; 2] = [&spatial::SHADER, &history::SHADER];

choices! {
    /// What becomes of the grain that jittered taps leave.
    pub enum Denoise {
        /// It stays.
        Off = "off",
        /// Pixels that show the same plane are averaged as far as the penumbra is even.
        Spatial = "spatial",
        /// That, and then the mean of up to 64 frames, each with other taps, at points where
        /// nothing changes.
        Temporal = "temporal",
    }
}

/// Which lights leave grain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Grain {
    /// All: the filter is as wide under every light.
    EveryLight,
    /// Those with an extent, which the filter follows.
    SoftLights,
}

/// Standard deviation of the mean of two pixels at a visibility of one half. 32 taps spread over a
/// light that one edge cuts leave 0.02 (0.42 n^(−¾) / √2); the search for blockers and pixels that
/// few taps decide add as much again and more.
const GRAIN: f32 = 0.05;

/// `inner`, and what is to become of its grain.
pub(crate) fn denoised(gpu: &Gpu, inner: Box<dyn Technique>, denoise: Denoise, grain: Grain) -> Box<dyn Technique> {
    match denoise {
        Denoise::Off => inner,
        Denoise::Spatial | Denoise::Temporal => {
            let mean = (denoise == Denoise::Temporal).then(|| MeanOverFrames::new(gpu, MOST_FRAMES));
            let filter = SpatialFilter::new(gpu, GRAIN);
            Box::new(Denoised { inner, grain, filter, mean, frame: 0, is_grainy: false })
        }
    }
}

/// A technique with a filter after it.
struct Denoised {
    inner: Box<dyn Technique>,
    grain: Grain,
    filter: SpatialFilter,
    mean: Option<MeanOverFrames>,
    /// Number of the next frame: which taps it has.
    frame: u32,
    /// The light of the frame that was prepared leaves grain.
    is_grainy: bool,
}

impl Technique for Denoised {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, order: InOrder) -> Result<(), Error> {
        self.is_grainy = self.grain == Grain::EveryLight || view.light.shape.kind().is_soft();
        if let Some(mean) = self.mean.as_mut().filter(|_| self.is_grainy) {
            mean.prepare(view)?;
            self.inner.set_frame(self.frame);
            self.frame = self.frame.wrapping_add(1);
        }
        self.inner.prepare_view(gpu, view, order)?;
        if self.is_grainy { self.filter.prepare(view) } else { Ok(()) }
    }

    fn record_visibility(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        visibility: &VisibilityTarget,
        order: InOrder,
    ) -> Result<(), Error> {
        let Some(grainy) = self.filter.grainy().filter(|_| self.is_grainy) else {
            return self.inner.record_visibility(passes, view, visibility, order);
        };
        visibility.check(view.receivers)?;
        self.inner.record_visibility(passes, view, grainy, order)?;
        match &mut self.mean {
            Some(mean) => {
                self.filter.record(passes, view, mean.fresh().unwrap_or(visibility));
                mean.record(passes, view, visibility);
            }
            None => self.filter.record(passes, view, visibility),
        }
        Ok(())
    }

    fn set_frame(&mut self, frame: u32) {
        self.frame = frame;
        self.inner.set_frame(frame);
    }

    fn set(&mut self, gpu: &Gpu, settings: &Settings) -> Result<bool, Error> {
        self.inner.set(gpu, settings)
    }

    fn record_maps(&mut self, passes: &mut Passes<'_>, view: &View<'_>, order: InOrder) -> Result<(), Error> {
        self.inner.record_maps(passes, view, order)
    }

    fn lend(&mut self, gpu: &Gpu) -> Result<Lent, Error> {
        self.inner.lend(gpu)
    }

    fn draws_host_casters(&self) -> bool {
        self.inner.draws_host_casters()
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

/// All but the filter is the inner technique's.
impl Inside for Denoised {
    inside_of!(inner);

    fn stats(&self) -> Stats {
        let stats = self.inner.inside().stats();
        let own = if self.is_grainy { 1 + u32::from(self.mean.is_some()) } else { 0 };
        let bytes = self.filter.bytes() + self.mean.as_ref().map_or(0, MeanOverFrames::bytes);
        let (draws, triangles) = (stats.draws + own, stats.triangles + u64::from(own));
        Stats { draws, triangles, bytes: stats.bytes + bytes, ..stats }
    }

    fn forget(&mut self) {
        self.mean.iter_mut().for_each(MeanOverFrames::forget);
        self.inner.inside_mut().forget();
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        match pass {
            spatial::PASS => Some(spatial::BYTES),
            HISTORY_PASS => Some(HISTORY_BYTES),
            _ => self.inner.inside().reads(pass),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probe::assert_forwards;

    #[test]
    fn all_that_is_inside_a_technique_is_inside_the_denoised_one() {
        for denoise in [Denoise::Spatial, Denoise::Temporal] {
            assert_forwards(|gpu, inner| denoised(gpu, inner, denoise, Grain::SoftLights));
        }
    }
}

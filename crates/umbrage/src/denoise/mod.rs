//! What takes the grain out of look-ups whose taps differ from pixel to pixel, for every technique
//! that has such taps: it wraps the technique.

mod spatial;

use crate::choices;

use crate::inline::Lent;
use crate::shader::Shader;
use crate::technique::{DebugView, InOrder, Inside, Stats, Technique};
use crate::{Error, Gpu, Passes, Settings, View, VisibilityTarget};
use spatial::SpatialFilter;
use umbrage_core::light_view::LightView;

/// Shaders of the denoiser, for the registry's tests.
pub(crate) const SHADERS: [&Shader; 1] = [&spatial::SHADER];

choices! {
    /// What becomes of the grain that jittered taps leave.
    pub enum Denoise {
        /// It stays.
        Off = "off",
        /// Pixels that show the same plane are averaged as far as the penumbra is even.
        Spatial = "spatial",
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
        Denoise::Spatial => {
            Box::new(Denoised { inner, grain, filter: SpatialFilter::new(gpu, GRAIN), is_grainy: false })
        }
    }
}

/// A technique with a filter after it.
struct Denoised {
    inner: Box<dyn Technique>,
    grain: Grain,
    filter: SpatialFilter,
    /// The light of the frame that was prepared leaves grain.
    is_grainy: bool,
}

impl Technique for Denoised {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, order: InOrder) -> Result<(), Error> {
        self.inner.prepare_view(gpu, view, order)?;
        self.is_grainy = self.grain == Grain::EveryLight || view.light.shape.kind().is_soft();
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
        self.filter.record(passes, view, visibility);
        Ok(())
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
    fn stats(&self) -> Stats {
        let stats = self.inner.inside().stats();
        let own = u32::from(self.is_grainy);
        let (draws, triangles) = (stats.draws + own, stats.triangles + u64::from(own));
        Stats { draws, triangles, bytes: stats.bytes + self.filter.bytes(), ..stats }
    }

    fn forget(&mut self) {
        self.inner.inside_mut().forget();
    }

    fn light_views(&self) -> &[LightView] {
        self.inner.inside().light_views()
    }

    fn split_distances(&self) -> &[f64] {
        self.inner.inside().split_distances()
    }

    fn counts(&self) -> Vec<(&'static str, u64)> {
        self.inner.inside().counts()
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        if pass == spatial::PASS { Some(spatial::BYTES) } else { self.inner.inside().reads(pass) }
    }

    fn inspect(&mut self, view: Option<&str>) {
        self.inner.inside_mut().inspect(view);
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        self.inner.inside().debug_views()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probe::assert_forwards;

    #[test]
    fn all_that_is_inside_a_technique_is_inside_the_denoised_one() {
        assert_forwards(|gpu, inner| denoised(gpu, inner, Denoise::Spatial, Grain::SoftLights));
    }
}

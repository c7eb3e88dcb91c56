//! Percentage-closer soft shadows with jittered taps for search and filter: penumbras as wide as
//! the light makes them.
//!
//! Sources: ZA 4.4.1 and 4.4.3, and 3.5 (Fernando, "Percentage-Closer Soft Shadows", 2005).

use crate::casters::Needs;
use crate::denoise::{Denoise, Grain, denoised};
use crate::depth_maps::{
    BOUNDS_SHADER, Cover, LAYER_NAMES, LIGHTS, Map, MapSetup, MapTechnique, Noise, SHADERS, Storage, TESTS, TapStage,
    Taps,
};
use crate::settings::Configure;
use crate::shader::Shader;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Filter, FilterUse, Gpu, settings};

const SHADER: Shader = Shader::new("pcss-jitter", include_str!("pcss_jitter.wgsl"));

settings! {
    /// See the module.
    pub struct PcssJitter {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
        #[flatten] storage: Storage,
        /// Taps that search for blockers.
        search: u32 = 16, in 1..=1024,
        /// Comparisons in the penumbra.
        taps: u32 = 32, in 1..=1024,
        /// How neighbouring pixels differ: each pixel of a tile has its own jittered strata; or all
        /// use one set of taps, turned by blue noise, by interleaved gradient noise, or not at all
        /// (bands instead of grain).
        noise: Noise = Noise::Gradient,
        /// Width and height after which stratified and blue noise repeat.
        tile: u32 = 8, in 1..=32, unit "pixels",
        /// What becomes of the grain: it stays; or pixels that show the same plane are averaged as
        /// far as the penumbra is even; or that, and then the mean of up to 64 frames, each with
        /// other taps, at points where nothing changes.
        denoise: Denoise = Denoise::Off,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "pcss-jitter",
    title: "Jittered percentage-closer soft shadows",
    summary: "Searches and filters as `pcss` does, with jittered taps, most of them only in penumbras.",
    source: "ZA 4.4.3",
    family: Family::DepthMaps,
    filter: Some(FilterUse { warped: false }),
    lights: LIGHTS,
    casters: Needs::Depth,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<3>,
    hard: false,
    settings: SettingsOf::new::<PcssJitter>(),
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], BOUNDS_SHADER, SHADER],
    readme: include_str!("README.md"),
};

impl Configure for PcssJitter {
    const INFO: &'static TechniqueInfo = &INFO;
    const LENT: bool = true;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        self.make_on(gpu, &self.map.covering(&self.cover, self.storage.depth))
    }

    fn as_filter(&self) -> Option<&dyn Filter> {
        Some(self)
    }

    fn maps(&self) -> Option<MapSetup> {
        Some(self.map.covering(&self.cover, self.storage.depth))
    }
}

impl Filter for PcssJitter {
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        let constants =
            [("SEARCH", f64::from(self.search)), ("FILTER", f64::from(self.taps)), ("TESTS", f64::from(TESTS))];
        let stage = TapStage::light(gpu, Taps::new(self.noise, self.tile, self.search, self.taps), true);
        let maps = MapTechnique::staged(gpu, maps, &SHADER, 1.0, &constants, Some(Box::new(stage)))?;
        // Of the first phase the light's centre, of the second that, too, and all taps.
        let taps = u64::from(1 + self.search + 1 + self.taps);
        let maps = maps.soft().in_phases().reading(4 * taps + 2 * TapStage::BOUNDS_BYTES);
        Ok(denoised(gpu, Box::new(maps), self.denoise, Grain::SoftLights))
    }
}

//! Percentage-closer filtering with jittered taps: grain in place of bands, and most taps only in
//! the penumbra.
//!
//! Sources: Uralsky, "Efficient Soft-Edged Shadows Using Pixel Shader Branching", 2005; ZA 3.4.

use crate::casters::Needs;
use crate::denoise::{Denoise, Grain, denoised};
use crate::depth_maps::{
    Cover, LAYER_NAMES, LIGHTS, Map, MapSetup, MapTechnique, Noise, SHADERS, Storage, TESTS, TapStage, Taps,
};
use crate::settings::Configure;
use crate::shader::Shader;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Filter, FilterUse, Gpu, settings};

const SHADER: Shader = Shader::new("pcf-jitter", include_str!("pcf_jitter.wgsl"));

settings! {
    /// See the module.
    pub struct PcfJitter {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
        #[flatten] storage: Storage,
        /// Comparisons in the penumbra. Elsewhere the first 8 suffice.
        taps: u32 = 64, in 1..=1024,
        /// Radius of the disc.
        radius: f64 = 2.5, in 0.0..=256.0, unit "texels",
        /// How neighbouring pixels differ: each pixel of a tile has its own jittered strata; or all
        /// use one set of taps, turned by blue noise, by interleaved gradient noise, or not at all
        /// (bands instead of grain).
        noise: Noise = Noise::Stratified,
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
    id: "pcf-jitter",
    title: "Jittered percentage-closer filtering",
    summary: "Averages comparisons over a jittered disc: a few of them first, the rest only in the penumbra.",
    source: "ZA 3.4",
    family: Family::DepthMaps,
    filter: Some(FilterUse { warped: true }),
    lights: LIGHTS,
    casters: Needs::Depth,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<2>,
    hard: false,
    settings: SettingsOf::new::<PcfJitter>(),
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], SHADER],
    readme: include_str!("README.md"),
};

impl Configure for PcfJitter {
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

impl Filter for PcfJitter {
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        let constants = [("TAPS", f64::from(self.taps)), ("TESTS", f64::from(TESTS)), ("RADIUS", self.radius)];
        let stage = TapStage::disc(gpu, Taps::new(self.noise, self.tile, 0, self.taps));
        let reach = self.radius + 1.0;
        let maps = MapTechnique::staged(gpu, maps, &SHADER, reach, &constants, Some(Box::new(stage)))?;
        Ok(denoised(gpu, Box::new(maps), self.denoise, Grain::EveryLight))
    }
}

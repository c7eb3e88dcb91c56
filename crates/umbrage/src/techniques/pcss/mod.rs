//! Percentage-closer soft shadows: looks for blockers on a grid, filters on a grid as wide as the
//! penumbra.
//!
//! Sources: Fernando, "Percentage-Closer Soft Shadows", 2005; ZA 3.5.

use crate::casters::Needs;
use crate::depth_maps::{
    BOUNDS_SHADER, Cover, LAYER_NAMES, LIGHTS, Map, MapSetup, MapTechnique, SHADERS, Storage, TapStage, Taps,
};
use crate::settings::Configure;
use crate::shader::Shader;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Filter, FilterUse, Gpu, settings};

const SHADER: Shader = Shader::new("pcss", include_str!("pcss.wgsl"));

settings! {
    /// See the module.
    pub struct Pcss {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
        #[flatten] storage: Storage,
        /// Taps along each side of the grid that searches for blockers.
        search: u32 = 5, in 1..=32,
        /// Taps along each side of the grid of comparisons.
        kernel: u32 = 7, in 1..=32,
        /// Searches for blockers only as far as bounds of the map's depths allow. Without it, the
        /// search reaches as far as the nearest caster would require.
        bounds: bool = true,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "pcss",
    title: "Percentage-closer soft shadows",
    summary: "Searches the map for blockers and filters it on a grid as wide as the penumbra that they cause.",
    source: "ZA 3.5",
    family: Family::DepthMaps,
    filter: Some(FilterUse { warped: false }),
    lights: LIGHTS,
    casters: Needs::Depth,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<3>,
    hard: false,
    settings: SettingsOf::new::<Pcss>(),
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], BOUNDS_SHADER, SHADER],
    readme: include_str!("README.md"),
};

impl Configure for Pcss {
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

impl Filter for Pcss {
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        let constants = [
            ("SEARCH", f64::from(self.search * self.search)),
            ("FILTER", f64::from(self.kernel * self.kernel)),
            ("BOUNDED", f64::from(u8::from(self.bounds))),
        ];
        let stage = TapStage::light(gpu, Taps::grids(self.search, self.kernel), self.bounds);
        let maps = MapTechnique::staged(gpu, maps, &SHADER, 1.0, &constants, Some(Box::new(stage)))?;
        // The search looks at the light's centre besides.
        let taps = u64::from(self.search * self.search + 1 + self.kernel * self.kernel);
        let bounds = if self.bounds { TapStage::BOUNDS_BYTES } else { 0 };
        Ok(Box::new(maps.soft().reading(4 * taps + bounds)))
    }
}

//! Hard shadows from a depth map seen from the light.
//!
//! Sources: Williams 1978; ZA 2.3; SG "Shadow Mapping", "Second Depth Shadow Maps" (midpoint),
//! "Extensions" (focus).

use crate::casters::Needs;
use crate::depth_maps::{Cover, LAYER_NAMES, LIGHTS, Map, MapSetup, MapTechnique, SHADERS, Storage};
use crate::settings::Configure;
use crate::shader::Shader;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Filter, FilterUse, Gpu, settings};

const SHADER: Shader = Shader::new("shadow-map", include_str!("shadow_map.wgsl"));

settings! {
    /// See the module.
    pub struct ShadowMap {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
        #[flatten] storage: Storage,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "shadow-map",
    title: "Shadow map",
    summary: "Compares each point's distance to the light with that of the nearest surface in a depth map.",
    source: "ZA 2.3; SG \"Shadow Mapping\"",
    family: Family::DepthMaps,
    filter: Some(FilterUse { warped: true }),
    lights: LIGHTS,
    casters: Needs::Depth,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<2>,
    hard: true,
    settings: SettingsOf::new::<ShadowMap>(),
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], SHADER],
    readme: include_str!("README.md"),
};

impl Configure for ShadowMap {
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

impl Filter for ShadowMap {
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        Ok(Box::new(MapTechnique::new(gpu, maps, &SHADER, 0.5, &[])?.reading(4)))
    }
}

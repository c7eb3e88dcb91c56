//! Hard shadows from a depth map seen from the light.
//!
//! Sources: Williams 1978; ZA 2.3; SG "Shadow Mapping", "Second Depth Shadow Maps" (midpoint), "Extensions" (focus).

use crate::depth_maps::{
    BIAS, CACHE, DEPTH, FACES, FOCUS, LAYER_NAMES, LIGHTS, MapTechnique, OMNI, SHADERS, SIZE,
};
use crate::shader::Shader;
use crate::technique::TechniqueInfo;

const SHADER: Shader = Shader::new("shadow-map", include_str!("shadow_map.wgsl"));

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "shadow-map",
    title: "Shadow map",
    summary: "Compares each point's distance to the light with that of the nearest surface in a depth map.",
    source: "ZA 2.3; SG \"Shadow Mapping\"",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: true,
    params: &[SIZE, FACES, OMNI, DEPTH, FOCUS, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], SHADER],
    readme: include_str!("README.md"),
    make: |gpu, settings| Ok(Box::new(MapTechnique::new(gpu, settings, &SHADER, 0.5, &[])?)),
};

//! Perspective shadow maps: the map is taken in post-perspective space, where near things are large.
//!
//! Sources: Stamminger and Drettakis 2002; Kozlov, "Perspective Shadow Maps: Care and Feeding", 2004; SG "Perspective Shadow Maps".

use crate::depth_maps::{
    BIAS, CACHE, CUBE, FACES, FILTER_KERNEL, LAYER_NAMES, LIGHTS, NEAR_PLANE, SHADERS, SHIFT, SIZE, WARPED_FILTER,
};
use crate::technique::TechniqueInfo;
use crate::techniques::find;

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "psm",
    title: "Perspective shadow map",
    summary: "Takes the depth map in the space after the projection of a virtual camera: texels are small near the eye.",
    source: "SG \"Perspective Shadow Maps\"",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[SIZE, WARPED_FILTER, FILTER_KERNEL, SHIFT, NEAR_PLANE, CUBE, FACES, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &SHADERS,
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let filter = find(settings.choice("filter"))?;
        filter.make(gpu, &settings.with_defaults_of(filter.params))
    },
};

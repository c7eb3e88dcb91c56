//! The plane-optimal map: no perspective is left between the screen and the map on one plane.
//!
//! Sources: Chong, "Real-Time Perspective Optimal Shadow Maps", 2003; SG "Thesis of Hamilton Yu-Ik Chong".

use crate::depth_maps::{
    BIAS, CACHE, FACES, FILTER_KERNEL, GIVE_WAY, HEIGHT, LAYER_NAMES, LIGHTS, PLANE, SHADERS, SIZE, WARPED_FILTER,
};
use crate::technique::TechniqueInfo;
use crate::techniques::find;

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "plane-optimal",
    title: "Plane-optimal shadow map",
    summary: "Tilts the map so that on one plane, such as the ground, all texels are of one size on the screen.",
    source: "SG \"Thesis of Hamilton Yu-Ik Chong\"",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[SIZE, WARPED_FILTER, FILTER_KERNEL, PLANE, HEIGHT, GIVE_WAY, FACES, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &SHADERS,
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let filter = find(settings.choice("filter"))?;
        filter.make(gpu, &settings.with_defaults_of(filter.params))
    },
};

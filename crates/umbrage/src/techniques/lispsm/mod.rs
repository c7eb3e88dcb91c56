//! Light-space perspective shadow maps: a perspective across the light and along the view.
//!
//! Sources: Wimmer, Scherzer and Purgathofer, "Light Space Perspective Shadow Maps", 2004; SG "Perspective Shadow Maps".

use crate::depth_maps::{
    BIAS, CACHE, FACES, FILTER_KERNEL, LAYER_NAMES, LIGHTS, SHADERS, SIZE, STRENGTH, WARPED_FILTER,
};
use crate::technique::TechniqueInfo;
use crate::techniques::find;

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "lispsm",
    title: "Light-space perspective shadow map",
    summary: "Warps the depth map along the view by a perspective across the light, as much as makes errors near and far the same.",
    source: "SG \"Perspective Shadow Maps\"; Wimmer et al. 2004",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[SIZE, WARPED_FILTER, FILTER_KERNEL, STRENGTH, FACES, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &SHADERS,
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let filter = find(settings.choice("filter"))?;
        filter.make(gpu, &settings.with_defaults_of(filter.params))
    },
};

//! Percentage-closer soft shadows: looks for blockers on a grid, filters on a grid as wide as the penumbra.
//!
//! Sources: Fernando, "Percentage-Closer Soft Shadows", 2005; ZA 3.5.

use crate::depth_maps::{
    BIAS, BOUNDS_SHADER, CACHE, DEPTH, FACES, FOCUS, LAYER_NAMES, LIGHTS, MapTechnique, OMNI, SHADERS, SIZE,
    TapStage, Taps,
};
use crate::params::{Param, ParamKind};
use crate::shader::Shader;
use crate::technique::TechniqueInfo;

const SHADER: Shader = Shader::new("pcss", include_str!("pcss.wgsl"));

const SEARCH: Param = Param {
    name: "search",
    help: "Taps a side of the grid that looks for blockers.",
    unit: "",
    kind: ParamKind::Int { min: 1, max: 32, default: 5 },
};

const KERNEL: Param = Param {
    name: "kernel",
    help: "Taps a side of the grid of compares.",
    unit: "",
    kind: ParamKind::Int { min: 1, max: 32, default: 7 },
};

const BOUNDS: Param = Param {
    name: "bounds",
    help: "Looks for blockers only as far as bounds of the map's depth allow, not as far as the nearest caster would.",
    unit: "",
    kind: ParamKind::Switch { default: true },
};

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "pcss",
    title: "Percentage-closer soft shadows",
    summary: "Finds what is in the way of the light and filters on a grid as wide as the penumbra.",
    source: "ZA 3.5",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[SIZE, SEARCH, KERNEL, BOUNDS, FACES, OMNI, DEPTH, FOCUS, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], BOUNDS_SHADER, SHADER],
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let side = |name| settings.int(name) as u32;
        let (search, kernel) = (side("search"), side("kernel"));
        let bounds = settings.switch("bounds");
        let constants = [
            ("SEARCH", f64::from(search * search)),
            ("FILTER", f64::from(kernel * kernel)),
            ("BOUNDED", f64::from(u8::from(bounds))),
        ];
        let stage = TapStage::light(gpu, Taps::grids(search, kernel), bounds);
        Ok(Box::new(MapTechnique::staged(gpu, settings, &SHADER, 1.0, &constants, Some(Box::new(stage)))?.soft()))
    },
};

//! Percentage-closer soft shadows with jittered taps for search and filter: penumbras as wide as the light makes them.
//!
//! Sources: ZA 4.4.1 and 4.4.3, and 3.5 (Fernando, "Percentage-Closer Soft Shadows", 2005).

use crate::depth_maps::{
    BIAS, BOUNDS_SHADER, CACHE, DEPTH, FACES, FOCUS, GRADIENT_NOISE, LAYER_NAMES, LIGHTS, MapTechnique, OMNI, SHADERS,
    SIZE, TESTS, TILE, TapStage, Taps,
};
use crate::params::{Param, ParamKind};
use crate::shader::Shader;
use crate::technique::TechniqueInfo;

const SHADER: Shader = Shader::new("pcss-jitter", include_str!("pcss_jitter.wgsl"));

const SEARCH: Param = Param {
    name: "search",
    help: "Taps that look for blockers.",
    unit: "",
    kind: ParamKind::Int { min: 1, max: 1024, default: 16 },
};

const TAPS: Param = Param {
    name: "taps",
    help: "Compares in the penumbra.",
    unit: "",
    kind: ParamKind::Int { min: 1, max: 1024, default: 32 },
};

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "pcss-jitter",
    title: "Jittered percentage-closer soft shadows",
    summary: "Looks for what is in the way of the light and filters as widely as its distance and the light's size ask for.",
    source: "ZA 4.4.3",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[SIZE, SEARCH, TAPS, GRADIENT_NOISE, TILE, FACES, OMNI, DEPTH, FOCUS, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], BOUNDS_SHADER, SHADER],
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let (search, taps) = (settings.int("search") as u32, settings.int("taps") as u32);
        let constants = [("SEARCH", f64::from(search)), ("FILTER", f64::from(taps)), ("TESTS", f64::from(TESTS))];
        let stage = TapStage::light(gpu, Taps::new(settings, search, taps), true);
        Ok(Box::new(
            MapTechnique::staged(gpu, settings, &SHADER, 1.0, &constants, Some(Box::new(stage)))?.soft().in_phases(),
        ))
    },
};

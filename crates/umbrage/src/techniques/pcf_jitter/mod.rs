//! Percentage-closer filtering with jittered taps: grain in place of bands, and most taps only in the penumbra.
//!
//! Sources: Uralsky, "Efficient Soft-Edged Shadows Using Pixel Shader Branching", 2005; ZA 3.4.

use crate::depth_maps::{
    BIAS, CACHE, DEPTH, FACES, FOCUS, LAYER_NAMES, LIGHTS, MapTechnique, NOISE, OMNI, SHADERS, SIZE,
    TESTS, TILE, TapStage, Taps,
};
use crate::params::{Param, ParamKind};
use crate::shader::Shader;
use crate::technique::TechniqueInfo;

const SHADER: Shader = Shader::new("pcf-jitter", include_str!("pcf_jitter.wgsl"));

const TAPS: Param = Param {
    name: "taps",
    help: "Compares in the penumbra; everywhere else the first 8 do.",
    unit: "",
    kind: ParamKind::Int { min: 1, max: 1024, default: 64 },
};

const RADIUS: Param = Param {
    name: "radius",
    help: "Radius of the disc.",
    unit: "texels",
    kind: ParamKind::Float { min: 0.0, max: 256.0, default: 2.5 },
};

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "pcf-jitter",
    title: "Jittered percentage-closer filtering",
    summary: "Averages compares over a jittered disc, a few of them to find the penumbra and the rest only there.",
    source: "ZA 3.4",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[SIZE, TAPS, RADIUS, NOISE, TILE, FACES, OMNI, DEPTH, FOCUS, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], SHADER],
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let taps = settings.int("taps") as u32;
        let radius = settings.float("radius");
        let constants = [("TAPS", f64::from(taps)), ("TESTS", f64::from(TESTS)), ("RADIUS", radius)];
        let stage = TapStage::disc(gpu, Taps::new(settings, 0, taps));
        let reach = radius + 1.0;
        Ok(Box::new(MapTechnique::staged(gpu, settings, &SHADER, reach, &constants, Some(Box::new(stage)))?))
    },
};

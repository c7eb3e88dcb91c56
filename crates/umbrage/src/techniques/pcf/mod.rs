//! Percentage-closer filtering: compares first, then averages.
//!
//! Sources: Reeves, Salesin and Cook 1987; ZA 3.2; FE 2.3.1.

use crate::depth_maps::{
    BIAS, CACHE, DEPTH, FACES, FOCUS, LAYER_NAMES, LIGHTS, MapTechnique, OMNI, SHADERS, SIZE,
};
use crate::params::{Param, ParamKind};
use crate::shader::Shader;
use crate::technique::TechniqueInfo;

const SHADER: Shader = Shader::new("pcf", include_str!("pcf.wgsl"));

const KERNEL: Param = Param {
    name: "kernel",
    help: "Which compares are averaged: a square of 3×3, 5×5 or 7×7 bilinear ones, the 2×2 texels that one hardware \
           compare takes, or a Vogel disc.",
    unit: "",
    kind: ParamKind::Choice { values: &["3", "2x2", "5", "7", "disc"] },
};

const TAPS: Param = Param {
    name: "taps",
    help: "Compares of the disc.",
    unit: "",
    kind: ParamKind::Int { min: 1, max: 1024, default: 16 },
};

const RADIUS: Param = Param {
    name: "radius",
    help: "Radius of the disc.",
    unit: "texels",
    kind: ParamKind::Float { min: 0.0, max: 64.0, default: 2.5 },
};

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "pcf",
    title: "Percentage-closer filtering",
    summary: "Averages many compares with a depth map around each point: soft edges of constant width.",
    source: "ZA 3.2; FE 2.3.1",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[SIZE, KERNEL, TAPS, RADIUS, FACES, OMNI, DEPTH, FOCUS, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], SHADER],
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let side = match settings.choice("kernel") {
            // Squares are whole texels wide; a softness in metres is not.
            _ if settings.float("radius-m") > 0.0 => 0,
            "2x2" => 2,
            "disc" => 0,
            side => side.parse().unwrap_or(3),
        };
        let radius = settings.float("radius");
        let reach = if side == 0 { radius + 1.0 } else { 0.5 * f64::from(side) + 0.5 };
        let constants = [("KERNEL", f64::from(side)), ("TAPS", settings.int("taps") as f64), ("RADIUS", radius)];
        Ok(Box::new(MapTechnique::new(gpu, settings, &SHADER, reach, &constants)?))
    },
};

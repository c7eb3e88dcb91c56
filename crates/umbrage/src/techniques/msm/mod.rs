//! Moment shadow maps: four moments of depth and the sharpest bound that they give.
//!
//! Source: Peters and Klein, "Moment Shadow Mapping", 2015.

use crate::depth_maps::{
    BIAS, CACHE, FACES, FOCUS, LAYER_NAMES, LIGHTS, MapTechnique, OMNI, SHADERS, SIZE,
};
use crate::moment_maps::{Coding, FORMAT, MIPS, MomentStage, RADIUS, Recipe};
use crate::params::{Param, ParamKind};
use crate::shader::{Module, Shader};
use crate::technique::TechniqueInfo;

const MODULES: &[Module] = &[
    Module { name: "moments", source: include_str!("moments.wgsl") },
    Module { name: "msm", source: include_str!("msm.wgsl") },
];

const fn shader(name: &'static str, needs: &'static str) -> Shader {
    Shader::new(name, needs).with_modules(MODULES)
}

const PASSES: Shader = shader("msm moments", "// needs: moments_passes, moments_float, moments");
const PASSES_16: Shader = shader("msm moments, 16 bits", "// needs: moments_passes, moments_unorm, moments");
const LOOKUP: Shader = shader("msm", "// needs: msm, moments_float");
const LOOKUP_16: Shader = shader("msm, 16 bits", "// needs: msm, moments_unorm");

const BLEEDING: Param = Param {
    name: "bleeding",
    help: "Shares of light up to this count as none, the rest is stretched: takes light that bleeds through off.",
    unit: "",
    kind: ParamKind::Float { min: 0.0, max: 0.9, default: 0.1 },
};

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "msm",
    title: "Moment shadow maps",
    summary: "Filters four powers of depth; the sharpest bound on the share of light that they give.",
    source: "beyond: Peters and Klein 2015",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[SIZE, RADIUS, BLEEDING, FORMAT, MIPS, FACES, OMNI, FOCUS, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], PASSES, PASSES_16, LOOKUP, LOOKUP_16],
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let half = settings.choice("format") == "16";
        let (passes, lookup, coding) =
            if half { (PASSES_16, LOOKUP_16, Coding::Unorm) } else { (PASSES, LOOKUP, Coding::Single) };
        let recipe = Recipe { passes, channels: 4, coding, constants: Vec::new() };
        let stage = MomentStage::new(gpu, settings, &recipe);
        let reach = stage.reach();
        let on = |name| if settings.switch(name) { 1.0 } else { 0.0 };
        let constants = [
            ("MIPS", on("mips")),
            ("BLEEDING", settings.float("bleeding")),
            ("MOMENT_BIAS", if half { 6e-5 } else { 1e-5 }),
        ];
        let maps = MapTechnique::staged(gpu, settings, &lookup, reach, &constants, Some(Box::new(stage)))?;
        Ok(Box::new(maps.with_every_caster()))
    },
};

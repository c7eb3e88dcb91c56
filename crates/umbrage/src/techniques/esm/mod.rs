//! Exponential shadow maps: an exponential falls off behind the blocker in place of a step.
//!
//! Source: Annen, Mertens, Seidel, Flerackers and Kautz, "Exponential Shadow Maps", 2008.

use crate::depth_maps::{
    BIAS, CACHE, FACES, FOCUS, LAYER_NAMES, LIGHTS, MapTechnique, OMNI, SHADERS, SIZE,
};
use crate::moment_maps::{Coding, FORMAT, MIPS, MomentStage, RADIUS, Recipe};
use crate::params::{Param, ParamKind};
use crate::shader::{Module, Shader};
use crate::technique::TechniqueInfo;

const MODULES: &[Module] = &[
    Module { name: "moments", source: include_str!("moments.wgsl") },
    Module { name: "esm", source: include_str!("esm.wgsl") },
];

const fn shader(name: &'static str, needs: &'static str) -> Shader {
    Shader::new(name, needs).with_modules(MODULES)
}

const PASSES: Shader = shader("esm moments", "// needs: moments_passes, moments_float, moments");
const PASSES_16: Shader = shader("esm moments, 16 bits", "// needs: moments_passes, moments_unorm, moments");
const LOOKUP: Shader = shader("esm", "// needs: esm, moments_float");
const LOOKUP_16: Shader = shader("esm, 16 bits", "// needs: esm, moments_unorm");

const BLEEDING: Param = Param {
    name: "bleeding",
    help: "Shares of light up to this count as none, the rest is stretched: takes light that bleeds through off.",
    unit: "",
    kind: ParamKind::Float { min: 0.0, max: 0.9, default: 0.1 },
};

const EXPONENT: Param = Param {
    name: "exponent",
    help: "How steeply light falls off behind a blocker, over the range of depth.",
    unit: "",
    kind: ParamKind::Float { min: 1.0, max: 2000.0, default: 400.0 },
};

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "esm",
    title: "Exponential shadow maps",
    summary: "Filters exponentials of depth, which fall off steeply behind a blocker.",
    source: "beyond: Annen et al. 2008",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[SIZE, RADIUS, EXPONENT, BLEEDING, FORMAT, MIPS, FACES, OMNI, FOCUS, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], PASSES, PASSES_16, LOOKUP, LOOKUP_16],
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let exponent = ("EXPONENT", settings.float("exponent"));
        let half = settings.choice("format") == "16";
        let (passes, lookup, coding) =
            if half { (PASSES_16, LOOKUP_16, Coding::Unorm) } else { (PASSES, LOOKUP, Coding::Single) };
        let recipe = Recipe { passes, channels: 1, coding, constants: vec![exponent] };
        let stage = MomentStage::new(gpu, settings, &recipe);
        let reach = stage.reach();
        let on = |name| if settings.switch(name) { 1.0 } else { 0.0 };
        let constants = [("MIPS", on("mips")), ("BLEEDING", settings.float("bleeding")), exponent];
        let maps = MapTechnique::staged(gpu, settings, &lookup, reach, &constants, Some(Box::new(stage)))?;
        Ok(Box::new(maps.with_every_caster()))
    },
};

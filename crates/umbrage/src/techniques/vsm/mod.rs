//! Variance shadow maps: mean and variance of depth bound the share of light.
//!
//! Sources: FE 2.3.1; Donnelly and Lauritzen, "Variance Shadow Maps", 2006.

use crate::depth_maps::{
    BIAS, CACHE, FACES, FOCUS, LAYER_NAMES, LIGHTS, MapTechnique, OMNI, SHADERS, SIZE,
};
use crate::moment_maps::{Coding, FORMAT, MIPS, MomentStage, RADIUS, Recipe};
use crate::params::{Param, ParamKind};
use crate::shader::{Module, Shader};
use crate::technique::TechniqueInfo;

const MODULES: &[Module] = &[
    Module { name: "moments", source: include_str!("moments.wgsl") },
    Module { name: "vsm", source: include_str!("vsm.wgsl") },
];

const fn shader(name: &'static str, needs: &'static str) -> Shader {
    Shader::new(name, needs).with_modules(MODULES)
}

const PASSES: Shader = shader("vsm moments", "// needs: moments_passes, moments_float, moments");
const PASSES_16: Shader = shader("vsm moments, 16 bits", "// needs: moments_passes, moments_unorm, moments");
const LOOKUP: Shader = shader("vsm", "// needs: vsm, moments_float");
const LOOKUP_16: Shader = shader("vsm, 16 bits", "// needs: vsm, moments_unorm");

const BLEEDING: Param = Param {
    name: "bleeding",
    help: "Shares of light up to this count as none, the rest is stretched: takes light that bleeds through off.",
    unit: "",
    kind: ParamKind::Float { min: 0.0, max: 0.9, default: 0.2 },
};

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "vsm",
    title: "Variance shadow maps",
    summary: "Filters depth and its square; their variance says how much of the light may come through.",
    source: "FE 2.3.1",
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
        let recipe = Recipe { passes, channels: 2, coding, constants: Vec::new() };
        let stage = MomentStage::new(gpu, settings, &recipe);
        let reach = stage.reach();
        let on = |name| if settings.switch(name) { 1.0 } else { 0.0 };
        let constants = [
            ("MIPS", on("mips")),
            ("BLEEDING", settings.float("bleeding")),
            ("LEAST_VARIANCE", if half { 3e-5 } else { 1e-7 }),
        ];
        let maps = MapTechnique::staged(gpu, settings, &lookup, reach, &constants, Some(Box::new(stage)))?;
        Ok(Box::new(maps.with_every_caster()))
    },
};

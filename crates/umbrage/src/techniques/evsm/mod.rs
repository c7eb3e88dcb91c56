//! Exponential variance shadow maps: variance shadow maps of depths that an exponential spreads out.
//!
//! Sources: FE 2.3.1; Lauritzen and McCool, "Layered Variance Shadow Maps", 2008, section 3; Lauritzen's thesis, 2008.

use crate::depth_maps::{
    BIAS, CACHE, FACES, FOCUS, LAYER_NAMES, LIGHTS, LOOKUP_LAYOUTS, MapTechnique, OMNI, SHADERS, SIZE,
};
use crate::moment_maps::{Coding, FORMAT, MIPS, MomentStage, PASS_LAYOUTS, RADIUS, Recipe};
use crate::params::{Param, ParamKind};
use crate::shader::{
    FULLSCREEN, MAP_LOOKUP, MAP_VISIBILITY, MOMENTS_DEPTH, MOMENTS_FLOAT, MOMENTS_LOOKUP, MOMENTS_MEAN, MOMENTS_PASSES,
    RECEIVERS, Shader,
};
use crate::technique::TechniqueInfo;

const MOMENTS: &str = include_str!("moments.wgsl");

const PASSES: Shader = Shader {
    name: "evsm moments",
    parts: &[FULLSCREEN, MOMENTS_DEPTH, MOMENTS_FLOAT, MOMENTS_MEAN, MOMENTS, MOMENTS_PASSES],
    layouts: PASS_LAYOUTS,
};
const LOOKUP: Shader = Shader {
    name: "evsm",
    parts: &[
        FULLSCREEN,
        RECEIVERS,
        MAP_LOOKUP,
        MAP_VISIBILITY,
        MOMENTS_DEPTH,
        MOMENTS_FLOAT,
        MOMENTS,
        MOMENTS_LOOKUP,
        include_str!("bounds.wgsl"),
        include_str!("evsm.wgsl"),
    ],
    layouts: LOOKUP_LAYOUTS,
};

const COMPONENTS: Param = Param {
    name: "components",
    help: "Numbers a texel: 4 for a growing and a falling exponential, 2 for the growing one alone.",
    unit: "",
    kind: ParamKind::Choice { values: &["4", "2"] },
};

const BLEEDING: Param = Param {
    name: "bleeding",
    help: "Shares of light up to this count as none, the rest is stretched: takes light that bleeds through off.",
    unit: "",
    kind: ParamKind::Float { min: 0.0, max: 0.9, default: 0.1 },
};

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "evsm",
    title: "Exponential variance shadow maps",
    summary: "Variance shadow maps of exponentials of depth, which part receiver and blocker and keep light from bleeding.",
    source: "FE 2.3.1",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[SIZE, RADIUS, COMPONENTS, BLEEDING, FORMAT, MIPS, FACES, OMNI, FOCUS, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], PASSES, LOOKUP],
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let half = settings.choice("format") == "16";
        let coding = if half { Coding::Half } else { Coding::Single };
        let channels = if settings.choice("components") == "2" { 2 } else { 4 };
        // The squares are to stay in the format's range. Within a filter as wide as `radius` depth changes by more where the map is
        // coarser, and steep exponentials then see the nearest of it alone.
        let steepest = if half { 5.54 } else { 42.0 };
        let growth = f64::min(steepest, 0.25 * settings.int("size") as f64 / settings.float("radius").max(1.0));
        let warps = [("GROWTH", growth), ("DECAY", growth)];
        let recipe = Recipe { passes: PASSES, channels, coding, constants: warps.to_vec() };
        let stage = MomentStage::new(gpu, settings, &recipe);
        let reach = stage.reach();
        let on = |name| if settings.switch(name) { 1.0 } else { 0.0 };
        let constants = [
            warps[0],
            warps[1],
            ("COMPONENTS", f64::from(channels)),
            ("MIPS", on("mips")),
            ("BLEEDING", settings.float("bleeding")),
            ("LEAST_VARIANCE", if half { 2e-3 } else { 1e-6 }),
        ];
        let maps = MapTechnique::staged(gpu, settings, &LOOKUP, reach, &constants, Some(Box::new(stage)))?;
        Ok(Box::new(maps.with_every_caster()))
    },
};

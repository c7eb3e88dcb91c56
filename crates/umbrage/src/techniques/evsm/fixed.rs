//! A filter of one width.

use super::growth;
use crate::depth_maps::{LOOKUP_LAYOUTS, MapTechnique};
use crate::moment_maps::{Coding, MomentStage, PASS_LAYOUTS, Recipe};
use crate::shader::{
    FULLSCREEN, MAP_LOOKUP, MAP_VISIBILITY, MOMENTS_DEPTH, MOMENTS_FLOAT, MOMENTS_LOOKUP, MOMENTS_MEAN, MOMENTS_PASSES,
    RECEIVERS, Shader,
};
use crate::{error::Error, gpu::Gpu, params::Settings};

const MOMENTS: &str = include_str!("moments.wgsl");

pub(super) const PASSES: Shader = Shader {
    name: "evsm moments",
    parts: &[FULLSCREEN, MOMENTS_DEPTH, MOMENTS_FLOAT, MOMENTS_MEAN, MOMENTS, MOMENTS_PASSES],
    layouts: PASS_LAYOUTS,
};
pub(super) const LOOKUP: Shader = Shader {
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

pub(super) fn make(gpu: &Gpu, settings: &Settings) -> Result<MapTechnique, Error> {
    let half = settings.choice("format") == "16";
    let coding = if half { Coding::Half } else { Coding::Single };
    let channels = if settings.choice("components") == "2" { 2 } else { 4 };
    let growth = growth(settings, if half { 5.54 } else { 42.0 });
    let warps = [("GROWTH", growth), ("DECAY", growth)];
    let recipe = Recipe { passes: PASSES, channels, coding, constants: warps.to_vec() };
    let stage = MomentStage::new(gpu, settings, &recipe);
    let reach = stage.reach();
    let constants = [
        warps[0],
        warps[1],
        ("COMPONENTS", f64::from(channels)),
        ("MIPS", f64::from(u8::from(settings.switch("mips")))),
        ("BLEEDING", settings.float("bleeding")),
        ("LEAST_VARIANCE", if half { 2e-3 } else { 1e-6 }),
    ];
    MapTechnique::staged(gpu, settings, &LOOKUP, reach, &constants, Some(Box::new(stage)))
}

//! A filter that follows the light.

use super::growth;
use crate::depth_maps::{MapTechnique, TAP_LAYOUTS, Taps};
use crate::moment_maps::{Coding, MomentStage, PASS_LAYOUTS, Recipe};
use crate::shader::{
    FULLSCREEN, LIGHT_KERNEL, MAP_CELLS, MAP_LOOKUP, MAP_TAPS, MAP_VISIBILITY, MOMENTS_DEPTH, MOMENTS_FLOAT,
    MOMENTS_MEAN, MOMENTS_PASSES, MOMENTS_SOFT, MOMENTS_UNORM, RECEIVERS, SOFT_TAPS, Shader,
};
use crate::{error::Error, gpu::Gpu, params::Settings};

const MOMENTS: &str = include_str!("soft_moments.wgsl");
const BOUNDS: &str = include_str!("soft_bounds.wgsl");
const SOFT: &str = include_str!("soft.wgsl");

pub(super) const PASSES: Shader = Shader {
    name: "soft evsm moments",
    parts: &[FULLSCREEN, MOMENTS_DEPTH, MOMENTS_FLOAT, MOMENTS_MEAN, MOMENTS, MOMENTS_PASSES],
    layouts: PASS_LAYOUTS,
};
pub(super) const PASSES_16: Shader = Shader {
    name: "soft evsm moments, 16 bits",
    parts: &[FULLSCREEN, MOMENTS_DEPTH, MOMENTS_UNORM, MOMENTS_MEAN, MOMENTS, MOMENTS_PASSES],
    layouts: PASS_LAYOUTS,
};
pub(super) const LOOKUP: Shader = Shader {
    name: "soft evsm",
    parts: &[
        FULLSCREEN,
        RECEIVERS,
        MAP_LOOKUP,
        MAP_VISIBILITY,
        LIGHT_KERNEL,
        MAP_TAPS,
        MAP_CELLS,
        SOFT_TAPS,
        MOMENTS_DEPTH,
        MOMENTS_FLOAT,
        MOMENTS,
        MOMENTS_SOFT,
        BOUNDS,
        SOFT,
    ],
    layouts: TAP_LAYOUTS,
};
pub(super) const LOOKUP_16: Shader = Shader {
    name: "soft evsm, 16 bits",
    parts: &[
        FULLSCREEN,
        RECEIVERS,
        MAP_LOOKUP,
        MAP_VISIBILITY,
        LIGHT_KERNEL,
        MAP_TAPS,
        MAP_CELLS,
        SOFT_TAPS,
        MOMENTS_DEPTH,
        MOMENTS_UNORM,
        MOMENTS,
        MOMENTS_SOFT,
        BOUNDS,
        SOFT,
    ],
    layouts: TAP_LAYOUTS,
};

/// Taps that look for blockers, and that filter. What lies between these is in the moments.
const SEARCH: u32 = 24;
const FILTER: u32 = 20;

pub(super) fn make(gpu: &Gpu, settings: &Settings) -> Result<MapTechnique, Error> {
    let half = settings.choice("format") == "16";
    let (passes, lookup, coding) =
        if half { (PASSES_16, LOOKUP_16, Coding::Unorm) } else { (PASSES, LOOKUP, Coding::Single) };
    let growth = ("GROWTH", growth(settings, if half { 5.54 } else { 42.0 }));
    let recipe = Recipe { passes, channels: 4, coding, constants: vec![growth] };
    let stage = MomentStage::soft(gpu, settings, &recipe, Taps::even(SEARCH, FILTER));
    let reach = stage.reach();
    let constants = [
        growth,
        ("SEARCH", f64::from(SEARCH)),
        ("FILTER", f64::from(FILTER)),
        ("BLEEDING", settings.float("bleeding")),
        ("LEAST_VARIANCE", if half { 2e-3 } else { 1e-6 }),
        ("LEAST_DEPTH_VARIANCE", if half { 3e-5 } else { 1e-7 }),
    ];
    Ok(MapTechnique::staged(gpu, settings, &lookup, reach, &constants, Some(Box::new(stage)))?.soft())
}

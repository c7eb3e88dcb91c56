//! A filter that follows the light.

use super::Evsm;
use crate::depth_maps::{MapSetup, MapTechnique, Taps};
use crate::moment_maps::{Coding, MomentStage, Recipe};
use crate::shader::{Module, Shader};
use crate::{error::Error, gpu::Gpu};

const MODULES: &[Module] = &[
    Module { name: "soft_moments", source: include_str!("soft_moments.wgsl") },
    Module { name: "soft_bounds", source: include_str!("soft_bounds.wgsl") },
    Module { name: "soft", source: include_str!("soft.wgsl") },
];

const fn shader(name: &'static str, needs: &'static str) -> Shader {
    Shader::new(name, needs).with_modules(MODULES)
}

pub(super) const PASSES: Shader = shader("soft evsm moments", "// needs: moments_passes, moments_float, soft_moments");
pub(super) const PASSES_16: Shader =
    shader("soft evsm moments, 16 bits", "// needs: moments_passes, moments_unorm, soft_moments");
pub(super) const LOOKUP: Shader = shader("soft evsm", "// needs: soft, moments_float");
pub(super) const LOOKUP_16: Shader = shader("soft evsm, 16 bits", "// needs: soft, moments_unorm");

/// Taps that look for blockers, and that filter. What lies between these is in the moments.
const SEARCH: u32 = 24;
const FILTER: u32 = 20;

pub(super) fn make(evsm: &Evsm, gpu: &Gpu, maps: &MapSetup) -> Result<MapTechnique, Error> {
    let half = evsm.filtering.is_half();
    let (passes, lookup, coding) =
        if half { (PASSES_16, LOOKUP_16, Coding::Unorm) } else { (PASSES, LOOKUP, Coding::Single) };
    let growth = ("GROWTH", evsm.growth(maps.size, if half { 5.54 } else { 42.0 }));
    let recipe = Recipe { passes, channels: 4, coding, constants: vec![growth] };
    let stage = MomentStage::soft(gpu, maps.size, &evsm.filtering, &recipe, Taps::even(SEARCH, FILTER));
    let (reach, bytes) = (stage.reach(), stage.soft_lookup_bytes(SEARCH, FILTER));
    let constants = [
        growth,
        ("SEARCH", f64::from(SEARCH)),
        ("FILTER", f64::from(FILTER)),
        ("BLEEDING", evsm.bleeding),
        ("LEAST_VARIANCE", if half { 2e-3 } else { 1e-6 }),
        ("LEAST_DEPTH_VARIANCE", if half { 3e-5 } else { 1e-7 }),
    ];
    Ok(MapTechnique::staged(gpu, maps, &lookup, reach, &constants, Some(Box::new(stage)))?.soft().reading(bytes))
}

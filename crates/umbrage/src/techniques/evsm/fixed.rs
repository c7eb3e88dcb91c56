//! A filter of one width.

use super::Components;
use super::Evsm;
use crate::depth_maps::{MapSetup, MapTechnique};
use crate::moment_maps::{Coding, MomentStage, Recipe};
use crate::shader::{Module, Shader};
use crate::{error::Error, gpu::Gpu};

const MODULES: &[Module] = &[
    Module { name: "moments", source: include_str!("moments.wgsl") },
    Module { name: "bounds", source: include_str!("bounds.wgsl") },
    Module { name: "evsm", source: include_str!("evsm.wgsl") },
];

pub(super) const PASSES: Shader =
    Shader::new("evsm moments", "// needs: moments_passes, moments_float, moments").with_modules(MODULES);
pub(super) const LOOKUP: Shader = Shader::new("evsm", "// needs: evsm, moments_float").with_modules(MODULES);

pub(super) fn make(evsm: &Evsm, gpu: &Gpu, maps: &MapSetup) -> Result<MapTechnique, Error> {
    let half = evsm.filtering.is_half();
    let coding = if half { Coding::Half } else { Coding::Single };
    let channels = if evsm.components == Components::Two { 2 } else { 4 };
    let growth = evsm.growth(maps.size, if half { 5.54 } else { 42.0 });
    // Squares of the least warp times the least weight of a filter are still normal numbers of
    // single precision then, and four squares of the largest are numbers.
    let lift = if half { 0.0 } else { 1.5 };
    let warps = [("GROWTH", growth), ("DECAY", growth), ("LIFT", lift)];
    let recipe = Recipe { passes: PASSES, channels, coding, constants: warps.to_vec() };
    let stage = MomentStage::new(gpu, maps.size, &evsm.filtering, &recipe);
    let (reach, bytes) = (stage.reach(), stage.lookup_bytes());
    let constants = [
        warps[0],
        warps[1],
        warps[2],
        ("COMPONENTS", f64::from(channels)),
        ("MIPS", f64::from(u8::from(evsm.filtering.mips))),
        ("BLEEDING", evsm.bleeding),
        ("LEAST_VARIANCE", if half { 2e-3 } else { 1e-6 }),
    ];
    Ok(MapTechnique::staged(gpu, maps, &LOOKUP, reach, &constants, Some(Box::new(stage)))?.reading(bytes))
}

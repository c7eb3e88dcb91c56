//! A filter of one width.

use super::growth;
use crate::depth_maps::MapTechnique;
use crate::moment_maps::{Coding, MomentStage, Recipe};
use crate::shader::{Module, Shader};
use crate::{error::Error, gpu::Gpu, params::Settings};

const MODULES: &[Module] = &[
    Module { name: "moments", source: include_str!("moments.wgsl") },
    Module { name: "bounds", source: include_str!("bounds.wgsl") },
    Module { name: "evsm", source: include_str!("evsm.wgsl") },
];

pub(super) const PASSES: Shader =
    Shader::new("evsm moments", "// needs: moments_passes, moments_float, moments").with_modules(MODULES);
pub(super) const LOOKUP: Shader = Shader::new("evsm", "// needs: evsm, moments_float").with_modules(MODULES);

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

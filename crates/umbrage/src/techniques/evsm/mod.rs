//! Exponential variance shadow maps: variance shadow maps of depths that an exponential spreads out.
//!
//! Sources: FE 2.3.1; Lauritzen and McCool, "Layered Variance Shadow Maps", 2008, section 3; Lauritzen's thesis, 2008.

mod fixed;
mod soft;

use crate::depth_maps::{BIAS, BOUNDS_SHADER, CACHE, FACES, FOCUS, LAYER_NAMES, LIGHTS, OMNI, SHADERS, SIZE};
use crate::moment_maps::{FORMAT, MIPS, RADIUS};
use crate::params::{Param, ParamKind, Settings};
use crate::technique::TechniqueInfo;

const SOFTNESS: Param = Param {
    name: "softness",
    help: "Width of penumbras: that of the filter, or what the light's size and the blocker's distance make it.",
    unit: "",
    kind: ParamKind::Choice { values: &["fixed", "light"] },
};

const COMPONENTS: Param = Param {
    name: "components",
    help: "Numbers a texel: 4 for a growing and a falling exponential, 2 for the growing one alone. Of `softness = fixed`.",
    unit: "",
    kind: ParamKind::Choice { values: &["4", "2"] },
};

const BLEEDING: Param = Param {
    name: "bleeding",
    help: "Shares of light up to this count as none, the rest is stretched: takes light that bleeds through off.",
    unit: "",
    kind: ParamKind::Float { min: 0.0, max: 0.9, default: 0.1 },
};

/// Steepness of the growing exponential over half the range of depth. Its square is to stay in the format's range; and within a filter as
/// wide as `radius` depth changes by more where the map is coarser, and a steep exponential then sees the nearest of it alone.
fn growth(settings: &Settings, steepest: f64) -> f64 {
    f64::min(steepest, 0.25 * settings.int("size") as f64 / settings.float("radius").max(1.0))
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "evsm",
    title: "Exponential variance shadow maps",
    summary: "Variance shadow maps of exponentials of depth, which part receiver and blocker and keep light from bleeding.",
    source: "FE 2.3.1",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[SIZE, SOFTNESS, RADIUS, COMPONENTS, BLEEDING, FORMAT, MIPS, FACES, OMNI, FOCUS, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &[
        SHADERS[0],
        SHADERS[1],
        SHADERS[2],
        fixed::PASSES,
        fixed::LOOKUP,
        BOUNDS_SHADER,
        soft::PASSES,
        soft::PASSES_16,
        soft::LOOKUP,
        soft::LOOKUP_16,
    ],
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let make = if settings.choice("softness") == "light" { soft::make } else { fixed::make };
        Ok(Box::new(make(gpu, settings)?.with_every_caster()))
    },
};

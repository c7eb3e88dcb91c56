//! A light mask: every point keeps one bit for each sample of the light, and triangles strike them out, so that what casters
//! share counts once.
//!
//! Sources: Schwarz and Stamminger 2007; Sintorn et al. 2008.

mod casters;
mod grown;
mod half_planes;
mod mask;
mod samples;
mod technique;
mod tree;

use crate::params::{Param, ParamKind};
use crate::technique::TechniqueInfo;
use umbrage_core::LightKinds;

const PARAMS: &[Param] = &[
    Param {
        name: "samples",
        help: "Samples of the light; rounded up to a multiple of 32.",
        unit: "",
        kind: ParamKind::Int { min: 32, max: 256, default: 256 },
    },
    Param {
        name: "radius",
        help: "Radius of point and spot lights, which are hard without one.",
        unit: "m",
        kind: ParamKind::Float { min: 0.0, max: 1000.0, default: 0.0 },
    },
];

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: technique::ID,
    title: "Light mask",
    summary: "Strikes out what every triangle hides of the light's samples: right for any triangles, wherever casters overlap, \
              to within the number of samples.",
    source: "Schwarz and Stamminger 2007; Sintorn et al. 2008",
    lights: LightKinds::ALL,
    features: wgpu::Features::empty(),
    hard: false,
    params: PARAMS,
    views: &[],
    shaders: &[mask::MASK_SHADER],
    readme: include_str!("README.md"),
    make: |_, settings| {
        let samples = settings.int("samples") as u32;
        Ok(Box::new(technique::LightMask::new(samples, settings.float("radius"))))
    },
};

//! Soft shadow volumes: a penumbra wedge for every silhouette edge corrects the hard shadow, all of a light's in one draw.
//!
//! Sources: Assarsson and Akenine-Möller 2003; SG "A Soft Shadow Volume Algorithm"; PX 4, 6 and 7.2.

mod budget;
mod draws;
mod old_ways;
mod one_draw;
mod options;
mod piece;
mod pipelines;
mod records;
mod select;
mod shaders;
mod stages;
mod tables;
mod targets;
mod technique;
mod views;
mod way;

use crate::params::{Param, ParamKind};
use crate::shader::Shader;
use crate::silhouettes::FIND_SHADER;
use crate::technique::TechniqueInfo;
use umbrage_core::LightKinds;

const PARAMS: &[Param] = &[
    Param {
        name: "batch",
        help: "What is drawn at once: all wedges of the light; every caster whose silhouette is one convex loop, and the others as they \
               are; or one wedge after the other, in two halves.",
        unit: "",
        kind: ParamKind::Choice { values: &["all", "per-loop", "per-wedge"] },
    },
    Param {
        name: "combine",
        help: "What becomes of casters that hide the same part of the light: their shares add up, or the largest counts.",
        unit: "",
        kind: ParamKind::Choice { values: &["sum", "max"] },
    },
    Param {
        name: "cull",
        help: "Who finds what is in no wedge: the shader, or a stencil mask before it; auto: the mask for one wedge after the other.",
        unit: "",
        kind: ParamKind::Choice { values: &["auto", "shader", "stencil"] },
    },
    Param {
        name: "scale",
        help: "Size of the buffer that shares add up in, against the picture.",
        unit: "",
        kind: ParamKind::Choice { values: &["1", "1/2", "1/4"] },
    },
    Param {
        name: "budget-ms",
        help: "Time on the GPU by which the scale is chosen in every frame; 0 leaves it.",
        unit: "ms",
        kind: ParamKind::Float { min: 0.0, max: 1000.0, default: 0.0 },
    },
    Param {
        name: "split-light",
        help: "Columns and rows that the light is split into, each piece with silhouettes of its own; a line into that many parts.",
        unit: "",
        kind: ParamKind::Int { min: 1, max: 3, default: 1 },
    },
    Param {
        name: "coverage",
        help: "Where the share that an edge covers of a sphere, an ellipsoid, a disc or a sun comes from: a formula, or two look-ups of 32³ \
               values. Textured rectangles always have a table, other lights none.",
        unit: "",
        kind: ParamKind::Choice { values: &["analytic", "table"] },
    },
    Param {
        name: "radius",
        help: "Radius of point and spot lights, which are hard without one.",
        unit: "m",
        kind: ParamKind::Float { min: 0.0, max: 1000.0, default: 0.0 },
    },
    Param {
        name: "unseen",
        help: "For hosts that cull faces or hide casters from the camera: counts all from infinity, with both sides of meshes.",
        unit: "",
        kind: ParamKind::Choice { values: &["off", "on"] },
    },
];

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: options::ID,
    title: "Penumbra wedges",
    summary: "Corrects hard shadow volumes by what every silhouette edge covers of the light: soft shadows without noise, exact \
              where the silhouette is the same from all of the light.",
    source: "PX 4, 6, 7.2; SG \"A Soft Shadow Volume Algorithm\"",
    lights: LightKinds::ALL,
    features: wgpu::Features::empty(),
    hard: false,
    params: PARAMS,
    views: views::NAMES,
    shaders: SHADERS,
    readme: include_str!("README.md"),
    make: |gpu, settings| Ok(Box::new(technique::Wedges::new(gpu, settings)?)),
};

const SHADERS: &[Shader] = &[
    FIND_SHADER,
    shaders::MAKE,
    shaders::BUNDLE,
    shaders::CAPS,
    shaders::DRAWS[0],
    shaders::DRAWS[1],
    shaders::DRAWS[2],
    shaders::DEPTH,
    shaders::RESOLVE,
    shaders::RESOLVE_PICTURE,
    shaders::VIEWS,
    shaders::VIEW_BODIES,
    old_ways::SHADERS[0],
    old_ways::SHADERS[1],
    old_ways::SHADERS[2],
    old_ways::SHADERS[3],
    old_ways::SHADERS[4],
];

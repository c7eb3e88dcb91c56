//! Soft shadow volumes: a penumbra wedge for every silhouette edge corrects the hard shadow, all of a light's in one draw.
//!
//! Sources: Assarsson and Akenine-Möller 2003; SG "A Soft Shadow Volume Algorithm"; PX 4, 6 and 7.2.

mod budget;
mod draws;
mod groups;
mod options;
mod piece;
mod pipelines;
mod select;
mod tables;
mod targets;
mod technique;
mod views;

use crate::params::{Param, ParamKind};
use crate::shader::{Module, Shader};
use crate::silhouettes::FIND_SHADER;
use crate::technique::TechniqueInfo;
use umbrage_core::LightKinds;

/// What the shaders of this folder need of each other.
const MODULES: &[Module] = &[
    Module { name: "coverage", source: include_str!("coverage.wgsl") },
    Module { name: "record", source: include_str!("record.wgsl") },
    Module { name: "body", source: include_str!("body.wgsl") },
    Module { name: "cell", source: include_str!("cell.wgsl") },
    Module { name: "draw", source: include_str!("draw.wgsl") },
    Module { name: "resolve", source: include_str!("resolve.wgsl") },
    Module { name: "term_analytic", source: include_str!("term_analytic.wgsl") },
    Module { name: "term_table", source: include_str!("term_table.wgsl") },
    Module { name: "term_picture", source: include_str!("term_picture.wgsl") },
];

const fn shader(name: &'static str, source: &'static str) -> Shader {
    Shader::new(name, source).with_modules(MODULES)
}

const MAKE_SHADER: Shader = shader("make wedges", include_str!("make.wgsl"));

const BUNDLE_SHADER: Shader = shader("bundle wedges", include_str!("bundle.wgsl"));

const CAPS_SHADER: Shader = shader("make caps", include_str!("caps.wgsl"));

const DRAW_SHADER: Shader = shader("wedges", "// needs: draw, term_analytic").with_constants(targets::RECORDS);

const RESOLVE_SHADER: Shader = shader("wedge visibility", include_str!("horizon_analytic.wgsl"));

/// What a loop or a caster that was drawn apart comes to.
const APART_SHADER: Shader = Shader::new("a loop's shares", include_str!("apart.wgsl"));

const DEPTH_SHADER: Shader = shader("depth of wedges", include_str!("depth.wgsl"));

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
    id: "wedges",
    title: "Penumbra wedges",
    summary: "Corrects hard shadow volumes by what every silhouette edge covers of the light: soft shadows without noise, exact \
              where the silhouette is the same from all of the light.",
    source: "PX 4, 6, 7.2; SG \"A Soft Shadow Volume Algorithm\"",
    lights: LightKinds::ALL,
    features: wgpu::Features::empty(),
    hard: false,
    params: PARAMS,
    views: views::NAMES,
    shaders: &[
        FIND_SHADER,
        MAKE_SHADER,
        BUNDLE_SHADER,
        CAPS_SHADER,
        DRAW_SHADER,
        APART_SHADER,
        DEPTH_SHADER,
        RESOLVE_SHADER,
        tables::TABLE_SHADER,
        tables::PICTURE_SHADER,
        tables::RESOLVE_PICTURE_SHADER,
        views::VIEWS_SHADER,
        views::BODIES_SHADER,
    ],
    readme: include_str!("README.md"),
    make: |gpu, settings| Ok(Box::new(technique::Wedges::new(gpu, settings)?)),
};

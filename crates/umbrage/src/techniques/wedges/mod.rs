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

use crate::area_light::{AREA_LIGHT as LIGHT, Anchor, AreaLight};
use crate::casters::{EDGES_WGSL, INSTANCES_WGSL, Instance};
use crate::depth_maps::Eye;
use crate::params::{Param, ParamKind};
use crate::shader::{FULLSCREEN, RECEIVERS, Shader};
use crate::silhouettes::{Caster, FIND_SHADER};
use crate::technique::TechniqueInfo;
use umbrage_core::LightKinds;

const COVERAGE: &str = include_str!("coverage.wgsl");
const RECORD: &str = include_str!("record.wgsl");
const BODY: &str = include_str!("body.wgsl");
const CELL: &str = include_str!("cell.wgsl");

const MAKE_SHADER: Shader = Shader {
    name: "make wedges",
    parts: &[INSTANCES_WGSL, EDGES_WGSL, LIGHT, RECORD, BODY, include_str!("make.wgsl")],
    layouts: &[AreaLight::LAYOUT, Anchor::LAYOUT, Caster::LAYOUT, Instance::LAYOUT],
};

const BUNDLE_SHADER: Shader = Shader {
    name: "bundle wedges",
    parts: &[LIGHT, RECORD, BODY, include_str!("bundle.wgsl")],
    layouts: &[AreaLight::LAYOUT, Anchor::LAYOUT],
};

const CAPS_SHADER: Shader = Shader {
    name: "make caps",
    parts: &[INSTANCES_WGSL, EDGES_WGSL, LIGHT, RECORD, include_str!("caps.wgsl")],
    layouts: &[AreaLight::LAYOUT, Anchor::LAYOUT, Caster::LAYOUT, Instance::LAYOUT],
};

const DRAW_SHADER: Shader = Shader {
    name: "wedges",
    parts: &[RECEIVERS, LIGHT, COVERAGE, CELL, RECORD, include_str!("draw.wgsl"), include_str!("term_analytic.wgsl")],
    layouts: &[AreaLight::LAYOUT, Anchor::LAYOUT, Eye::LAYOUT],
};

const RESOLVE_SHADER: Shader = Shader {
    name: "wedge visibility",
    parts: &[
        FULLSCREEN,
        RECEIVERS,
        LIGHT,
        COVERAGE,
        include_str!("term_analytic.wgsl"),
        include_str!("resolve.wgsl"),
        include_str!("horizon_analytic.wgsl"),
    ],
    layouts: &[AreaLight::LAYOUT, Eye::LAYOUT],
};

/// What a loop or a caster that was drawn apart comes to.
const APART_SHADER: Shader = Shader { name: "a loop's shares", parts: &[include_str!("apart.wgsl")], layouts: &[] };

const DEPTH_SHADER: Shader = Shader {
    name: "depth of wedges",
    parts: &[FULLSCREEN, RECEIVERS, LIGHT, include_str!("depth.wgsl")],
    layouts: &[AreaLight::LAYOUT, Eye::LAYOUT],
};

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

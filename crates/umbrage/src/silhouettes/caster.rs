//! Casters of one light: what a technique says of them, and what the shaders read.

use crate::casters::{Casters, Edges};
use crate::shader::{HostConstant, shader_struct};
use umbrage_core::glam::{DVec4, Vec3};
use umbrage_core::silhouette::{Rule, light_in_mesh};

/// A caster to extrude.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Throw {
    /// Its number in [`Casters::placed`].
    pub place: u32,
    /// From where its silhouette is seen: a place of the light, or a direction to it (w = 0).
    pub light: DVec4,
    pub rule: Rule,
    /// A body with holes: what it covers with its near side and with its far side is nearly the
    /// same and counts once.
    pub is_body: bool,
    /// Wedges only: counted from infinity instead of from the eye.
    pub from_infinity: bool,
    /// Volumes only: the same, with sides in a part of their own; needs caps.
    pub z_fail: bool,
    pub light_cap: bool,
    pub dark_cap: bool,
    /// The plane n · p = w where the shadow may end since nothing that is seen lies beyond, in
    /// world space; zero for none.
    pub end: DVec4,
    /// Where the shadow ends otherwise, metres from the light; 0 for nowhere.
    pub reach: f32,
    /// Wedges only, in the light's own space: from where the silhouette is seen, and the x axis of
    /// a piece of a sphere.
    pub anchor: [Vec3; 2],
}

shader_struct! {
    /// A caster under one light, see `casters/edges.wgsl`.
    pub(crate) struct Caster {
        light: [f32; 4],
        end: [f32; 4],
        first_edge: u32,
        edge_count: u32,
        edge_chunk: u32,
        first_triangle: u32,
        triangle_count: u32,
        triangle_chunk: u32,
        first_index: u32,
        base_vertex: u32,
        instance: u32,
        flags: u32,
        reach: f32,
        pad: u32,
        seen_from: [f32; 3],
        pad_seen_from: f32,
        axis: [f32; 3],
        pad_axis: f32,
    }
}

/// Bits of `Caster::flags`.
pub(super) const AWAY: u32 = 1;
const MIRRORED: u32 = 2;
pub(super) const Z_FAIL: u32 = 4;
pub(super) const LIGHT_CAP: u32 = 8;
pub(super) const DARK_CAP: u32 = 16;
const BODY: u32 = 32;
const COUNT_FROM_INFINITY: u32 = 64;

/// Edges, or triangles, of one caster that go together.
pub(super) const CHUNK: u32 = 64;

/// Words that a list starts with: for each part where its entries start and how many there are. The
/// chunks follow.
pub(super) const HEADER: u32 = 8;

/// The same for `casters/edges.wgsl`.
pub(super) const FLAGS: &[HostConstant] = &[
    ("AWAY", AWAY as f64),
    ("MIRRORED", MIRRORED as f64),
    ("Z_FAIL", Z_FAIL as f64),
    ("LIGHT_CAP", LIGHT_CAP as f64),
    ("DARK_CAP", DARK_CAP as f64),
    ("BODY", BODY as f64),
    ("COUNT_FROM_INFINITY", COUNT_FROM_INFINITY as f64),
    ("CHUNK", CHUNK as f64),
    ("HEADER", HEADER as f64),
];

/// A caster as the shaders see it; chunks are filled in later.
pub(super) fn caster(casters: &Casters, edges: &Edges, throw: &Throw) -> Option<Caster> {
    let placed = &casters.placed()[throw.place as usize];
    let part = &casters.meshes()[placed.mesh as usize];
    let mesh = edges.of_mesh(placed.mesh);
    let sides = placed.sides?;
    let flags = [
        (throw.rule == Rule::Away, AWAY),
        (sides.is_mirrored, MIRRORED),
        (throw.z_fail, Z_FAIL),
        (throw.light_cap, LIGHT_CAP),
        (throw.dark_cap, DARK_CAP),
        (throw.is_body, BODY),
        (throw.from_infinity, COUNT_FROM_INFINITY),
    ];
    let end = throw.end.truncate();
    Some(Caster {
        end: end.extend(throw.end.w - end.dot(casters.origin())).as_vec4().to_array(),
        light: light_in_mesh(throw.light, &sides.mesh_from_world, mesh.adjacency.center).to_array(),
        first_edge: mesh.first_edge,
        edge_count: mesh.adjacency.edges.len() as u32,
        first_triangle: mesh.first_triangle,
        triangle_count: mesh.triangle_count,
        first_index: part.first_index,
        base_vertex: part.base_vertex,
        instance: throw.place,
        flags: flags.into_iter().filter(|(on, _)| *on).map(|(_, bit)| bit).sum(),
        reach: throw.reach,
        seen_from: throw.anchor[0].to_array(),
        axis: throw.anchor[1].to_array(),
        ..Caster::default()
    })
}

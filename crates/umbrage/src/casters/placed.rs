//! A placed mesh: what the GPU and what the CPU keep of it.

use super::sides::Sides;
use crate::shader::{Shared, shader_struct};
use std::ops::Range;
use umbrage_core::Bounds;
use umbrage_core::glam::{DAffine3, DVec3, DVec4};

/// What the host has to agree on with `instances.wgsl`.
pub(super) const SHARED: Shared = Shared {
    module: "instances",
    layouts: &[Instance::LAYOUT],
    constants: &[("RECEIVES", RECEIVES as f64), ("CASTS", CASTS as f64)],
};

shader_struct! {
    /// A placed mesh; the rows of an affine matrix from mesh space to world space about
    /// [`super::Casters::origin`].
    pub(crate) struct Instance {
        row0: [f32; 4],
        row1: [f32; 4],
        row2: [f32; 4],
        material: u32,
        flags: u32,
        model: u32,
        spare: u32,
    }
}

/// Bits of `Instance::flags`: shadows fall on it; it casts shadows.
pub(super) const RECEIVES: u32 = 1;
pub(super) const CASTS: u32 = 2;

/// Instances of one mesh with one texture: one draw.
pub(super) struct Batch {
    pub(super) indices: Range<u32>,
    pub(super) base_vertex: i32,
    /// Index into the textures.
    pub(super) texture: usize,
    pub(super) masked: bool,
    /// The mesh lies in a plane.
    pub(super) flat: bool,
    /// The mesh is the surface of a convex body, opaque.
    pub(super) solid: bool,
    /// Indices into `placed`.
    pub(super) members: Range<usize>,
}

/// What the CPU keeps of an instance, in the order of the batches.
pub(crate) struct Placed {
    pub number: u32,
    /// Index into [`super::Casters::meshes`].
    pub mesh: u32,
    /// Its mesh is its own, and the GPU alone knows its vertices.
    pub posed: bool,
    pub world_from_mesh: DAffine3,
    pub sides: Option<Sides>,
    pub masked: bool,
    pub(super) mesh_bounds: Bounds,
    pub bounds: Bounds,
    /// Of a flat mesh, in its own space.
    pub(super) mesh_plane: Option<DVec4>,
    pub(super) plane: Option<DVec4>,
    pub casts: bool,
    pub receives: bool,
    pub(super) data: Instance,
}

/// True where a placed mesh keeps its winding, and enough thickness that rounding can't turn it.
pub(super) fn is_outward(world_from_mesh: &DAffine3) -> bool {
    let m = world_from_mesh.matrix3;
    m.determinant() > 1e-4 * m.x_axis.length() * m.y_axis.length() * m.z_axis.length()
}

/// A plane taken from mesh to world space.
pub(super) fn moved_plane(plane: DVec4, world_from_mesh: &DAffine3) -> DVec4 {
    let normal = world_from_mesh.matrix3.inverse().transpose() * plane.truncate();
    let normal = normal.normalize_or_zero();
    let on_plane = world_from_mesh.transform_point3(plane.truncate() * -plane.w);
    normal.extend(-normal.dot(on_plane))
}

pub(super) fn rows(world_from_mesh: &DAffine3, origin: DVec3) -> Instance {
    let m = world_from_mesh.matrix3.transpose();
    let t = world_from_mesh.translation - origin;
    let row = |axis: DVec3, t: f64| axis.extend(t).as_vec4().to_array();
    Instance { row0: row(m.x_axis, t.x), row1: row(m.y_axis, t.y), row2: row(m.z_axis, t.z), ..Instance::default() }
}

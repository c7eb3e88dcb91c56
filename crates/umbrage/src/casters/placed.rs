//! A placed mesh: what the GPU and what the CPU keep of it.

use super::lent::Many;
use super::sides::Sides;
use crate::shader::{Shared, shader_struct};
use std::sync::Arc;
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
const RECEIVES: u32 = 1;
const CASTS: u32 = 2;

/// What the CPU keeps of an instance; its place in [`super::Casters::placed`] is its number on the
/// GPU.
pub(crate) struct Placed {
    /// Index into [`super::Casters::meshes`].
    pub mesh: u32,
    /// The GPU alone knows its vertices.
    pub posed: bool,
    /// Its mesh is its own, which joints bend.
    pub(super) has_own_mesh: bool,
    /// Matrices of a host's, each of which places the mesh within this instance.
    pub(super) many: Option<Arc<Many>>,
    /// It casts, and nobody knows its edges.
    pub(super) is_blind: bool,
    pub world_from_mesh: DAffine3,
    pub sides: Option<Sides>,
    pub masked: bool,
    pub bounds: Bounds,
    /// Of a flat mesh.
    pub(super) plane: Option<DVec4>,
    /// False for one that is hidden, too.
    pub casts: bool,
    pub receives: bool,
    /// It is there, and not hidden.
    pub shown: bool,
    /// What [`super::Casters::show`] brings back.
    pub(super) wanted: Wanted,
    /// Index into the materials.
    pub(super) material: u32,
    pub(super) model: u32,
    /// When it came: what casters are drawn and counted in the order of.
    pub(super) order: u64,
    /// Where in the lists of its mesh and of its material it stands.
    pub(super) member: [u32; 2],
    pub(super) batch: u32,
    pub(super) is_batched: bool,
}

/// What an instance does where it is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Wanted {
    pub casts: bool,
    pub receives: bool,
}

impl Placed {
    /// A place where nothing is.
    pub(super) fn nothing() -> Self {
        Self {
            mesh: 0,
            posed: false,
            has_own_mesh: false,
            many: None,
            is_blind: false,
            world_from_mesh: DAffine3::IDENTITY,
            sides: None,
            masked: false,
            bounds: Bounds::EMPTY,
            plane: None,
            casts: false,
            receives: false,
            shown: false,
            wanted: Wanted::default(),
            material: 0,
            model: 0,
            order: u64::MAX,
            member: [0; 2],
            batch: 0,
            is_batched: false,
        }
    }

    /// Joints bend it.
    pub fn is_bent(&self) -> bool {
        self.has_own_mesh
    }

    /// What the GPU keeps of it.
    pub(super) fn data(&self, origin: DVec3) -> Instance {
        Instance {
            material: self.material,
            flags: u32::from(self.receives) * RECEIVES + u32::from(self.casts) * CASTS,
            model: self.model,
            ..rows(&self.world_from_mesh, origin)
        }
    }
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

fn rows(world_from_mesh: &DAffine3, origin: DVec3) -> Instance {
    let m = world_from_mesh.matrix3.transpose();
    let t = world_from_mesh.translation - origin;
    let row = |axis: DVec3, t: f64| axis.extend(t).as_vec4().to_array();
    Instance { row0: row(m.x_axis, t.x), row1: row(m.y_axis, t.y), row2: row(m.z_axis, t.z), ..Instance::default() }
}

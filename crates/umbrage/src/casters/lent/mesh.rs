//! Vertices and indices in buffers of a host's own.

use std::ops::Range;
use umbrage_core::{Bounds, Mesh};

/// A mesh in buffers of the host's, see [`crate::Casters::lend_mesh`]. They are read where they
/// are, in every frame; the host may write to them between frames, see
/// [`crate::Casters::touch_mesh`].
#[derive(Clone, Debug)]
pub struct LentMesh<'a> {
    /// `Float32x3` or `Float32x4`, `Unorm16x4`, `Snorm16x4` or `Float16x4`, of which the first
    /// three numbers count.
    pub positions: LentVertices,
    /// How many vertices there are; texture coordinates as well.
    pub vertex_count: u32,
    /// `Float32x2`, `Unorm16x2`, `Snorm16x2` or `Float16x2`: what alpha masks are looked up by.
    /// Without any they all are 0.
    pub uvs: Option<LentVertices>,
    /// Corners of triangles.
    pub indices: LentIndices,
    /// What the library knows of vertices and triangles.
    pub shape: LentShape<'a>,
}

/// Vertices in a buffer that was made with [`wgpu::BufferUsages::VERTEX`].
#[derive(Clone, Debug, PartialEq)]
pub struct LentVertices {
    /// The host's, of the same device.
    pub buffer: wgpu::Buffer,
    /// Bytes to what is read of the first vertex, a multiple of 4.
    pub offset: u64,
    /// Bytes from one vertex to the next: a multiple of 4, and no more than the device's
    /// `max_vertex_buffer_array_stride`.
    pub stride: u64,
    /// How it is stored.
    pub format: wgpu::VertexFormat,
}

/// Triangles in a buffer that was made with [`wgpu::BufferUsages::INDEX`].
#[derive(Clone, Debug, PartialEq)]
pub struct LentIndices {
    /// The host's, of the same device.
    pub buffer: wgpu::Buffer,
    /// 16 or 32 bits each.
    pub format: wgpu::IndexFormat,
    /// Which indices of the buffer; three a triangle. Nobody can check on the CPU that they lead to
    /// vertices: what a wrong one draws is up to the driver, within the host's buffer.
    pub range: Range<u32>,
    /// Added to each of them.
    pub base_vertex: u32,
}

/// What is known on the CPU of a mesh that is lent. Depth maps need a box alone; techniques with
/// edges ([`crate::Needs::Edges`]) need to know which triangles are neighbours.
#[derive(Clone, Copy, Debug)]
pub enum LentShape<'a> {
    /// A box around all vertices, in mesh space. Techniques that need more than depth refuse such a
    /// mesh.
    Unknown(Bounds),
    /// The same mesh, which stays as it is. Its vertex number 0 is [`LentIndices::base_vertex`].
    Rigid(&'a Mesh),
    /// The same triangles, whose vertices the host moves on the GPU; and a box around where they
    /// are. The buffer of positions needs [`wgpu::BufferUsages::STORAGE`] besides. Vertices at one
    /// place in the mesh are taken to stay together.
    Moving(&'a Mesh, Bounds),
}

impl<'a> LentShape<'a> {
    /// The triangles, where they are known.
    pub(in crate::casters) fn mesh(&self) -> Option<&'a Mesh> {
        match self {
            Self::Unknown(_) => None,
            Self::Rigid(mesh) | Self::Moving(mesh, _) => Some(mesh),
        }
    }

    /// A box around all vertices.
    pub(in crate::casters) fn bounds(&self) -> Bounds {
        match self {
            Self::Unknown(bounds) | Self::Moving(_, bounds) => *bounds,
            Self::Rigid(mesh) => mesh.bounds(),
        }
    }
}

/// What the library keeps of a mesh that is lent.
pub(crate) struct Lent {
    pub positions: LentVertices,
    pub uvs: Option<LentVertices>,
    pub indices: LentIndices,
    /// The GPU alone knows where vertices are.
    pub is_moving: bool,
    /// Nobody knows the triangles.
    pub is_unknown: bool,
}

impl Lent {
    pub(in crate::casters) fn of(mesh: &LentMesh<'_>) -> Self {
        Self {
            positions: mesh.positions.clone(),
            uvs: mesh.uvs.clone(),
            indices: mesh.indices.clone(),
            is_moving: matches!(mesh.shape, LentShape::Moving(..)),
            is_unknown: matches!(mesh.shape, LentShape::Unknown(_)),
        }
    }
}

//! The vertices and triangles of all meshes in shared buffers, and how passes read them.

use std::{ops::Range, sync::Arc};
use umbrage_core::Mesh;

/// A mesh and where it lies in the shared buffers.
pub(crate) struct MeshPart {
    /// Without normals and texture coordinates; of a posed instance as it was bound.
    pub mesh: Arc<Mesh>,
    pub first_index: u32,
    pub base_vertex: u32,
}

impl MeshPart {
    pub(super) fn indices(&self) -> Range<u32> {
        self.first_index..self.first_index + self.mesh.indices.len() as u32
    }
}

/// The contents of the vertex and index buffers.
#[derive(Default)]
pub(super) struct Vertices {
    pub positions: Vec<[f32; 3]>,
    /// Normal, texture coordinate, opacity.
    pub attributes: Vec<[f32; 6]>,
    pub indices: Vec<u32>,
    pub welded: Vec<u32>,
}

impl Vertices {
    /// Adds a mesh.
    pub fn add(&mut self, mesh: &Mesh) -> MeshPart {
        let first_index = self.indices.len() as u32;
        self.indices.extend(&mesh.indices);
        self.welded.extend(mesh.welded_indices());
        let base_vertex = self.pose(mesh);
        let (positions, indices, weights) = (mesh.positions.clone(), mesh.indices.clone(), mesh.weights.clone());
        let mesh = Arc::new(Mesh { positions, indices, weights, ..Mesh::default() });
        MeshPart { mesh, first_index, base_vertex }
    }

    /// Adds vertices alone.
    pub fn pose(&mut self, mesh: &Mesh) -> u32 {
        let base_vertex = self.positions.len() as u32;
        self.positions.extend(mesh.positions.iter().map(|p| p.to_array()));
        self.attributes.extend((0..mesh.positions.len()).map(|i| {
            let n = mesh.normals.get(i).copied().unwrap_or_default();
            let uv = mesh.uvs.get(i).copied().unwrap_or_default();
            let opacity = mesh.opacities.get(i).copied().unwrap_or(1.0);
            [n.x, n.y, n.z, uv.x, uv.y, opacity]
        }));
        base_vertex
    }
}

/// The vertex buffers of a pass that draws casters: positions and instance numbers, and attributes
/// where `textured`.
pub(crate) fn vertex_layouts(textured: bool) -> Vec<Option<wgpu::VertexBufferLayout<'static>>> {
    const POSITION: &[wgpu::VertexAttribute] = &wgpu::vertex_attr_array![0 => Float32x3];
    const NUMBER: &[wgpu::VertexAttribute] = &wgpu::vertex_attr_array![1 => Uint32];
    const ATTRIBUTES: &[wgpu::VertexAttribute] = &wgpu::vertex_attr_array![2 => Float32x3, 3 => Float32x3];
    let layout =
        |array_stride, step_mode, attributes| Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes });
    let mut layouts =
        vec![layout(12, wgpu::VertexStepMode::Vertex, POSITION), layout(4, wgpu::VertexStepMode::Instance, NUMBER)];
    if textured {
        layouts.push(layout(24, wgpu::VertexStepMode::Vertex, ATTRIBUTES));
    }
    layouts
}

//! What vertices are on the GPU, and how passes read them.

use umbrage_core::Mesh;

/// Normal, texture coordinate and opacity of each vertex of a mesh.
pub(super) fn attributes(mesh: &Mesh) -> Vec<[f32; 6]> {
    let of = |i: usize| {
        let n = mesh.normals.get(i).copied().unwrap_or_default();
        let uv = mesh.uvs.get(i).copied().unwrap_or_default();
        let opacity = mesh.opacities.get(i).copied().unwrap_or(1.0);
        [n.x, n.y, n.z, uv.x, uv.y, opacity]
    };
    (0..mesh.positions.len()).map(of).collect()
}

/// Who holds the vertices of a mesh with joints, as `pose_vertices.wgsl` has it: where in the list
/// of all meshes the joints of each vertex start, then pairs of a joint and its weight. `first` is
/// where the list of this mesh starts in that of all.
pub(super) fn weights(mesh: &Mesh, first: u32) -> Vec<u32> {
    let vertices = mesh.positions.len() as u32;
    let pairs = first + vertices + 1;
    let ends = (0..mesh.positions.len()).scan(0, |end, vertex| {
        *end = mesh.weights.ends().get(vertex).copied().unwrap_or(*end);
        Some(*end)
    });
    let starts = std::iter::once(0).chain(ends).map(|end| pairs + 2 * end);
    let influences = mesh.weights.influences().iter().flat_map(|i| [i.joint, i.weight.to_bits()]);
    starts.chain(influences).collect()
}

/// The vertex buffers of a pass that draws the library's own casters: positions, instance numbers
/// and attributes.
pub(crate) fn vertex_layouts() -> Vec<Option<wgpu::VertexBufferLayout<'static>>> {
    const POSITION: &[wgpu::VertexAttribute] = &wgpu::vertex_attr_array![0 => Float32x3];
    const NUMBER: &[wgpu::VertexAttribute] = &wgpu::vertex_attr_array![1 => Uint32];
    const ATTRIBUTES: &[wgpu::VertexAttribute] = &wgpu::vertex_attr_array![2 => Float32x3, 3 => Float32x3];
    let layout =
        |array_stride, step_mode, attributes| Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes });
    vec![
        layout(12, wgpu::VertexStepMode::Vertex, POSITION),
        layout(4, wgpu::VertexStepMode::Instance, NUMBER),
        layout(24, wgpu::VertexStepMode::Vertex, ATTRIBUTES),
    ]
}

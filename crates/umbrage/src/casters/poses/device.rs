//! Pipelines and buffers that bend meshes.

use crate::compute::compute_pipeline;
use crate::fullscreen::{STORAGE, bind, layout};
use crate::{gpu::Gpu, shader::Shader, shader::shader_struct};

/// Bends vertices; then makes planes of the triangles between them.
pub(crate) const SHADERS: &[Shader] = &[
    Shader::new("poses", include_str!("../pose_vertices.wgsl")).with_layouts(&[JointRows::LAYOUT]),
    Shader::new("planes of poses", include_str!("../pose_planes.wgsl")),
];

shader_struct! {
    /// A mesh to bend, see `poses.wgsl`.
    pub(crate) struct PosedMesh {
        bound_vertex: u32,
        vertex: u32,
        vertex_count: u32,
        first_start: u32,
        first_joint: u32,
        first_index: u32,
        first_triangle: u32,
        triangle_count: u32,
        center: [f32; 3],
        pad: u32,
    }
}

shader_struct! {
    /// What a joint does to the mesh as it was bound.
    pub(crate) struct JointRows {
        row0: [f32; 4],
        row1: [f32; 4],
        row2: [f32; 4],
    }
}

/// Threads of a workgroup.
pub const GROUP: u32 = 64;

/// What is on the GPU.
pub(super) struct Device {
    pub vertices: wgpu::ComputePipeline,
    pub normals: wgpu::ComputePipeline,
    pub planes: wgpu::ComputePipeline,
    pub work: wgpu::Buffer,
    pub joints: wgpu::Buffer,
    /// The meshes, and the positions of all.
    pub of_positions: wgpu::BindGroup,
    /// The meshes, and the attributes of all.
    pub of_normals: wgpu::BindGroup,
    /// Joints and weights.
    pub of_joints: wgpu::BindGroup,
    pub bytes: u64,
}

/// A storage buffer that is written.
const WRITTEN: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Storage { read_only: false },
    has_dynamic_offset: false,
    min_binding_size: None,
};

/// The bind group that planes are remade through: indices and planes.
pub(crate) fn planes_group(gpu: &Gpu, indices: &wgpu::Buffer, planes: &wgpu::Buffer) -> wgpu::BindGroup {
    bind(gpu, "planes of poses", &planes_layout(gpu), &[indices.as_entire_binding(), planes.as_entire_binding()])
}

fn planes_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    layout(gpu, "planes of poses", wgpu::ShaderStages::COMPUTE, &[STORAGE, WRITTEN])
}

/// The layout of a group with the meshes, and vertices that are written at `binding`.
fn written_layout(gpu: &Gpu, binding: u32) -> wgpu::BindGroupLayout {
    let entry = |(binding, ty)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    };
    let entries = [(0, STORAGE), (binding, WRITTEN)].map(entry);
    gpu.bind_group_layout("poses", &entries)
}

fn written_group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    meshes: &wgpu::Buffer,
    (binding, vertices): (u32, &wgpu::Buffer),
) -> wgpu::BindGroup {
    let entries = [(0, meshes), (binding, vertices)]
        .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() });
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("poses"), layout, entries: &entries })
}

impl Device {
    pub fn new(gpu: &Gpu, posed: usize, joints: usize, weights: &[u32], vertices: [&wgpu::Buffer; 2]) -> Self {
        let (positions, normals) = (written_layout(gpu, 1), written_layout(gpu, 2));
        let joint_layout = layout(gpu, "joints", wgpu::ShaderStages::COMPUTE, &[STORAGE; 2]);
        let planes = planes_layout(gpu);
        let pipeline = |shader: &Shader, entry, groups: &[Option<&wgpu::BindGroupLayout>]| {
            compute_pipeline(gpu, &shader.module(gpu), entry, groups, &[])
        };
        use wgpu::BufferUsages as Usage;
        let work = gpu.buffer("poses", &vec![PosedMesh::default(); posed], Usage::STORAGE | Usage::COPY_DST);
        let rows = gpu.buffer("joints", &vec![JointRows::default(); joints], Usage::STORAGE | Usage::COPY_DST);
        let weights = gpu.buffer("weights", weights, Usage::STORAGE);
        Self {
            vertices: pipeline(&SHADERS[0], "pose_vertices", &[Some(&positions), Some(&joint_layout)]),
            normals: pipeline(&SHADERS[0], "pose_normals", &[Some(&normals), Some(&joint_layout)]),
            planes: pipeline(&SHADERS[1], "pose_planes", &[Some(&positions), Some(&planes)]),
            of_positions: written_group(gpu, &positions, &work, (1, vertices[0])),
            of_normals: written_group(gpu, &normals, &work, (2, vertices[1])),
            of_joints: bind(gpu, "joints", &joint_layout, &[&rows, &weights].map(|b| b.as_entire_binding())),
            bytes: [&work, &rows, &weights].iter().map(|b| b.size()).sum(),
            work,
            joints: rows,
        }
    }
}

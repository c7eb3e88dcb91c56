//! Pipelines and buffers that bend meshes.

use crate::casters::geometry::Geometry;
use crate::compute::compute_pipeline;
use crate::fullscreen::{STORAGE, bind, layout};
use crate::{error::Error, gpu::Gpu, shader::Shader, shader::shader_struct};
use std::sync::OnceLock;

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
    /// Needs more storage buffers than the smallest devices allow, where nothing asks for planes.
    planes: OnceLock<wgpu::ComputePipeline>,
    layouts: [wgpu::BindGroupLayout; 3],
    bound: Option<Bound>,
}

/// Buffers, and what binds them.
pub(super) struct Bound {
    pub work: wgpu::Buffer,
    pub joints: wgpu::Buffer,
    /// The meshes, and the positions of all.
    pub of_positions: wgpu::BindGroup,
    /// The meshes, and the attributes of all.
    pub of_normals: wgpu::BindGroup,
    /// Joints and weights.
    pub of_joints: wgpu::BindGroup,
    /// Positions, attributes and weights of all meshes.
    of: [wgpu::Buffer; 3],
}

/// A storage buffer that is written.
const WRITTEN: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Storage { read_only: false },
    has_dynamic_offset: false,
    min_binding_size: None,
};

/// The bind group that planes are remade through: indices, then normals and offsets of planes.
pub(crate) fn planes_group(gpu: &Gpu, of: [&wgpu::Buffer; 3]) -> wgpu::BindGroup {
    bind(gpu, "planes of poses", &planes_layout(gpu), &of.map(wgpu::Buffer::as_entire_binding))
}

fn planes_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    layout(gpu, "planes of poses", wgpu::ShaderStages::COMPUTE, &[STORAGE, WRITTEN, WRITTEN])
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

fn pipeline(gpu: &Gpu, shader: &Shader, entry: &str, groups: [&wgpu::BindGroupLayout; 2]) -> wgpu::ComputePipeline {
    compute_pipeline(gpu, &shader.module(gpu), entry, &groups.map(Some), &[])
}

impl Device {
    pub fn new(gpu: &Gpu) -> Self {
        let (positions, normals) = (written_layout(gpu, 1), written_layout(gpu, 2));
        let joints = layout(gpu, "joints", wgpu::ShaderStages::COMPUTE, &[STORAGE; 2]);
        Self {
            vertices: pipeline(gpu, &SHADERS[0], "pose_vertices", [&positions, &joints]),
            normals: pipeline(gpu, &SHADERS[0], "pose_normals", [&normals, &joints]),
            planes: OnceLock::new(),
            layouts: [positions, normals, joints],
            bound: None,
        }
    }

    /// Makes planes.
    pub fn planes(&self, gpu: &Gpu) -> &wgpu::ComputePipeline {
        let groups = [&self.layouts[0], &planes_layout(gpu)];
        self.planes.get_or_init(|| pipeline(gpu, &SHADERS[1], "pose_planes", groups))
    }

    pub fn bound(&self) -> Option<&Bound> {
        self.bound.as_ref()
    }

    /// Has room for so many meshes and joints, and binds the buffers that there are now.
    ///
    /// # Errors
    /// [`Error::Size`] where a shader can't have all vertices.
    pub fn fit(&mut self, gpu: &Gpu, geometry: &Geometry, counts: [usize; 2]) -> Result<(), Error> {
        let needed = [size_of::<PosedMesh>(), size_of::<JointRows>()].iter().zip(counts).map(|(a, b)| (a * b) as u64);
        let needed: Vec<u64> = needed.collect();
        let of = [&geometry.positions, &geometry.attributes, &geometry.weights].map(|s| s.buffer().clone());
        let holds = |b: &Bound| b.of == of && b.work.size() >= needed[0] && b.joints.size() >= needed[1];
        if self.bound.as_ref().is_some_and(holds) {
            return Ok(());
        }
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        if let Some(size) = of.iter().map(wgpu::Buffer::size).find(|size| *size > limit) {
            return Err(Error::Size { what: "the vertices of a scene with poses".into(), size, limit });
        }
        let buffer = |label, before: Option<&wgpu::Buffer>, needed: u64| {
            let size = before.map_or(0, wgpu::Buffer::size);
            let size = if size < needed { (needed + needed / 2).min(limit.max(needed)) } else { size };
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: size.next_multiple_of(16).max(16),
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let before = self.bound.take();
        let work = buffer("poses", before.as_ref().map(|b| &b.work), needed[0]);
        let joints = buffer("joints", before.as_ref().map(|b| &b.joints), needed[1]);
        let [positions, normals, of_joints] = &self.layouts;
        self.bound = Some(Bound {
            of_positions: written_group(gpu, positions, &work, (1, &of[0])),
            of_normals: written_group(gpu, normals, &work, (2, &of[1])),
            of_joints: bind(gpu, "joints", of_joints, &[&joints, &of[2]].map(|b| b.as_entire_binding())),
            work,
            joints,
            of,
        });
        Ok(())
    }

    /// Its own, without vertices and weights.
    pub fn bytes(&self) -> u64 {
        self.bound.as_ref().map_or(0, |b| b.work.size() + b.joints.size())
    }
}

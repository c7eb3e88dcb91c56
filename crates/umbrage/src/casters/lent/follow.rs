//! Positions of lent meshes whose vertices the host moves, copied on the GPU to where edges are
//! drawn from: silhouettes of all casters are one draw, and shaders bind one buffer of positions.

use super::mesh::{Lent, LentMesh};
use crate::compute::compute_pipeline;
use crate::fullscreen::{STORAGE, STORAGE_WRITE, UNIFORM, bind, layout};
use crate::{error::Error, gpu::Gpu, passes::Passes, shader::Shader, shader::shader_struct};
use std::collections::BTreeMap;

/// Copies positions.
pub(crate) const SHADERS: &[Shader] = &[SHADER];

const SHADER: Shader = Shader::new("lent positions", include_str!("lent_positions.wgsl"))
    .with_layouts(&[LentPositions::LAYOUT])
    .with_constants(&[("UNORM_16", UNORM_16 as f64), ("SNORM_16", SNORM_16 as f64), ("FLOAT_16", FLOAT_16 as f64)]);

shader_struct! {
    /// What is copied, see `lent_positions.wgsl`.
    pub(crate) struct LentPositions {
        first_word: u32,
        words: u32,
        format: u32,
        vertex: u32,
        vertex_count: u32,
        pad_a: u32,
        pad_b: u32,
        pad_c: u32,
    }
}

const UNORM_16: u32 = 1;
const SNORM_16: u32 = 2;
const FLOAT_16: u32 = 3;

/// Threads of a workgroup.
const GROUP: u32 = 64;

/// The meshes whose vertices a host moves.
#[derive(Default)]
pub(in crate::casters) struct Following {
    /// By number of the mesh.
    meshes: BTreeMap<u32, Followed>,
    device: Option<Device>,
}

/// One of them.
struct Followed {
    uniform: wgpu::Buffer,
    lent: wgpu::Buffer,
    /// What is bound of the host's buffer, bytes.
    part: [u64; 2],
    count: u32,
    has_changed: bool,
    /// With the buffer of positions that it copies to.
    bound: Option<(wgpu::Buffer, wgpu::BindGroup)>,
}

struct Device {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

/// # Errors
/// [`Error::Size`] for more than one pass copies.
pub(super) fn check(gpu: &Gpu, mesh: &LentMesh<'_>) -> Result<(), Error> {
    let Some(known) = mesh.shape.mesh() else { return Ok(()) };
    let limits = gpu.device.limits();
    let most = u64::from(limits.max_compute_workgroups_per_dimension) * u64::from(GROUP);
    let part = part(gpu, &Lent::of(mesh), known.positions.len() as u64);
    for (what, size, limit) in [
        ("the vertices of a lent mesh that moves", known.positions.len() as u64, most),
        ("the triangles of a lent mesh that moves", known.triangle_count() as u64, most),
        ("the positions of a lent mesh that moves", part[1], limits.max_storage_buffer_binding_size),
    ] {
        if size > limit {
            return Err(Error::Size { what: what.into(), size, limit });
        }
    }
    Ok(())
}

/// Bytes before the first vertex of the shape.
fn start(lent: &Lent) -> u64 {
    lent.positions.offset + u64::from(lent.indices.base_vertex) * lent.positions.stride
}

/// What of the host's buffer is bound: from where that may start, and how many bytes.
fn part(gpu: &Gpu, lent: &Lent, count: u64) -> [u64; 2] {
    let alignment = u64::from(gpu.device.limits().min_storage_buffer_offset_alignment);
    let start = start(lent);
    let from = start / alignment * alignment;
    let end = start + count.saturating_sub(1) * lent.positions.stride + lent.positions.format.size();
    [from, end.next_multiple_of(4) - from]
}

fn format(format: wgpu::VertexFormat) -> u32 {
    match format {
        wgpu::VertexFormat::Unorm16x4 => UNORM_16,
        wgpu::VertexFormat::Snorm16x4 => SNORM_16,
        wgpu::VertexFormat::Float16x4 => FLOAT_16,
        _ => 0,
    }
}

impl Following {
    /// Has `count` vertices from number `vertex` on follow a lent mesh.
    pub fn set(&mut self, gpu: &Gpu, number: u32, lent: &Lent, (vertex, count): (u32, u32)) {
        let part = part(gpu, lent, u64::from(count));
        let from = LentPositions {
            first_word: ((start(lent) - part[0]) / 4) as u32,
            words: (lent.positions.stride / 4) as u32,
            format: format(lent.positions.format),
            vertex,
            vertex_count: count,
            ..LentPositions::default()
        };
        let uniform = gpu.buffer("lent positions", &[from], wgpu::BufferUsages::UNIFORM);
        let buffer = lent.positions.buffer.clone();
        self.meshes.insert(number, Followed { uniform, lent: buffer, part, count, has_changed: true, bound: None });
    }

    pub fn remove(&mut self, number: u32) {
        self.meshes.remove(&number);
    }

    pub fn is_empty(&self) -> bool {
        self.meshes.is_empty()
    }

    /// The host has moved its vertices.
    pub fn mark(&mut self, number: u32) {
        if let Some(mesh) = self.meshes.get_mut(&number) {
            mesh.has_changed = true;
        }
    }

    pub fn mark_all(&mut self) {
        self.meshes.values_mut().for_each(|mesh| mesh.has_changed = true);
    }

    /// Numbers of those that have changed since they were recorded.
    pub fn changed(&self) -> impl Iterator<Item = u32> + '_ {
        self.meshes.iter().filter(|(_, mesh)| mesh.has_changed).map(|(number, _)| *number)
    }

    pub fn have_changed(&self) -> bool {
        self.changed().next().is_some()
    }

    /// Copies what has changed.
    ///
    /// # Errors
    /// [`Error::Size`] where the positions of all meshes are more than a shader may write.
    pub fn record(&mut self, gpu: &Gpu, passes: &mut Passes<'_>, positions: &wgpu::Buffer) -> Result<(), Error> {
        if !self.have_changed() {
            return Ok(());
        }
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        if positions.size() > limit {
            let what = "the vertices of a scene with lent meshes that move".into();
            return Err(Error::Size { what, size: positions.size(), limit });
        }
        let device = self.device.get_or_insert_with(|| Device::new(gpu));
        let mut pass = passes.compute("lent positions");
        pass.set_pipeline(&device.pipeline);
        for mesh in self.meshes.values_mut().filter(|mesh| mesh.has_changed && mesh.count > 0) {
            let (_, group) = match mesh.bound.take().filter(|(to, _)| to == positions) {
                Some(bound) => mesh.bound.insert(bound),
                None => mesh.bound.insert((positions.clone(), device.bind(gpu, mesh, positions))),
            };
            pass.set_bind_group(0, &*group, &[]);
            pass.dispatch_workgroups(mesh.count.div_ceil(GROUP), 1, 1);
        }
        Ok(())
    }

    /// All that has changed is recorded.
    pub fn settle(&mut self) {
        self.meshes.values_mut().for_each(|mesh| mesh.has_changed = false);
    }

    /// GPU memory.
    pub fn bytes(&self) -> u64 {
        self.meshes.values().map(|mesh| mesh.uniform.size()).sum()
    }
}

impl Device {
    fn new(gpu: &Gpu) -> Self {
        let layout = layout(gpu, "lent positions", wgpu::ShaderStages::COMPUTE, &[UNIFORM, STORAGE, STORAGE_WRITE]);
        let pipeline = compute_pipeline(gpu, &SHADER.module(gpu), "copy_positions", &[Some(&layout)], &[]);
        Self { layout, pipeline }
    }

    fn bind(&self, gpu: &Gpu, mesh: &Followed, positions: &wgpu::Buffer) -> wgpu::BindGroup {
        let [offset, size] = mesh.part;
        let lent = wgpu::BufferBinding { buffer: &mesh.lent, offset, size: std::num::NonZeroU64::new(size) };
        let resources =
            [mesh.uniform.as_entire_binding(), wgpu::BindingResource::Buffer(lent), positions.as_entire_binding()];
        bind(gpu, "lent positions", &self.layout, &resources)
    }
}

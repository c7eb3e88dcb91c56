//! Finds steps of depth in maps: the borders between blockers and what is behind them.

use super::uniform::{FindSteps, VIEWS};
use crate::compute::compute_pipeline;
use crate::fullscreen::{STORAGE_WRITE, UNIFORM, bind, layout};
use crate::shader::HostConstant;
use crate::{gpu::Gpu, passes::Passes};

/// Threads across and down, and cells across and down for each of them.
const WORKGROUP: u32 = 8;
const BLOCK: u32 = 4;

/// Skins of an instance, and indices of each.
pub(super) const GROUP: u32 = 64;
pub(super) const INDICES: u32 = 6;

/// Bytes before the entries of a list: the arguments of a draw, how many were found, and two unused
/// words.
pub(super) const HEAD: u64 = 32;

/// Bytes of an entry.
const ENTRY: u64 = 8;

/// What `find_steps.wgsl` calls them.
pub(super) const CONSTANTS: &[HostConstant] =
    &[("WORKGROUP", WORKGROUP as f64), ("BLOCK", BLOCK as f64), ("GROUP", GROUP as f64), ("INDICES", INDICES as f64)];

/// The pipelines.
pub(super) struct Steps {
    layout: wgpu::BindGroupLayout,
    find: wgpu::ComputePipeline,
    group: wgpu::ComputePipeline,
}

/// A list of steps in the maps of a point.
pub(super) struct StepList {
    pub buffer: wgpu::Buffer,
    uniform: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
    size: u32,
}

/// An array of depth maps.
pub(super) const MAPS: wgpu::BindingType = wgpu::BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Depth,
    view_dimension: wgpu::TextureViewDimension::D2Array,
    multisampled: false,
};

impl Steps {
    pub fn new(gpu: &Gpu) -> Self {
        let layout = layout(gpu, "find steps", wgpu::ShaderStages::COMPUTE, &[MAPS, STORAGE_WRITE, UNIFORM]);
        let module = super::FIND.module(gpu);
        let pipeline = |entry| compute_pipeline(gpu, &module, entry, &[Some(&layout)], &[]);
        Self { find: pipeline("find_steps"), group: pipeline("group_steps"), layout }
    }

    /// A list for maps of `size` texels a side: as many entries as one of them has texels, which
    /// all layers share.
    pub fn list(&self, gpu: &Gpu, maps: &wgpu::TextureView, size: u32) -> StepList {
        use wgpu::BufferUsages as Usage;
        let entries = u64::from(size) * u64::from(size) * ENTRY;
        let limits = gpu.device.limits();
        let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("steps"),
            size: (HEAD + entries.max(ENTRY)).min(most / 16 * 16),
            usage: Usage::STORAGE | Usage::INDIRECT | Usage::COPY_DST,
            mapped_at_creation: false,
        });
        let uniform = gpu.buffer("find steps", &[FindSteps::default()], Usage::UNIFORM | Usage::COPY_DST);
        let resources =
            [wgpu::BindingResource::TextureView(maps), buffer.as_entire_binding(), uniform.as_entire_binding()];
        StepList { bind_group: bind(gpu, "find steps", &self.layout, &resources), buffer, uniform, size }
    }

    /// Empties the list, before [`Steps::find`].
    pub fn clear(passes: &mut Passes<'_>, list: &StepList, layers: impl Iterator<Item = u32>, threshold: f64) {
        let room = (list.buffer.size() - HEAD) / ENTRY;
        let mut uniform = FindSteps { threshold: threshold as f32, room: room as u32, ..FindSteps::default() };
        for (i, layer) in layers.enumerate().take(VIEWS) {
            uniform.layers[i / 4][i % 4] = layer;
        }
        passes.upload(&list.uniform, bytemuck::bytes_of(&uniform));
        passes.upload(&list.buffer, &[0; HEAD as usize]);
    }

    /// Fills a list from so many layers.
    pub fn find(&self, pass: &mut wgpu::ComputePass<'_>, list: &StepList, layers: u32) {
        let across = list.size.div_ceil(WORKGROUP * BLOCK);
        pass.set_bind_group(0, &list.bind_group, &[]);
        pass.set_pipeline(&self.find);
        pass.dispatch_workgroups(across, across, layers);
        pass.set_pipeline(&self.group);
        pass.dispatch_workgroups(1, 1, 1);
    }
}

impl StepList {
    pub fn bytes(&self) -> u64 {
        self.buffer.size() + self.uniform.size()
    }
}

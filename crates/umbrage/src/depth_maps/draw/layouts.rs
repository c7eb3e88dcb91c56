//! What the passes that render maps bind.

use super::view::MapView;
use crate::fullscreen::{self, UNIFORM, bind, layout};
use crate::gpu::Gpu;

/// Layouts of the view, and of one and two maps that are read.
pub(super) struct Layouts {
    pub view: wgpu::BindGroupLayout,
    pub one_map: wgpu::BindGroupLayout,
    pub two_maps: wgpu::BindGroupLayout,
}

impl Layouts {
    pub fn new(gpu: &Gpu) -> Self {
        Self { view: view_layout(gpu), one_map: depth_layout(gpu, 1), two_maps: depth_layout(gpu, 2) }
    }

    pub fn read_first(&self, gpu: &Gpu, first: &wgpu::TextureView) -> wgpu::BindGroup {
        read(gpu, &self.one_map, &[first])
    }

    pub fn read_both(&self, gpu: &Gpu, first: &wgpu::TextureView, second: &wgpu::TextureView) -> wgpu::BindGroup {
        read(gpu, &self.two_maps, &[first, second])
    }
}

/// Of a view, group 0 of `map_depth.wgsl`.
pub(super) fn view_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    layout(gpu, "map view", wgpu::ShaderStages::VERTEX_FRAGMENT, &[UNIFORM])
}

/// A view's uniform and its bind group.
pub(super) fn view_uniform(gpu: &Gpu, layout: &wgpu::BindGroupLayout) -> (wgpu::Buffer, wgpu::BindGroup) {
    let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
    let buffer = gpu.buffer("map view", &[MapView::default()], usage);
    let bind_group = bind(gpu, "map view", layout, &[buffer.as_entire_binding()]);
    (buffer, bind_group)
}

/// A layout of so many depth textures.
fn depth_layout(gpu: &Gpu, count: usize) -> wgpu::BindGroupLayout {
    let depth = fullscreen::texture(wgpu::TextureSampleType::Depth);
    layout(gpu, "depth maps", wgpu::ShaderStages::FRAGMENT, &vec![depth; count])
}

fn read(gpu: &Gpu, layout: &wgpu::BindGroupLayout, views: &[&wgpu::TextureView]) -> wgpu::BindGroup {
    let resources: Vec<_> = views.iter().map(|view| wgpu::BindingResource::TextureView(view)).collect();
    bind(gpu, "depth maps", layout, &resources)
}

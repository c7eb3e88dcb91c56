//! What shadows fall on: the depth buffer of the view, and normals where the host has them.

use crate::gpu::Gpu;

/// Depth (and normals) of the visible surfaces, made once per size.
///
/// Depth is any sampled depth format with one sample a pixel. Normals are `R32Uint`: the geometric normal in world space,
/// turned to the eye, packed by the function in [`crate::PACK_NORMAL`]. Without them normals come from the depth itself, which
/// costs a little and is less exact at the edges of surfaces.
#[derive(Clone, Debug)]
pub struct Receivers {
    /// Pixels across and down.
    pub size: (u32, u32),
    pub(crate) has_normals: bool,
    pub(crate) bind_group: wgpu::BindGroup,
}

impl Receivers {
    /// Wraps a host's views. `normal` may be `None`.
    pub fn new(gpu: &Gpu, depth: &wgpu::TextureView, normal: Option<&wgpu::TextureView>, size: (u32, u32)) -> Self {
        let none;
        let normal_view = match normal {
            Some(view) => view,
            None => {
                none = placeholder(gpu);
                &none
            }
        };
        let bind_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("receivers"),
            layout: &Self::layout(gpu),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(depth) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(normal_view) },
            ],
        });
        Self { size, has_normals: normal.is_some(), bind_group }
    }

    /// Layout of the bind group that `wgsl/receivers.wgsl` declares as group 0.
    pub(crate) fn layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        let texture = |binding, sample_type| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Texture {
                sample_type,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("receivers"),
            entries: &[texture(0, wgpu::TextureSampleType::Depth), texture(1, wgpu::TextureSampleType::Uint)],
        })
    }
}

fn placeholder(gpu: &Gpu) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("no normals"),
        size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Uint,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

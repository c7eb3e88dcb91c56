//! The textures that smoothies are drawn into: a layer for each of the maps.

use crate::fullscreen::{attachment, layer_view, target_texture};
use crate::gpu::Gpu;

/// Of which the least is kept: this can be blended without optional features.
pub(super) const LEAST: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;
/// Depth, to be looked at.
pub(super) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A texture with a layer for each map, and its layers.
pub(super) struct Layered {
    pub texture: wgpu::Texture,
    pub layers: Vec<wgpu::TextureView>,
}

impl Layered {
    pub fn new(gpu: &Gpu, label: &str, maps: &wgpu::Texture, format: wgpu::TextureFormat) -> Self {
        let count = maps.depth_or_array_layers();
        let texture = target_texture(gpu, label, (maps.width(), maps.height()), count, format);
        let layers = (0..count).map(|layer| layer_view(&texture, layer)).collect();
        Self { texture, layers }
    }

    /// All layers, as the look-up reads them.
    pub fn whole(&self) -> wgpu::TextureView {
        let dimension = Some(wgpu::TextureViewDimension::D2Array);
        self.texture.create_view(&wgpu::TextureViewDescriptor { dimension, ..Default::default() })
    }

    /// A layer, to be drawn into from scratch.
    pub fn cleared(&self, layer: usize, color: wgpu::Color) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        attachment(&self.layers[layer], wgpu::LoadOp::Clear(color))
    }

    pub fn bytes(&self) -> u64 {
        let (size, format) = (self.texture.size(), self.texture.format());
        let texels = u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers);
        texels * u64::from(format.block_copy_size(None).unwrap_or(4))
    }
}

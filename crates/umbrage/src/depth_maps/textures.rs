//! The textures of a light's maps.

use super::pipelines::Pipelines;
use crate::{fullscreen::target_texture, gpu::Gpu};

/// The format of maps: floats, since reversed depth needs their precision far away.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The textures of a light's maps and the buffers that go with each layer.
pub(crate) struct Textures {
    first: wgpu::Texture,
    /// Second surface and midpoint, for `faces = midpoint`.
    midpoint: Option<(wgpu::Texture, wgpu::Texture)>,
    /// For each layer the view uniform and its bind group.
    pub(super) uniforms: Vec<(wgpu::Buffer, wgpu::BindGroup)>,
    pub(super) layers: Vec<LayerViews>,
}

/// Views and bind groups of one layer.
pub(super) struct LayerViews {
    pub first: wgpu::TextureView,
    pub second: Option<SecondViews>,
}

pub(super) struct SecondViews {
    pub second: wgpu::TextureView,
    pub midpoint: wgpu::TextureView,
    /// The first map, for the pass that renders the second surface.
    pub read_first: wgpu::BindGroup,
    /// Both maps, for the pass that takes their mean.
    pub read_both: wgpu::BindGroup,
}

impl Textures {
    pub(super) fn new(gpu: &Gpu, pipelines: &Pipelines, size: u32, layers: u32, midpoint: bool) -> Self {
        let texture = |label| target_texture(gpu, label, (size, size), layers, FORMAT);
        let layer_view = |texture: &wgpu::Texture, layer| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let first = texture("shadow map");
        let midpoint = midpoint.then(|| (texture("second surface"), texture("midpoint")));
        let views = (0..layers).map(|i| {
            let first = layer_view(&first, i);
            let second = midpoint.as_ref().map(|(second, mid)| {
                let (second, midpoint) = (layer_view(second, i), layer_view(mid, i));
                let read_first = pipelines.read_first(gpu, &first);
                let read_both = pipelines.read_both(gpu, &first, &second);
                SecondViews { second, midpoint, read_first, read_both }
            });
            LayerViews { first, second }
        });
        let layers = views.collect();
        let uniforms = (0..first.depth_or_array_layers()).map(|_| pipelines.view_uniform(gpu)).collect();
        Self { first, midpoint, uniforms, layers }
    }

    pub(super) fn layers(&self) -> u32 {
        self.first.depth_or_array_layers()
    }

    /// The texture that is looked up.
    pub(crate) fn result(&self) -> &wgpu::Texture {
        self.midpoint.as_ref().map_or(&self.first, |(_, midpoint)| midpoint)
    }

    pub(super) fn bytes(&self) -> u64 {
        let count = if self.midpoint.is_some() { 3 } else { 1 };
        let texels = u64::from(self.first.width()) * u64::from(self.first.height()) * u64::from(self.layers());
        texels * 4 * count + self.uniforms.iter().map(|(b, _)| b.size()).sum::<u64>()
    }
}

//! The textures of a light's maps.

use super::layouts::{Layouts, view_uniform};
use crate::fullscreen::layer_view;
use crate::gpu::Gpu;

/// The format of maps: floats, since reversed depth needs their precision far away.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The textures of a light's maps and the buffers that go with each layer.
pub(super) struct Textures {
    first: wgpu::Texture,
    /// Casters at rest, and its layers: made when first needed.
    store: Option<(wgpu::Texture, Vec<wgpu::TextureView>)>,
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
    pub(super) fn new(gpu: &Gpu, layouts: &Layouts, size: u32, count: u32, midpoint: bool) -> Self {
        let texture = |label| map_texture(gpu, label, size, count);
        let first = texture("shadow map");
        let midpoint = midpoint.then(|| (texture("second surface"), texture("midpoint")));
        let views = (0..count).map(|i| {
            let first = layer_view(&first, i);
            let second = midpoint.as_ref().map(|(second, mid)| {
                let (second, midpoint) = (layer_view(second, i), layer_view(mid, i));
                let read_first = layouts.read_first(gpu, &first);
                let read_both = layouts.read_both(gpu, &first, &second);
                SecondViews { second, midpoint, read_first, read_both }
            });
            LayerViews { first, second }
        });
        let layers = views.collect();
        let uniforms = (0..first.depth_or_array_layers()).map(|_| view_uniform(gpu, &layouts.view)).collect();
        Self { first, store: None, midpoint, uniforms, layers }
    }

    /// Makes the store where it is missing.
    pub(super) fn make_store(&mut self, gpu: &Gpu) {
        let first = &self.first;
        self.store.get_or_insert_with(|| {
            let texture = map_texture(gpu, "casters at rest", first.width(), first.depth_or_array_layers());
            let layers = (0..first.depth_or_array_layers()).map(|i| layer_view(&texture, i)).collect();
            (texture, layers)
        });
    }

    /// A layer of the store.
    pub(super) fn stored(&self, layer: usize) -> Option<&wgpu::TextureView> {
        self.store.as_ref().and_then(|(_, layers)| layers.get(layer))
    }

    /// Copies a layer of the store to the map.
    pub(super) fn take_stored(&self, encoder: &mut wgpu::CommandEncoder, layer: usize) {
        let Some((store, _)) = &self.store else { return };
        let of = |texture| wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: 0,
            origin: wgpu::Origin3d { z: layer as u32, ..wgpu::Origin3d::ZERO },
            aspect: wgpu::TextureAspect::All,
        };
        let extent = wgpu::Extent3d { depth_or_array_layers: 1, ..store.size() };
        encoder.copy_texture_to_texture(of(store), of(&self.first), extent);
    }

    /// Texels across and down.
    pub(super) fn size(&self) -> u32 {
        self.first.width()
    }

    pub(super) fn layers(&self) -> u32 {
        self.first.depth_or_array_layers()
    }

    /// The texture that is looked up.
    pub(super) fn result(&self) -> &wgpu::Texture {
        self.midpoint.as_ref().map_or(&self.first, |(_, midpoint)| midpoint)
    }

    pub(super) fn bytes(&self) -> u64 {
        let count = if self.midpoint.is_some() { 3 } else { 1 } + u64::from(self.store.is_some());
        let texels = u64::from(self.first.width()) * u64::from(self.first.height()) * u64::from(self.layers());
        texels * 4 * count + self.uniforms.iter().map(|(b, _)| b.size()).sum::<u64>()
    }
}

fn map_texture(gpu: &Gpu, label: &str, size: u32, layers: u32) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

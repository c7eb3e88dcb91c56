//! The textures of a light's moments, and the passes that fill each layer in order.

use super::blur::{AT_ONCE, Blur};
use super::pipelines::{Pipelines, Step};
use crate::fullscreen::target_texture;
use crate::gpu::Gpu;

/// What fills a layer of moments.
pub(super) struct Layer {
    pub(super) passes: Vec<Pass>,
    /// Then puts levels where they belong.
    pub(super) copies: Vec<Copy>,
}

/// A level that has been made, to its place among the others: see `moments_share.wgsl`.
pub(super) struct Copy {
    pub(super) from: wgpu::Texture,
    pub(super) level: u32,
    pub(super) to: wgpu::Texture,
    pub(super) origin: wgpu::Origin3d,
}

/// One full-screen pass.
pub(super) struct Pass {
    pub(super) step: Step,
    pub(super) reads: wgpu::BindGroup,
    pub(super) target: wgpu::TextureView,
}

/// What was made for one texture of maps.
pub(super) struct Made {
    /// The maps.
    pub(super) maps: wgpu::Texture,
    /// The moments, an array.
    pub(super) moments: wgpu::TextureView,
    /// Texels across the finest level.
    pub(super) side: u32,
    /// The finest included.
    pub(super) levels: u32,
    pub(super) layers: Vec<Layer>,
    pub(super) bytes: u64,
}

/// What some drivers give a texture at most; where coarser levels would not fit, there is the
/// finest alone.
const MOST_BYTES: u64 = 1 << 31;
/// Texels of the coarsest mip level at least.
const LEAST_SIZE: u32 = 4;

/// Textures on the way from maps to moments, of one layer each and used for all in turn.
struct Workshop<'a> {
    gpu: &'a Gpu,
    pipelines: &'a Pipelines,
    uniforms: &'a wgpu::Buffer,
    maps: &'a wgpu::Texture,
    /// Coarser and coarser, before the moments' own size.
    chain: Vec<wgpu::Texture>,
    /// For what is blurred across, of the moments' size.
    across: Option<wgpu::Texture>,
    /// Levels after the finest, on their way to their places.
    coarse: Option<wgpu::Texture>,
    moments: &'a wgpu::Texture,
}

impl Made {
    pub(super) fn new(
        gpu: &Gpu,
        pipelines: &Pipelines,
        uniforms: &wgpu::Buffer,
        maps: &wgpu::Texture,
        blur: &Blur,
        coarser: bool,
    ) -> Self {
        let format = pipelines.format;
        let views = maps.depth_or_array_layers();
        let side = |level: u32| maps.width().div_ceil(1 << level);
        let scratch = |level| target_texture(gpu, "reduced moments", (side(level), side(level)), 1, format);
        let size = side(blur.level);
        let layer_bytes = u64::from(size).pow(2) * u64::from(format.block_copy_size(None).unwrap_or(16));
        let has_room = u64::from(views + views.div_ceil(2)) * layer_bytes < MOST_BYTES;
        let levels = if coarser && has_room { (size / LEAST_SIZE).checked_ilog2().unwrap_or(0) + 1 } else { 1 };
        // Two views share a layer for their coarser levels.
        let layers = views + if levels > 1 { views.div_ceil(2) } else { 0 };
        let moments = levels_texture(gpu, format, size, layers, 1);
        let chain: Vec<_> = (AT_ONCE..blur.level).map(scratch).collect();
        let across = blur.has_passes().then(|| scratch(blur.level));
        let coarse = (levels > 1).then(|| levels_texture(gpu, format, size / 2, 1, levels - 1));
        let bytes = chain.iter().chain(&across).chain(&coarse).chain([&moments]).map(bytes_of).sum();
        let work = Workshop { gpu, pipelines, uniforms, maps, chain, across, coarse, moments: &moments };
        let layers = (0..views).map(|layer| work.layer(layer)).collect();
        let whole =
            wgpu::TextureViewDescriptor { dimension: Some(wgpu::TextureViewDimension::D2Array), ..Default::default() };
        Self { maps: maps.clone(), moments: moments.create_view(&whole), side: size, levels, layers, bytes }
    }
}

impl Workshop<'_> {
    fn layer(&self, layer: u32) -> Layer {
        let mut passes = Vec::new();
        let mut add = |step, from: &wgpu::TextureView, to: &wgpu::TextureView| {
            let reads = self.pipelines.bind(self.gpu, step, self.uniforms, from);
            passes.push(Pass { step, reads, target: to.clone() });
        };
        let base = view(self.moments, layer, 0);
        let mut from = view(self.maps, layer, 0);
        let mut step = Step::Take;
        for to in self.chain.iter().map(|t| view(t, 0, 0)).chain([base.clone()]) {
            add(step, &from, &to);
            (from, step) = (to, Step::Halve);
        }
        if let Some(across) = self.across.as_ref().map(|t| view(t, 0, 0)) {
            add(Step::BlurAcross, &base, &across);
            add(Step::BlurDown, &across, &base);
        }
        let coarse = self.coarse.iter().flat_map(|t| (0..t.mip_level_count()).map(|level| view(t, 0, level)));
        let mut from = base;
        for to in coarse {
            add(Step::Mip, &from, &to);
            from = to;
        }
        Layer { passes, copies: self.copies(layer) }
    }

    /// Where levels go: see `moments_share.wgsl`.
    fn copies(&self, layer: u32) -> Vec<Copy> {
        let (side, views) = (self.moments.width(), self.maps.depth_or_array_layers());
        let copy = |from: &wgpu::Texture, level: u32| Copy {
            from: from.clone(),
            level,
            to: self.moments.clone(),
            origin: wgpu::Origin3d { x: (layer % 2) * (side / 2), y: side - (side >> level), z: views + layer / 2 },
        };
        self.coarse.iter().flat_map(|t| (0..t.mip_level_count()).map(move |level| copy(t, level))).collect()
    }
}

impl Copy {
    pub(super) fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        let copied = |texture, mip_level, origin| wgpu::TexelCopyTextureInfo {
            texture,
            mip_level,
            origin,
            aspect: wgpu::TextureAspect::All,
        };
        let side = (self.from.width() >> self.level).max(1);
        encoder.copy_texture_to_texture(
            copied(&self.from, self.level, wgpu::Origin3d::ZERO),
            copied(&self.to, 0, self.origin),
            wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        );
    }
}

/// An array of moments with so many mip levels.
fn levels_texture(gpu: &Gpu, format: wgpu::TextureFormat, side: u32, layers: u32, levels: u32) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("moments"),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: layers },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

fn view(texture: &wgpu::Texture, layer: u32, level: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_mip_level: level,
        mip_level_count: Some(1),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

fn bytes_of(texture: &wgpu::Texture) -> u64 {
    let texel = u64::from(texture.format().block_copy_size(None).unwrap_or(16));
    let side = |level: u32| u64::from((texture.width() >> level).max(1));
    let texels: u64 = (0..texture.mip_level_count()).map(|level| side(level) * side(level)).sum();
    texels * texel * u64::from(texture.depth_or_array_layers())
}

//! The textures of a light's moments, and the passes that fill each layer in order.

use super::blur::Blur;
use super::pipelines::{Pipelines, Step};
use crate::fullscreen::target_texture;
use crate::gpu::Gpu;

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
    /// The moments, an array with mip levels.
    pub(super) moments: wgpu::TextureView,
    /// For each layer its passes.
    pub(super) layers: Vec<Vec<Pass>>,
    pub(super) bytes: u64,
}

/// The most often that moments are halved in the pass that takes them.
pub(super) const AT_ONCE: u32 = 2;
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
    moments: &'a wgpu::Texture,
}

impl Made {
    pub(super) fn new(
        gpu: &Gpu,
        pipelines: &Pipelines,
        uniforms: &wgpu::Buffer,
        maps: &wgpu::Texture,
        blur: &Blur,
        mips: bool,
    ) -> Self {
        let format = pipelines.format;
        let side = |level: u32| maps.width().div_ceil(1 << level);
        let scratch = |level| target_texture(gpu, "reduced moments", (side(level), side(level)), 1, format);
        let size = side(blur.level);
        let moments = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("moments"),
            size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: maps.depth_or_array_layers() },
            mip_level_count: if mips { (size / LEAST_SIZE).checked_ilog2().unwrap_or(0) + 1 } else { 1 },
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let chain: Vec<_> = (AT_ONCE..blur.level).map(scratch).collect();
        let across = blur.has_passes().then(|| scratch(blur.level));
        let bytes = chain.iter().chain(&across).chain([&moments]).map(bytes_of).sum();
        let work = Workshop { gpu, pipelines, uniforms, maps, chain, across, moments: &moments };
        let layers = (0..maps.depth_or_array_layers()).map(|layer| work.passes(layer)).collect();
        let whole =
            wgpu::TextureViewDescriptor { dimension: Some(wgpu::TextureViewDimension::D2Array), ..Default::default() };
        Self { maps: maps.clone(), moments: moments.create_view(&whole), layers, bytes }
    }
}

impl Workshop<'_> {
    fn passes(&self, layer: u32) -> Vec<Pass> {
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
        for level in 1..self.moments.mip_level_count() {
            add(Step::Mip, &view(self.moments, layer, level - 1), &view(self.moments, layer, level));
        }
        passes
    }
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

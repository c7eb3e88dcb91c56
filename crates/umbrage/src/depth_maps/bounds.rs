//! Nearest and farthest depth of ever larger parts of a map: what lets soft filters skip what is surely lit or dark, and
//! look for blockers only as far as there can be some.

use super::DepthMaps;
use crate::fullscreen::{self, FLOATS, Fullscreen, attachment, bind, layout};
use crate::shader::{FULLSCREEN, Shader};
use crate::{gpu::Gpu, passes::Passes};

/// Makes one level of the pyramid.
pub(crate) const BOUNDS_SHADER: Shader =
    Shader { name: "map bounds", parts: &[FULLSCREEN, include_str!("../wgsl/map_bounds.wgsl")], layouts: &[] };

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;

/// The pyramid over all layers of a light's maps; a cell of its level n stands for 4 · 2ⁿ texels a side.
pub(crate) struct BoundsPyramid {
    of_map: (wgpu::BindGroupLayout, wgpu::RenderPipeline),
    of_bounds: (wgpu::BindGroupLayout, wgpu::RenderPipeline),
    made: Option<Made>,
}

struct Made {
    /// The maps it was made for.
    maps: wgpu::Texture,
    texture: wgpu::Texture,
    whole: wgpu::TextureView,
    /// For each layer, its levels from the finest: what is read and what is drawn.
    layers: Vec<Vec<(wgpu::BindGroup, wgpu::TextureView)>>,
}

impl BoundsPyramid {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let module = BOUNDS_SHADER.module(gpu);
        let pass = |entry, sample_type| {
            let reads = layout(gpu, entry, wgpu::ShaderStages::FRAGMENT, &[fullscreen::texture(sample_type)]);
            let target = FORMAT.into();
            let groups = &[&reads];
            let recipe = Fullscreen { label: entry, module: &module, entry, groups, target, constants: &[] };
            let pipeline = recipe.pipeline(gpu);
            (reads, pipeline)
        };
        let of_map = pass("bounds_of_map", wgpu::TextureSampleType::Depth);
        let of_bounds = pass("bounds_of_bounds", FLOATS);
        Self { of_map, of_bounds, made: None }
    }

    /// Makes room for the pyramid of these maps; true where that is new.
    pub(crate) fn prepare(&mut self, gpu: &Gpu, maps: &wgpu::Texture) -> bool {
        if self.made.as_ref().is_some_and(|m| m.maps == *maps) {
            return false;
        }
        self.made = Some(self.make(gpu, maps));
        true
    }

    /// All of it, an array with mip levels.
    pub(crate) fn view(&self) -> Option<&wgpu::TextureView> {
        self.made.as_ref().map(|m| &m.whole)
    }

    /// Fills the layers that were rendered; returns the number of draws.
    pub(crate) fn record(&self, passes: &mut Passes<'_>, maps: &DepthMaps) -> u32 {
        let Some(made) = &self.made else { return 0 };
        let mut draws = 0;
        for view in &maps.views {
            for (level, (reads, target)) in made.layers[view.layer as usize].iter().enumerate() {
                let color = attachment(target, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
                let mut pass = passes.render("map bounds", &[color], None);
                pass.set_pipeline(if level == 0 { &self.of_map.1 } else { &self.of_bounds.1 });
                pass.set_bind_group(0, reads, &[]);
                pass.draw(0..3, 0..1);
                draws += 1;
            }
        }
        draws
    }

    pub(crate) fn bytes(&self) -> u64 {
        let texels =
            |t: &wgpu::Texture| u64::from(t.width()) * u64::from(t.height()) * u64::from(t.depth_or_array_layers());
        // A pyramid of quarters is a third larger than its base.
        self.made.as_ref().map_or(0, |m| texels(&m.texture) * 8 * 4 / 3)
    }

    fn make(&self, gpu: &Gpu, maps: &wgpu::Texture) -> Made {
        // A power of two, so that each cell has four whole ones below.
        let size = maps.width().div_ceil(4).next_power_of_two();
        let count = maps.depth_or_array_layers();
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("map bounds"),
            size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: count },
            mip_level_count: size.ilog2() + 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let whole = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let layers = (0..count).map(|layer| self.levels(gpu, maps, &texture, layer)).collect();
        Made { maps: maps.clone(), texture, whole, layers }
    }

    fn levels(
        &self,
        gpu: &Gpu,
        maps: &wgpu::Texture,
        texture: &wgpu::Texture,
        layer: u32,
    ) -> Vec<(wgpu::BindGroup, wgpu::TextureView)> {
        let one = |texture: &wgpu::Texture, level| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_mip_level: level,
                mip_level_count: Some(1),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let level = |level: u32| {
            let (reads, below) = match level.checked_sub(1) {
                None => (&self.of_map.0, one(maps, 0)),
                Some(finer) => (&self.of_bounds.0, one(texture, finer)),
            };
            let reads = bind(gpu, "map bounds", reads, &[wgpu::BindingResource::TextureView(&below)]);
            (reads, one(texture, level))
        };
        (0..texture.mip_level_count()).map(level).collect()
    }
}

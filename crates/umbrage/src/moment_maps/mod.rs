//! Filterable shadow maps: what is stored are moments of depth, which can be averaged before
//! anything is compared.
//!
//! The stage between the maps and their look-up takes moments, reduces and blurs them, and makes
//! mip levels. What the moments are, and what they say of the share of light, is the technique's.

mod blur;
mod made;
mod pipelines;
mod range;
mod recipe;

use crate::casters::Casters;
use crate::depth_maps::{MapFrame, Stage, TapStage, Taps};
use crate::fullscreen::{self, UNIFORM, bind, layout};
use crate::inline::{Binding, Resource};
use crate::shader::{Shared, shader_struct};
use crate::{choices, settings};
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View};
use blur::{AT_ONCE, Blur};
use made::Made;
use pipelines::Pipelines;
pub(crate) use recipe::{Coding, Recipe};

choices! {
    /// Bits of each stored number.
    pub enum Format {
        /// Single precision.
        Bits32 = "32",
        /// Half precision, or whole numbers of 16 bits.
        Bits16 = "16",
    }
}

settings! {
    /// What all techniques with moments have.
    pub struct Filtering {
        /// Radius of the filter, as that of a disc of the same width. The cost does not depend on
        /// it; values below 1 act as 1.
        radius: f64 = 1.0, in 0.0..=1024.0, unit "texels",
        /// Bits of each stored number.
        format: Format = Format::Bits32,
        /// Looks up coarser levels where a pixel covers many texels.
        mips: bool = true,
    }
}

impl Filtering {
    /// Numbers are stored in 16 bits.
    pub(crate) fn is_half(&self) -> bool {
        self.format == Format::Bits16
    }
}

shader_struct! {
    /// See `moments_depth.wgsl`.
    pub(crate) struct Moments {
        depth: [f32; 4],
        taps: [f32; 3],
        scale: f32,
        variance: f32,
        side: u32,
        levels: u32,
        views: u32,
    }
}

/// What the host has to agree on with `moments_depth.wgsl`.
pub(crate) const SHARED: Shared = Shared { module: "moments_depth", layouts: &[Moments::LAYOUT], constants: &[] };

/// The stage that turns maps into moments.
pub(crate) struct MomentStage {
    blur: Blur,
    /// Makes levels besides the finest.
    coarser: bool,
    /// For a filter that follows the light.
    taps: Option<TapStage>,
    pipelines: Pipelines,
    layout: wgpu::BindGroupLayout,
    /// Of the moments, in the layout.
    moments: wgpu::BindingType,
    uniforms: wgpu::Buffer,
    data: Moments,
    made: Option<Made>,
    /// By layer: the version of the map that moments were last taken of, and in which range.
    taken: Vec<(u64, Moments)>,
    bind_group: Option<wgpu::BindGroup>,
}

impl MomentStage {
    /// Filters maps of `size` texels.
    pub(crate) fn new(gpu: &Gpu, size: u32, filtering: &Filtering, recipe: &Recipe) -> Self {
        Self::make(gpu, Blur::new(filtering.radius, size), recipe, filtering.mips, None)
    }

    /// With filters that follow the light, none narrower than `radius`. Their look-up finds taps
    /// and bounds before the moments, see `depth_maps/stages/soft_taps.wgsl` and
    /// `moments_soft.wgsl`.
    pub(crate) fn soft(gpu: &Gpu, size: u32, filtering: &Filtering, recipe: &Recipe, taps: Taps) -> Self {
        let blur = Blur::new(filtering.radius, size);
        Self::make(gpu, blur, recipe, true, Some(TapStage::light(gpu, taps, true)))
    }

    fn make(gpu: &Gpu, blur: Blur, recipe: &Recipe, coarser: bool, taps: Option<TapStage>) -> Self {
        let moments = wgpu::BindingType::Texture {
            sample_type: recipe.sample_type(),
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let tables: &[_] = if taps.is_some() { &TapStage::LIGHT_BINDINGS } else { &[] };
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            blur,
            coarser,
            taps,
            pipelines: Pipelines::new(gpu, recipe, &blur),
            moments,
            layout: layout(gpu, "moments", wgpu::ShaderStages::FRAGMENT, &[tables, &[UNIFORM, moments]].concat()),
            uniforms: gpu.buffer("moments", &[Moments::default()], usage),
            data: Moments::default(),
            made: None,
            taken: Vec::new(),
            bind_group: None,
        }
    }

    /// Bytes of a texel of moments.
    fn texel_bytes(&self) -> u64 {
        self.pipelines.format.block_copy_size(None).unwrap_or(16).into()
    }

    /// What a look-up reads: 3 × 3 texels of two levels.
    pub(crate) fn lookup_bytes(&self) -> u64 {
        2 * 9 * self.texel_bytes()
    }

    /// What a look-up reads that follows the light, by so many taps of the search and so many of
    /// the filter, which take four texels each.
    pub(crate) fn soft_lookup_bytes(&self, search: u32, filter: u32) -> u64 {
        4 * u64::from(search + 1) + TapStage::BOUNDS_BYTES + 4 * u64::from(filter) * self.texel_bytes()
    }

    /// How far the filter reaches, texels.
    pub(crate) fn reach(&self) -> f64 {
        3.0 * self.blur.variance.sqrt()
    }
}

impl Stage for MomentStage {
    fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn takes_any_size(&self) -> bool {
        false
    }

    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, maps: &MapFrame) -> Result<(), Error> {
        let Some(texture) = &maps.texture else { return Ok(()) };
        let mut is_new = false;
        if let Some(taps) = &mut self.taps {
            is_new = taps.prepare_tables(gpu, view, maps);
        }
        if self.made.as_ref().is_none_or(|m| m.maps != *texture) {
            self.made = Some(Made::new(gpu, &self.pipelines, &self.uniforms, texture, &self.blur, self.coarser));
            self.taken.clear();
            self.taken.resize(texture.depth_or_array_layers() as usize, (0, Moments::default()));
            is_new = true;
        }
        let Some(made) = &self.made else { return Ok(()) };
        if is_new {
            let mut resources = self.taps.as_ref().map_or_else(Vec::new, TapStage::resources);
            resources.push(self.uniforms.as_entire_binding());
            resources.push(wgpu::BindingResource::TextureView(&made.moments));
            self.bind_group = Some(bind(gpu, "moments", &self.layout, &resources));
        }
        self.data = Moments {
            depth: range::linear_from_stored(view, maps),
            taps: self.blur.taps.map(|w| w as f32),
            scale: (1_u32 << self.blur.level) as f32,
            variance: self.blur.variance as f32,
            side: made.side,
            levels: made.levels,
            views: made.layers.len() as u32,
        };
        Ok(())
    }

    fn record(&mut self, passes: &mut Passes<'_>, maps: &MapFrame, casters: &Casters) -> u32 {
        let Some(made) = &self.made else { return 0 };
        passes.upload(&self.uniforms, bytemuck::bytes_of(&self.data));
        let mut draws = self.taps.as_mut().map_or(0, |taps| taps.record(passes, maps, casters));
        let (taken, data) = (&mut self.taken, self.data);
        let mut is_new = |layer: u32| {
            let now = (maps.version(layer), data);
            let last = std::mem::replace(&mut taken[layer as usize], now);
            last.0 != now.0 || bytemuck::bytes_of(&last.1) != bytemuck::bytes_of(&now.1)
        };
        let layers = maps.views.iter().map(|view| view.layer).filter(|layer| is_new(*layer));
        for layer in layers.map(|layer| &made.layers[layer as usize]) {
            for pass in &layer.passes {
                let target = fullscreen::attachment(&pass.target, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
                let mut drawn = passes.render(pass.step.label(), &[target], None);
                drawn.set_pipeline(self.pipelines.of(pass.step));
                drawn.set_bind_group(0, &pass.reads, &[]);
                drawn.draw(0..3, 0..1);
                draws += 1;
            }
            layer.copies.iter().for_each(|copy| copy.record(passes.encoder()));
        }
        draws
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.bind_group.as_ref()
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        let texel = self.texel_bytes();
        match pass {
            // From the map, or from finer moments.
            "moments" => Some(self.blur.texels_taken().max(if self.blur.level > AT_ONCE { texel } else { 0 }) * 4),
            "blur" => Some(5 * texel),
            "mips" => Some(4 * texel),
            _ => None,
        }
    }

    fn lends(&self) -> Option<Vec<Binding>> {
        let mut lent = self.taps.as_ref().map_or_else(Vec::new, TapStage::lends);
        let first = lent.len() as u32;
        lent.push(Binding::of_stage(first, UNIFORM, Resource::Buffer(self.uniforms.clone())));
        let moments = Resource::View(self.made.as_ref()?.moments.clone());
        lent.push(Binding::of_stage(first + 1, self.moments, moments));
        Some(lent)
    }

    fn bytes(&self) -> u64 {
        let tables = self.taps.as_ref().map_or(0, Stage::bytes);
        self.uniforms.size() + tables + self.made.as_ref().map_or(0, |m| m.bytes)
    }
}

//! Filterable shadow maps: what is stored are moments of depth, which can be averaged before anything is compared.
//!
//! The stage between the maps and their look-up takes moments, reduces and blurs them, and makes mip levels. What the moments
//! are, and what they say of the share of light, is the technique's.

mod blur;
mod made;
mod pipelines;
mod range;

use crate::depth_maps::{DepthMaps, Stage};
use crate::fullscreen::{self, FLOATS, UNIFORM, bind, layout};
use crate::params::{Param, ParamKind, Settings};
use crate::shader::{HostLayout, Shader, shader_struct};
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View};
use blur::Blur;
use made::Made;
use pipelines::Pipelines;

/// `radius`: shared by all techniques with moments.
pub(crate) const RADIUS: Param = Param {
    name: "radius",
    help: "Radius of the filter, that of a disc as wide; 1 is the least. Its cost does not depend on it.",
    unit: "texels",
    kind: ParamKind::Float { min: 0.0, max: 1024.0, default: 1.0 },
};

/// `format`: shared by all techniques with moments.
pub(crate) const FORMAT: Param = Param {
    name: "format",
    help: "Bits of each stored number.",
    unit: "",
    kind: ParamKind::Choice { values: &["32", "16"] },
};

/// `mips`: shared by all techniques with moments.
pub(crate) const MIPS: Param = Param {
    name: "mips",
    help: "Looks coarser levels up where a pixel covers many texels.",
    unit: "",
    kind: ParamKind::Switch { default: true },
};

shader_struct! {
    /// See `wgsl/moments_depth.wgsl`.
    pub(crate) struct Moments {
        depth: [f32; 4],
        taps: [f32; 3],
        scale: f32,
        variance: f32,
        pad_a: f32,
        pad_b: f32,
        pad_c: f32,
    }
}

/// Host structs of the passes.
pub(crate) const PASS_LAYOUTS: &[HostLayout] = &[Moments::LAYOUT];

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coding {
    /// Single precision.
    Single,
    /// Half precision.
    Half,
    /// 16 bits from 0 to 1.
    Unorm,
}

/// What a technique stores.
pub(crate) struct Recipe {
    /// The passes, with the technique's `moments_of`.
    pub(crate) passes: Shader,
    /// Numbers a texel: 1, 2 or 4.
    pub(crate) channels: u32,
    pub(crate) coding: Coding,
    /// Pipeline-overridable constants of the passes.
    pub(crate) constants: Vec<(&'static str, f64)>,
}

impl Recipe {
    fn format(&self) -> wgpu::TextureFormat {
        use wgpu::TextureFormat as F;
        let of = |[one, two, four]: [F; 3]| match self.channels {
            1 => one,
            2 => two,
            _ => four,
        };
        of(match self.coding {
            Coding::Single => [F::R32Float, F::Rg32Float, F::Rgba32Float],
            Coding::Half => [F::R16Float, F::Rg16Float, F::Rgba16Float],
            Coding::Unorm => [F::R16Uint, F::Rg16Uint, F::Rgba16Uint],
        })
    }

    fn sample_type(&self) -> wgpu::TextureSampleType {
        if self.coding == Coding::Unorm { wgpu::TextureSampleType::Uint } else { FLOATS }
    }
}

/// The stage that turns maps into moments.
pub(crate) struct MomentStage {
    blur: Blur,
    mips: bool,
    pipelines: Pipelines,
    layout: wgpu::BindGroupLayout,
    uniforms: wgpu::Buffer,
    data: Moments,
    made: Option<Made>,
    /// By layer: the version of the map that moments were last taken of, and in which range.
    taken: Vec<(u64, Moments)>,
    bind_group: Option<wgpu::BindGroup>,
}

impl MomentStage {
    /// With the filter of `size`, `radius` and `mips` of the settings.
    pub(crate) fn new(gpu: &Gpu, settings: &Settings, recipe: &Recipe) -> Self {
        let size = settings.int("size").clamp(1, i64::from(u32::MAX)) as u32;
        Self::with_radius(gpu, recipe, settings.float("radius"), size, settings.switch("mips"))
    }

    /// With a filter of this radius in texels of maps of `size`.
    pub(crate) fn with_radius(gpu: &Gpu, recipe: &Recipe, radius: f64, size: u32, mips: bool) -> Self {
        let blur = Blur::new(radius, size);
        let moments = wgpu::BindingType::Texture {
            sample_type: recipe.sample_type(),
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            blur,
            mips,
            pipelines: Pipelines::new(gpu, recipe, &blur),
            layout: layout(gpu, "moments", wgpu::ShaderStages::FRAGMENT, &[UNIFORM, moments]),
            uniforms: gpu.buffer("moments", &[Moments::default()], usage),
            data: Moments::default(),
            made: None,
            taken: Vec::new(),
            bind_group: None,
        }
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

    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, maps: &DepthMaps) -> Result<(), Error> {
        let Some(texture) = maps.result() else { return Ok(()) };
        if self.made.as_ref().is_none_or(|m| m.maps != *texture) {
            let made = Made::new(gpu, &self.pipelines, &self.uniforms, texture, &self.blur, self.mips);
            let resources = [self.uniforms.as_entire_binding(), wgpu::BindingResource::TextureView(&made.moments)];
            self.bind_group = Some(bind(gpu, "moments", &self.layout, &resources));
            self.made = Some(made);
            self.taken.clear();
            self.taken.resize(texture.depth_or_array_layers() as usize, (0, Moments::default()));
        }
        self.data = Moments {
            depth: range::linear_from_stored(view, maps),
            taps: self.blur.taps.map(|w| w as f32),
            scale: (1_u32 << self.blur.level) as f32,
            variance: self.blur.variance as f32,
            ..Moments::default()
        };
        Ok(())
    }

    fn record(&mut self, passes: &mut Passes<'_>, maps: &DepthMaps) -> u32 {
        let Some(made) = &self.made else { return 0 };
        passes.upload(&self.uniforms, bytemuck::bytes_of(&self.data));
        let mut draws = 0;
        let (taken, data) = (&mut self.taken, self.data);
        let mut is_new = |layer: u32| {
            let now = (maps.version(layer), data);
            let last = std::mem::replace(&mut taken[layer as usize], now);
            last.0 != now.0 || bytemuck::bytes_of(&last.1) != bytemuck::bytes_of(&now.1)
        };
        let layers = maps.views.iter().map(|view| view.layer).filter(|layer| is_new(*layer));
        for pass in layers.flat_map(|layer| &made.layers[layer as usize]) {
            let target = fullscreen::attachment(&pass.target, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
            let mut drawn = passes.render(pass.step.label(), &[target], None);
            drawn.set_pipeline(self.pipelines.of(pass.step));
            drawn.set_bind_group(0, &pass.reads, &[]);
            drawn.draw(0..3, 0..1);
            draws += 1;
        }
        draws
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.bind_group.as_ref()
    }

    fn bytes(&self) -> u64 {
        self.uniforms.size() + self.made.as_ref().map_or(0, |m| m.bytes)
    }
}

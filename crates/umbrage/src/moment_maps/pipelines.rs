//! The full-screen passes of `moments_passes.wgsl`.

use super::blur::{AT_ONCE, Blur};
use super::recipe::Recipe;
use crate::fullscreen::{self, Fullscreen, UNIFORM, bind, layout};
use crate::gpu::Gpu;

/// What a pass does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// From depth to moments, reduced.
    Take,
    Halve,
    BlurAcross,
    BlurDown,
    /// Halves once more, after the blur.
    Mip,
}

impl Step {
    /// What its time is known by.
    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Take | Self::Halve => "moments",
            Self::BlurAcross | Self::BlurDown => "blur",
            Self::Mip => "mips",
        }
    }
}

/// Pipelines and layouts, made once.
pub(super) struct Pipelines {
    /// Of the moments.
    pub(super) format: wgpu::TextureFormat,
    of_depth: wgpu::BindGroupLayout,
    of_moments: wgpu::BindGroupLayout,
    take: wgpu::RenderPipeline,
    halve: wgpu::RenderPipeline,
    across: wgpu::RenderPipeline,
    down: wgpu::RenderPipeline,
}

impl Pipelines {
    pub(super) fn new(gpu: &Gpu, recipe: &Recipe, blur: &Blur) -> Self {
        let format = recipe.format();
        let module = recipe.passes.module(gpu);
        let reads = |sample_type| {
            let bindings = [UNIFORM, fullscreen::texture(sample_type)];
            layout(gpu, "moments", wgpu::ShaderStages::FRAGMENT, &bindings)
        };
        let of_depth = reads(wgpu::TextureSampleType::Depth);
        let of_moments = reads(recipe.sample_type());
        let pipeline = |entry, reads: &wgpu::BindGroupLayout, name, value| {
            let constants: Vec<_> = recipe.constants.iter().copied().chain([(name, value)]).collect();
            let (groups, target) = (&[reads], format.into());
            Fullscreen { label: entry, module: &module, entry, groups, target, constants: &constants }.pipeline(gpu)
        };
        Self {
            format,
            take: if blur.is_in_take() {
                pipeline("take_around", &of_depth, "STEP", 1.0)
            } else {
                pipeline("take", &of_depth, "STEP", f64::from(1 << blur.level.min(AT_ONCE)))
            },
            halve: pipeline("halve", &of_moments, "STEP", 1.0),
            across: pipeline("blur", &of_moments, "DOWN", 0.0),
            down: pipeline("blur", &of_moments, "DOWN", 1.0),
            of_depth,
            of_moments,
        }
    }

    pub(super) fn of(&self, step: Step) -> &wgpu::RenderPipeline {
        match step {
            Step::Take => &self.take,
            Step::Halve | Step::Mip => &self.halve,
            Step::BlurAcross => &self.across,
            Step::BlurDown => &self.down,
        }
    }

    /// What a pass reads.
    pub(super) fn bind(
        &self,
        gpu: &Gpu,
        step: Step,
        uniforms: &wgpu::Buffer,
        from: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        let layout = if step == Step::Take { &self.of_depth } else { &self.of_moments };
        bind(gpu, "moments", layout, &[uniforms.as_entire_binding(), wgpu::BindingResource::TextureView(from)])
    }
}

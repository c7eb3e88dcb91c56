//! Adds radiance that a technique found: it is light that reaches the eye, and needs no shading.

use crate::targets::WIDE;
use umbrage::fullscreen::{self, FLOATS, Fullscreen, additive, attachment, bind, layout};
use umbrage::{Gpu, Passes, RadianceTarget, Shader};

/// The shader.
pub const SHADER: Shader = Shader::new("radiance", include_str!("radiance.wgsl"));

pub(crate) struct RadiancePass {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl RadiancePass {
    pub fn new(gpu: &Gpu) -> Self {
        let layout = layout(gpu, "radiance", wgpu::ShaderStages::FRAGMENT, &[fullscreen::texture(FLOATS)]);
        let pipeline = Fullscreen {
            label: "radiance",
            module: &SHADER.module(gpu),
            entry: "add_radiance",
            groups: &[&layout],
            target: additive(WIDE),
            constants: &[],
        }
        .pipeline(gpu);
        Self { pipeline, layout }
    }

    /// What is read of a target.
    pub fn bind_group(&self, gpu: &Gpu, radiance: &RadianceTarget) -> wgpu::BindGroup {
        bind(gpu, "radiance", &self.layout, &[wgpu::BindingResource::TextureView(&radiance.view)])
    }

    pub fn record(
        &self,
        passes: &mut Passes<'_>,
        picture: &wgpu::TextureView,
        [x, y, width, height]: [u32; 4],
        bind_group: &wgpu::BindGroup,
    ) {
        let mut pass = passes.render("radiance", &[attachment(picture, wgpu::LoadOp::Load)], None);
        pass.set_scissor_rect(x, y, width, height);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, bind_group, &[]);
        pass.draw(0..3, 0..1);
    }
}

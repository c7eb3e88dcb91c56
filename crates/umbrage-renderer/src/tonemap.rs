//! Radiance to a picture for the screen.

use crate::gbuffer::GBuffer;
use umbrage::fullscreen::{self, FLOATS, Fullscreen, attachment, bind, layout, target_texture};
use umbrage::{Gpu, Passes, Shader};

/// The shader.
pub const SHADER: Shader = Shader::new("tone mapping", include_str!("tonemap.wgsl"));

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

pub(super) struct ToneMap {
    pub(super) texture: wgpu::Texture,
    view: wgpu::TextureView,
    pipeline: wgpu::RenderPipeline,
    bind_group: wgpu::BindGroup,
}

impl ToneMap {
    pub(super) fn new(gpu: &Gpu, gbuffer: &GBuffer, width: u32, height: u32) -> Self {
        let texture = target_texture(gpu, "picture", (width, height), 1, FORMAT);
        let layout = layout(gpu, "radiance", wgpu::ShaderStages::FRAGMENT, &[fullscreen::texture(FLOATS)]);
        let radiance = wgpu::BindingResource::TextureView(&gbuffer.radiance_view);
        let bind_group = bind(gpu, "radiance", &layout, &[radiance]);
        let pipeline = Fullscreen {
            label: "tone mapping",
            module: &SHADER.module(gpu),
            entry: "tonemap",
            groups: &[&layout],
            target: FORMAT.into(),
            constants: &[],
        }
        .pipeline(gpu);
        let view = texture.create_view(&Default::default());
        Self { texture, view, pipeline, bind_group }
    }

    pub(super) fn record(&self, passes: &mut Passes<'_>) {
        let target = attachment(&self.view, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
        let mut pass = passes.render("tone mapping", &[target], None);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bind_group, &[]);
        pass.draw(0..3, 0..1);
    }
}

//! The single-pass algorithm (PX 3.4): all lights shine everywhere, then one overlay darkens every point in any shadow. Wrong
//! wherever a point sees one light and not another; kept to be compared with.

use crate::{Lit, Visible, gbuffer::GBuffer};
use umbrage::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, attachment, bind, layout};
use umbrage::{Error, Gpu, Owner, Passes, Shader, VisibilityTarget};
use umbrage_core::Light;

/// The shader.
pub const SHADER: Shader = Shader::new("overlay", include_str!("overlay.wgsl"));

pub(super) struct Overlay {
    /// 0 where a point is in any shadow.
    visibility: VisibilityTarget,
    pipeline: wgpu::RenderPipeline,
    bind_group: wgpu::BindGroup,
}

impl Overlay {
    /// `darkness`: the share of light taken from points in shadow, 0…1.
    pub fn new(gpu: &Gpu, (width, height): (u32, u32), darkness: f32) -> Result<Self, Error> {
        let visibility = VisibilityTarget::new(gpu, width, height)?;
        let bindings = [fullscreen::texture(FLOATS), UNIFORM];
        let group = layout(gpu, "overlay", wgpu::ShaderStages::FRAGMENT, &bindings);
        let darkness =
            gpu.buffer("darkness", &[[darkness.clamp(0.0, 1.0), 0.0, 0.0, 0.0]], wgpu::BufferUsages::UNIFORM);
        let resources = [wgpu::BindingResource::TextureView(&visibility.view), darkness.as_entire_binding()];
        let bind_group = bind(gpu, "overlay", &group, &resources);
        let over = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::SrcAlpha,
            dst_factor: wgpu::BlendFactor::OneMinusSrcAlpha,
            operation: wgpu::BlendOperation::Add,
        };
        // Opacity marks where something was drawn; it stays.
        let keep = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::Zero,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let target = wgpu::ColorTargetState {
            blend: Some(wgpu::BlendState { color: over, alpha: keep }),
            ..wgpu::TextureFormat::Rgba16Float.into()
        };
        let module = SHADER.module(gpu);
        let pipeline = Fullscreen {
            label: "overlay",
            module: &module,
            entry: "darken",
            groups: &[&group],
            target,
            constants: &[],
        }
        .pipeline(gpu);
        Ok(Self { visibility, pipeline, bind_group })
    }

    /// Has the first light's technique find what is in any shadow.
    pub fn find(
        &self,
        gpu: &Gpu,
        passes: &mut Passes<'_>,
        scene: &Visible<'_>,
        lights: &mut [Lit],
    ) -> Result<(), Error> {
        let shapes: Vec<Light> = lights.iter().map(|lit| lit.light.clone()).collect();
        let views: Vec<_> = shapes.iter().map(|light| scene.view(light)).collect();
        let Some(first) = lights.first_mut() else { return Ok(()) };
        passes.owner(Owner::Light(first.number));
        first.technique.record_overlay(gpu, passes, &views, &self.visibility)
    }

    /// Darkens that.
    pub fn record(&self, passes: &mut Passes<'_>, gbuffer: &GBuffer) {
        let target = attachment(&gbuffer.radiance_view, wgpu::LoadOp::Load);
        let mut pass = passes.render("overlay", &[target], None);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bind_group, &[]);
        pass.draw(0..3, 0..1);
    }
}

//! The single-pass algorithm (PX 3.4): all lights shine everywhere, then one overlay darkens every
//! point in any shadow. Wrong wherever a point sees one light and not another; kept to be compared
//! with.

use crate::lit::{Lit, Visible};
use crate::targets::WIDE;
use umbrage::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, attachment, bind, layout};
use umbrage::techniques::volume::record_overlay;
use umbrage::{Answer, Error, Gpu, Owner, Passes, Shader, VisibilityTarget};
use umbrage_core::Light;

/// The shader.
pub const SHADER: Shader = Shader::new("overlay", include_str!("overlay.wgsl"));

pub(crate) struct Overlay {
    /// 0 where a point is in any shadow.
    visibility: VisibilityTarget,
    darkness: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    bind_group: wgpu::BindGroup,
}

impl Overlay {
    /// `darkness`: the share of light taken from points in shadow, 0…1.
    pub fn new(gpu: &Gpu, size: (u32, u32), darkness: f32) -> Result<Self, Error> {
        let visibility = VisibilityTarget::new(gpu, size.0, size.1)?;
        let bindings = [fullscreen::texture(FLOATS), UNIFORM];
        let layout = layout(gpu, "overlay", wgpu::ShaderStages::FRAGMENT, &bindings);
        let darkness =
            gpu.buffer("darkness", &[[darkness.clamp(0.0, 1.0), 0.0, 0.0, 0.0]], wgpu::BufferUsages::UNIFORM);
        let bind_group = bind_group(gpu, &layout, &visibility, &darkness);
        let pipeline = pipeline(gpu, &layout);
        Ok(Self { visibility, darkness, layout, pipeline, bind_group })
    }

    /// From now on for pictures of this size.
    pub fn resize(&mut self, gpu: &Gpu, (width, height): (u32, u32)) -> Result<(), Error> {
        self.visibility = VisibilityTarget::new(gpu, width, height)?;
        self.bind_group = bind_group(gpu, &self.layout, &self.visibility, &self.darkness);
        Ok(())
    }

    /// Has the first light's technique find what is in any shadow.
    pub fn find(
        &self,
        gpu: &Gpu,
        passes: &mut Passes<'_>,
        scene: &Visible<'_>,
        lights: &mut [Lit],
    ) -> Result<(), Error> {
        if let Some(lit) = lights.iter().find(|lit| lit.target.answer() != Answer::Visibility) {
            return lit.target.answer().refuse();
        }
        let shapes: Vec<Light> = lights.iter().map(|lit| lit.light.clone()).collect();
        let views: Vec<_> = shapes.iter().map(|light| scene.view(light)).collect();
        let Some(first) = lights.first_mut() else { return Ok(()) };
        passes.owner(Owner::Light(first.number));
        record_overlay(&mut *first.technique, gpu, passes, &views, &self.visibility)
    }

    /// Darkens that.
    pub fn record(&self, passes: &mut Passes<'_>, radiance: &wgpu::TextureView) {
        let target = attachment(radiance, wgpu::LoadOp::Load);
        let mut pass = passes.render("overlay", &[target], None);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bind_group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn bind_group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    visibility: &VisibilityTarget,
    darkness: &wgpu::Buffer,
) -> wgpu::BindGroup {
    let resources = [wgpu::BindingResource::TextureView(&visibility.view), darkness.as_entire_binding()];
    bind(gpu, "overlay", layout, &resources)
}

fn pipeline(gpu: &Gpu, layout: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
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
    let blend = Some(wgpu::BlendState { color: over, alpha: keep });
    Fullscreen {
        label: "overlay",
        module: &SHADER.module(gpu),
        entry: "darken",
        groups: &[layout],
        target: wgpu::ColorTargetState { blend, ..WIDE.into() },
        constants: &[],
    }
    .pipeline(gpu)
}

//! Radiance to a picture for the screen.

use crate::targets::{GBuffer, PICTURE};
use umbrage::fullscreen::{self, FLOATS, Fullscreen, attachment, bind, layout};
use umbrage::{Error, Gpu, Module, Passes, Shader};

/// What makes radiance a colour of the screen.
pub const DISPLAY_MODULE: Module = Module { name: "display", source: include_str!("display.wgsl") };

/// The shader.
pub const SHADER: Shader = Shader::new("tone mapping", include_str!("tonemap.wgsl")).with_modules(&[DISPLAY_MODULE]);

/// Draws radiance to targets of any format.
pub(crate) struct ToneMap {
    module: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    /// One for each format that was drawn to.
    pipelines: Vec<(wgpu::TextureFormat, wgpu::RenderPipeline)>,
}

impl ToneMap {
    pub fn new(gpu: &Gpu) -> Self {
        let module = SHADER.module(gpu);
        let layout = layout(gpu, "radiance", wgpu::ShaderStages::FRAGMENT, &[fullscreen::texture(FLOATS)]);
        let own = pipeline(gpu, &module, &layout, PICTURE);
        Self { module, layout, pipelines: vec![(PICTURE, own)] }
    }

    /// What is read of a G-buffer.
    pub fn radiance(&self, gpu: &Gpu, gbuffer: &GBuffer) -> wgpu::BindGroup {
        bind(gpu, "radiance", &self.layout, &[wgpu::BindingResource::TextureView(&gbuffer.radiance_view)])
    }

    /// Makes what targets of this format need, where it is not there yet.
    ///
    /// # Errors
    /// [`Error::Scene`] for a format that is not one of colours.
    pub fn prepare(&mut self, gpu: &Gpu, format: wgpu::TextureFormat) -> Result<(), Error> {
        if self.pipelines.iter().any(|(known, _)| *known == format) {
            return Ok(());
        }
        let is_float = matches!(format.sample_type(None, None), Some(wgpu::TextureSampleType::Float { .. }));
        let usages = format.guaranteed_format_features(gpu.device.features()).allowed_usages;
        if !is_float || !usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
            return Err(Error::Scene(format!("a picture can't be drawn as {format:?}; choose a format of colours")));
        }
        self.pipelines.push((format, pipeline(gpu, &self.module, &self.layout, format)));
        Ok(())
    }

    /// Draws `radiance` to a view of a format that was prepared.
    pub fn record(
        &self,
        passes: &mut Passes<'_>,
        radiance: &wgpu::BindGroup,
        target: &wgpu::TextureView,
        format: wgpu::TextureFormat,
    ) {
        let Some((_, pipeline)) = self.pipelines.iter().find(|(known, _)| *known == format) else { return };
        let target = attachment(target, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
        let mut pass = passes.render("tone mapping", &[target], None);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, radiance, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Whether shaders encode as sRGB what they write to a format: what is stored in others is linear,
/// or the GPU encodes it.
pub(crate) fn encodes(format: wgpu::TextureFormat) -> bool {
    use wgpu::TextureFormat::{Rg11b10Ufloat, Rgba16Float, Rgba32Float};
    !(format.is_srgb() || matches!(format, Rg11b10Ufloat | Rgba16Float | Rgba32Float))
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    layout: &wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    Fullscreen {
        label: "tone mapping",
        module,
        entry: "tonemap",
        groups: &[layout],
        target: format.into(),
        constants: &[("ENCODES", f64::from(u8::from(encodes(format))))],
    }
    .pipeline(gpu)
}

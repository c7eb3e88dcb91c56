//! Adds one light under its visibility: the standard lighting model (PX 2.2.4), per pixel.

use crate::lit::Target;
use crate::radiance::RadiancePass;
use crate::targets::{GBuffer, Targets, WIDE};
use umbrage::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, additive, attachment, bind, layout};
use umbrage::{Eye, Gpu, Passes, Receivers, Shader, View, VisibilityTarget, shader_struct};
use umbrage_core::{LightShape, glam::DVec3};

/// The shader.
pub const SHADER: Shader = Shader::new("shading", include_str!("shading.wgsl")).with_layouts(&[ShadingLight::LAYOUT]);

shader_struct! {
    /// A light as the shader reads it, relative to the eye.
    struct ShadingLight {
        eye: Eye,
        /// Place of the light's centre (w = 1) or direction to it (w = 0).
        center: [f32; 4],
        /// Colour times intensity.
        color: [f32; 3],
        range: f32,
        attenuation: [f32; 3],
        /// Cosine at which a spot has full strength.
        inner_cos: f32,
        /// The way the light travels, or the emitting side.
        direction: [f32; 3],
        /// Cosine at which the light has fallen to nothing; −2 for lights to all sides.
        outer_cos: f32,
    }
}

/// Adds lights to the radiance of a G-buffer.
pub(crate) struct Shading {
    pipeline: wgpu::RenderPipeline,
    surface_layout: wgpu::BindGroupLayout,
    light_layout: wgpu::BindGroupLayout,
    /// For techniques that leave nothing to shade.
    pub radiance: RadiancePass,
}

/// What one light needs of its own.
pub(crate) struct Slot {
    uniforms: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl Shading {
    pub fn new(gpu: &Gpu) -> Self {
        let stage = wgpu::ShaderStages::FRAGMENT;
        let floats = fullscreen::texture(FLOATS);
        let surface_layout = layout(gpu, "surface", stage, &[floats, floats]);
        let light_layout = layout(gpu, "light", stage, &[UNIFORM, floats]);
        let pipeline = Fullscreen {
            label: "shading",
            module: &SHADER.module(gpu),
            entry: "shade",
            groups: &[&Receivers::layout(gpu), &surface_layout, &light_layout],
            target: additive(WIDE),
            constants: &[],
        }
        .pipeline(gpu);
        Self { pipeline, surface_layout, light_layout, radiance: RadiancePass::new(gpu) }
    }

    /// What is read of a G-buffer.
    pub fn surface(&self, gpu: &Gpu, gbuffer: &GBuffer) -> wgpu::BindGroup {
        let views = [&gbuffer.shading_view, &gbuffer.color_view].map(wgpu::BindingResource::TextureView);
        bind(gpu, "surface", &self.surface_layout, &views)
    }

    pub fn slot(&self, gpu: &Gpu, visibility: &VisibilityTarget) -> Slot {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniforms = gpu.buffer("light", &[ShadingLight::default()], usage);
        let visibility = wgpu::BindingResource::TextureView(&visibility.view);
        let bind_group = bind(gpu, "light", &self.light_layout, &[uniforms.as_entire_binding(), visibility]);
        Slot { uniforms, bind_group }
    }

    /// Adds the light of `view` within these pixels, by the answer of its technique.
    pub fn record(
        &self,
        passes: &mut Passes<'_>,
        targets: &Targets,
        view: &View<'_>,
        pixels: [u32; 4],
        answer: &Target,
    ) {
        match answer {
            Target::Visibility(_, slot) => self.record_light(passes, targets, view, pixels, slot),
            Target::Radiance(_, read) => self.radiance.record(passes, &targets.gbuffer.radiance_view, pixels, read),
        }
    }

    fn record_light(
        &self,
        passes: &mut Passes<'_>,
        targets: &Targets,
        view: &View<'_>,
        [x, y, width, height]: [u32; 4],
        slot: &Slot,
    ) {
        passes.upload(&slot.uniforms, bytemuck::bytes_of(&light_uniforms(view)));
        let target = attachment(&targets.gbuffer.radiance_view, wgpu::LoadOp::Load);
        let mut pass = passes.render("light", &[target], None);
        pass.set_scissor_rect(x, y, width, height);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, view.receivers.bind_group(), &[]);
        pass.set_bind_group(1, &targets.surface, &[]);
        pass.set_bind_group(2, &slot.bind_group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn light_uniforms(view: &View<'_>) -> ShadingLight {
    let light = view.light;
    let cos = |angle_deg: f64| angle_deg.to_radians().cos() as f32;
    let (direction, inner_cos, outer_cos) = match light.shape {
        LightShape::Spot { direction, inner_angle_deg, outer_angle_deg, .. } => {
            (direction, cos(inner_angle_deg), cos(outer_angle_deg))
        }
        // One side only: nothing behind the plane, full strength in front of it.
        LightShape::Disc { direction, .. } | LightShape::Rect { direction, .. } => (direction, 1e-3, 0.0),
        _ => (DVec3::ZERO, -1.0, -2.0),
    };
    let center = light.shape.center();
    ShadingLight {
        eye: Eye::new(view),
        center: (center.truncate() - view.camera.eye * center.w).extend(center.w).as_vec4().to_array(),
        color: (light.color * light.intensity).to_array(),
        range: light.range.map_or(f32::MAX, |r| r as f32),
        attenuation: light.attenuation.to_array(),
        inner_cos,
        direction: direction.as_vec3().to_array(),
        outer_cos,
    }
}

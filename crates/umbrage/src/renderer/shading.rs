//! Adds one light under its visibility: the standard lighting model (PX 2.2.4), per pixel.

use super::gbuffer::GBuffer;
use crate::depth_maps::Eye;
use crate::shader::{FULLSCREEN, RECEIVERS, Shader, shader_struct};
use crate::{gpu::Gpu, passes::Passes, view::View, visibility::VisibilityTarget};
use umbrage_core::{LightShape, glam::DVec3};

/// The shader.
pub const SHADER: Shader = Shader {
    name: "shading",
    parts: &[FULLSCREEN, RECEIVERS, include_str!("shading.wgsl")],
    layouts: &[Eye::LAYOUT, ShadingLight::LAYOUT],
};

shader_struct! {
    /// A light as the shader reads it, relative to the eye.
    pub(crate) struct ShadingLight {
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

pub(super) struct Shading {
    pipeline: wgpu::RenderPipeline,
    surface: wgpu::BindGroup,
    light_layout: wgpu::BindGroupLayout,
}

/// What one light needs of its own.
pub(super) struct Slot {
    uniforms: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl Shading {
    pub(super) fn new(gpu: &Gpu, gbuffer: &GBuffer) -> Self {
        let texture = |binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: false },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        let uniform = wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let group = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let surface_layout = group("surface", &[texture(0), texture(1)]);
        let light_layout = group("light", &[uniform, texture(1)]);
        let surface = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("surface"),
            layout: &surface_layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(&gbuffer.shading_view),
                },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&gbuffer.color_view) },
            ],
        });
        let pipeline = pipeline(gpu, &surface_layout, &light_layout);
        Self { pipeline, surface, light_layout }
    }

    pub(super) fn slot(&self, gpu: &Gpu, visibility: &VisibilityTarget) -> Slot {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniforms = gpu.buffer("light", &[ShadingLight::default()], usage);
        let bind_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("light"),
            layout: &self.light_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&visibility.view) },
            ],
        });
        Slot { uniforms, bind_group }
    }

    pub(super) fn record(&self, passes: &mut Passes<'_>, gbuffer: &GBuffer, view: &View<'_>, slot: &Slot) {
        passes.upload(&slot.uniforms, bytemuck::bytes_of(&light_uniforms(view)));
        let target = wgpu::RenderPassColorAttachment {
            view: &gbuffer.radiance_view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        };
        let mut pass = passes.render("light", &[Some(target)], None);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &view.receivers.bind_group, &[]);
        pass.set_bind_group(1, &self.surface, &[]);
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

fn pipeline(gpu: &Gpu, surface: &wgpu::BindGroupLayout, light: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
    let module = SHADER.module(gpu);
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[Some(&crate::receivers::Receivers::layout(gpu)), Some(surface), Some(light)],
        ..Default::default()
    });
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("shading"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("fullscreen"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("shade"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: wgpu::TextureFormat::Rgba16Float,
                blend: Some(wgpu::BlendState { color: add, alpha: add }),
                write_mask: wgpu::ColorWrites::COLOR,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

//! The full-screen pass that adds what a light gives off.

use crate::light::Emission;
use crate::normals::{eye_from_ndc, ndc_from_pixel, to_eye};
use bevy::prelude::Vec3;
use std::collections::HashMap;
use umbrage::core::glam::DVec3;
use umbrage::core::{Light, LightShape};
use umbrage::fullscreen::{FLOATS, Fullscreen, UNIFORM, additive, bind, layout, texture};
use umbrage::{Gpu, Passes, View};

/// As in `shade.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
struct Emitter {
    eye_from_ndc: [[f32; 4]; 4],
    position: [f32; 3],
    radius: f32,
    color: [f32; 3],
    inverse_square_range: f32,
    axis: [f32; 3],
    is_directional: u32,
    cone: [f32; 2],
    ndc_from_pixel: [f32; 2],
    to_eye: [f32; 4],
}

impl Emitter {
    fn of(view: &View<'_>, emission: &Emission, exposure: f32) -> Self {
        let (position, axis, is_directional) = places(view.light, view.camera.eye);
        let Emission { color, radius, range, cone } = *emission;
        Self {
            eye_from_ndc: eye_from_ndc(&view.camera),
            position: position.as_vec3().to_array(),
            radius,
            color: Vec3::to_array(&(color * exposure)),
            inverse_square_range: 1.0 / (range * range),
            axis: axis.as_vec3().to_array(),
            is_directional: is_directional.into(),
            cone,
            ndc_from_pixel: ndc_from_pixel(view.receivers.size),
            to_eye: to_eye(&view.camera),
        }
    }
}

/// Where light comes from, relative to the eye, the way that a spot's light travels, and whether it
/// comes from one direction.
fn places(light: &Light, eye: DVec3) -> (DVec3, DVec3, bool) {
    match light.shape {
        LightShape::Directional { direction, .. } => (-direction, DVec3::ZERO, true),
        LightShape::Spot { position, direction, .. } | LightShape::Disc { position, direction, .. } => {
            (position - eye, direction, false)
        }
        _ => (light.shape.center().truncate() - eye, DVec3::ZERO, false),
    }
}

/// Pipelines for the formats of pictures, and what they read.
pub struct Shade {
    module: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    pipelines: HashMap<wgpu::TextureFormat, wgpu::RenderPipeline>,
    emitter: wgpu::Buffer,
}

/// Bevy's G-buffer, and the visibility that was found for it.
pub struct Textures<'a> {
    pub depth: &'a wgpu::TextureView,
    pub deferred: &'a wgpu::TextureView,
    pub pass: &'a wgpu::TextureView,
    pub visibility: &'a wgpu::TextureView,
}

impl Shade {
    pub fn new(gpu: &Gpu) -> Self {
        let source =
            wgpu::ShaderSource::Wgsl([include_str!("shade.wgsl"), include_str!("direction.wgsl")].concat().into());
        let module =
            gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("umbrage shade"), source });
        let uint = wgpu::TextureSampleType::Uint;
        let [depth, deferred, pass, visibility] = [wgpu::TextureSampleType::Depth, uint, uint, FLOATS].map(texture);
        let bindings = [depth, deferred, pass, visibility, UNIFORM];
        let layout = layout(gpu, "umbrage shade", wgpu::ShaderStages::FRAGMENT, &bindings);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let emitter = gpu.buffer("umbrage emitter", &[Emitter::default()], usage);
        Self { module, layout, pipelines: HashMap::new(), emitter }
    }

    pub fn bind(&self, gpu: &Gpu, textures: &Textures<'_>) -> wgpu::BindGroup {
        let Textures { depth, deferred, pass, visibility } = *textures;
        let [a, b, c, d] = [depth, deferred, pass, visibility].map(wgpu::BindingResource::TextureView);
        bind(gpu, "umbrage shade", &self.layout, &[a, b, c, d, self.emitter.as_entire_binding()])
    }

    /// Adds a light to what `target` holds.
    pub fn record(
        &mut self,
        (gpu, passes): (&Gpu, &mut Passes<'_>),
        (view, emission, exposure): (&View<'_>, &Emission, f32),
        textures: &wgpu::BindGroup,
        target: wgpu::RenderPassColorAttachment<'_>,
    ) {
        let emitter = Emitter::of(view, emission, exposure);
        passes.upload(&self.emitter, bytemuck::bytes_of(&emitter));
        let Self { module, layout, pipelines, .. } = self;
        let format = target.view.texture().format();
        let pipeline = pipelines.entry(format).or_insert_with(|| {
            let shade = Fullscreen {
                label: "umbrage shade",
                module,
                entry: "shade",
                groups: &[layout],
                target: additive(format),
                constants: &[],
            };
            shade.pipeline(gpu)
        });
        let mut pass = passes.render("umbrage shade", &[Some(target)], None);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, textures, &[]);
        pass.draw(0..3, 0..1);
    }
}

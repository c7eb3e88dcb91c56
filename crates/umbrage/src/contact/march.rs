//! The pass that marches rays through the depth buffer.

use super::Contact;
use crate::fullscreen::{self, Fullscreen, UNIFORM, attachment, bind, smaller};
use crate::receivers::{Eye, Receivers};
use crate::shader::{Shader, shader_struct};
use crate::{gpu::Gpu, passes::Passes, view::View, visibility::VisibilityTarget};
use umbrage_core::glam::DVec4;
use umbrage_core::sampling::hard_lights;

pub(super) const SHADER: Shader = Shader::new("contact shadows", include_str!("contact.wgsl"))
    .with_layouts(&[ContactMarch::LAYOUT])
    .with_constants(&[("MOST_POINTS", MOST_POINTS as f64)]);

/// Name of the pass.
pub(super) const PASS: &str = "contact shadows";

/// Points of a soft light that rays go to.
const MOST_POINTS: usize = 4;

/// Look-ups along the one ray to a hard light, and along each of those to a soft one.
const STEPS: [u32; 2] = [16, 8];

shader_struct! {
    /// See `contact.wgsl`.
    pub(crate) struct ContactMarch {
        eye: Eye,
        ndc_from_eye: [[f32; 4]; 4],
        lights: [[f32; 4]; MOST_POINTS],
        ahead: [f32; 3],
        length: f32,
        length_in_pixels: f32,
        thickness: f32,
        thickness_in_pixels: f32,
        pad: f32,
        size: [i32; 2],
        pad_a: [i32; 2],
    }
}

/// Takes the smaller of what is in a target and what rays find.
pub(super) struct March {
    contact: Contact,
    module: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
    data: ContactMarch,
    /// The pixels that the light can light: the first, and how many.
    pixels: [u32; 4],
    /// Points of the light of the frame that was prepared.
    points: usize,
    /// By whether receivers have normals, and whether the light is soft.
    pipelines: [[Option<wgpu::RenderPipeline>; 2]; 2],
}

impl March {
    pub fn new(gpu: &Gpu, contact: Contact) -> Self {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let layout = fullscreen::layout(gpu, PASS, wgpu::ShaderStages::FRAGMENT, &[UNIFORM]);
        let uniform = gpu.buffer(PASS, &[ContactMarch::default()], usage);
        let bind_group = bind(gpu, PASS, &layout, &[uniform.as_entire_binding()]);
        Self {
            contact,
            module: SHADER.module(gpu),
            layout,
            uniform,
            bind_group,
            data: ContactMarch::default(),
            pixels: [0; 4],
            points: 1,
            pipelines: Default::default(),
        }
    }

    pub fn prepare(&mut self, gpu: &Gpu, view: &View<'_>) {
        let asked = if view.light.shape.kind().is_soft() { MOST_POINTS } else { 1 };
        let points = hard_lights(&view.light.shape, view.textures, asked);
        let relative = |p: DVec4| (p - view.camera.eye.extend(0.0) * p.w).as_vec4().to_array();
        let lights = std::array::from_fn(|i| points.get(i).map_or([0.0; 4], |point| relative(point.center())));
        let ((length, long), (thickness, thick)) = (self.contact.length.parts(), self.contact.thickness.parts());
        let (width, height) = view.receivers.size;
        self.points = points.len().clamp(1, MOST_POINTS);
        self.data = ContactMarch {
            eye: Eye::new(view),
            ndc_from_eye: view.clip_from_eye().as_mat4().to_cols_array_2d(),
            lights,
            ahead: view.camera.forward().as_vec3().to_array(),
            length: length as f32,
            length_in_pixels: f32::from(u8::from(long)),
            thickness: thickness as f32,
            thickness_in_pixels: f32::from(u8::from(thick)),
            pad: 0.0,
            size: [width as i32, height as i32],
            pad_a: [0; 2],
        };
        self.pixels = view.lit_pixels();
        let has_normals = view.receivers.has_normals;
        let known = &mut self.pipelines[usize::from(has_normals)][usize::from(self.points > 1)];
        if known.is_none() {
            let receivers = Receivers::layout(gpu);
            let constants = [
                ("HAS_NORMALS", f64::from(u8::from(has_normals))),
                ("POINTS", self.points as f64),
                ("STEPS", f64::from(STEPS[usize::from(self.points > 1)])),
            ];
            let pass = Fullscreen {
                label: PASS,
                module: &self.module,
                entry: "contact_shadows",
                groups: &[&receivers, &self.layout],
                target: smaller(VisibilityTarget::FORMAT),
                constants: &constants,
            };
            *known = Some(pass.pipeline(gpu));
        }
    }

    pub fn record(&self, passes: &mut Passes<'_>, view: &View<'_>, visibility: &VisibilityTarget) {
        let [x, y, width, height] = self.pixels;
        let known = &self.pipelines[usize::from(view.receivers.has_normals)][usize::from(self.points > 1)];
        let Some(pipeline) = known.as_ref().filter(|_| width > 0 && height > 0) else { return };
        passes.upload(&self.uniform, bytemuck::bytes_of(&self.data));
        let mut pass = passes.render(PASS, &[attachment(&visibility.view, wgpu::LoadOp::Load)], None);
        pass.set_scissor_rect(x, y, width, height);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &view.receivers.bind_group, &[]);
        pass.set_bind_group(1, &self.bind_group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Bytes that a pixel reads at most: depth at each step and its own, and what it is
    /// blended with.
    pub fn reads(&self) -> u64 {
        let steps = STEPS[usize::from(self.points > 1)];
        4 * (1 + u64::from(steps) * self.points as u64) + 2
    }

    pub fn bytes(&self) -> u64 {
        self.uniform.size()
    }
}

//! A plan of the scene from above: which casters cast shadows this frame, and why others do not.

use super::select::{Fate, Selection};
use crate::fullscreen::attachment;
use crate::shader::Shader;
use crate::{gpu::Gpu, passes::Passes, view::View};
use umbrage_core::Bounds;
use umbrage_core::glam::{DVec2, DVec3, DVec4, Vec2};

pub(super) const PLAN_SHADER: Shader = Shader::new("plan of casters", include_str!("plan.wgsl"));

/// A corner of a coloured triangle: place on the target, colour and opacity.
type Vertex = [f32; 6];

/// Draws plans.
pub(super) struct Plan {
    pipeline: wgpu::RenderPipeline,
    buffer: Option<wgpu::Buffer>,
}

impl Fate {
    fn color(self) -> [f32; 3] {
        match self {
            Self::FromEye => [0.15, 0.65, 0.25],
            Self::FromInfinity => [0.95, 0.75, 0.1],
            Self::OutOfView => [0.75, 0.15, 0.15],
            Self::OutOfLight => [0.2, 0.35, 0.85],
            Self::ShadowsNothing => [0.35, 0.35, 0.38],
            Self::OverBudget => [0.75, 0.25, 0.75],
            Self::InMaps => [0.2, 0.75, 0.75],
        }
    }
}

impl Plan {
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let module = PLAN_SHADER.module(gpu);
        let blended = wgpu::ColorTargetState { blend: Some(wgpu::BlendState::ALPHA_BLENDING), ..format.into() };
        let pipeline = gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("plan"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("place"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<Vertex>() as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x2, 1 => Float32x4],
                })],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("paint"),
                compilation_options: Default::default(),
                targets: &[Some(blended)],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { pipeline, buffer: None }
    }

    pub fn record(
        &mut self,
        gpu: &Gpu,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        selection: &Selection,
        target: &wgpu::TextureView,
    ) {
        let vertices = draw(view, selection);
        let data: &[u8] = bytemuck::cast_slice(&vertices);
        if self.buffer.as_ref().is_none_or(|b| b.size() < data.len() as u64) {
            self.buffer = Some(gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("plan"),
                size: data.len().next_power_of_two() as u64,
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
        let Some(buffer) = &self.buffer else { return };
        passes.upload(buffer, data);
        let paper = wgpu::Color { r: 0.06, g: 0.06, b: 0.07, a: 1.0 };
        let mut pass = passes.render("view", &[attachment(target, wgpu::LoadOp::Clear(paper))], None);
        pass.set_pipeline(&self.pipeline);
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..vertices.len() as u32, 0..1);
    }
}

/// The sheet: world x to the right, world z down.
struct Sheet {
    middle: DVec2,
    scale: DVec2,
    /// Of a pixel, in world units.
    pixel: f64,
    vertices: Vec<Vertex>,
}

fn draw(view: &View<'_>, selection: &Selection) -> Vec<Vertex> {
    let casters = view.casters;
    let eye = view.camera.eye;
    let center = view.light.shape.center();
    let light = if center.w == 0.0 { eye } else { center.truncate() };
    let shown = casters.all_bounds().with(eye).with(light);
    let mut sheet = Sheet::new(&shown, view.receivers.size);
    for (place, fate) in selection.fates(casters) {
        sheet.area(&casters.placed()[place as usize].bounds, fate.color());
    }
    sheet.camera(view, shown.size().length());
    let white = [1.0, 1.0, 1.0];
    if center.w == 0.0 {
        let toward = flat(center.truncate()).normalize_or_zero() * shown.size().length() * 0.12;
        let at = sheet.middle;
        sheet.line(at, at + toward, [1.0, 0.9, 0.4], 2.0);
        sheet.dot(at + toward, [1.0, 0.9, 0.4]);
    } else {
        sheet.dot(flat(light), [1.0, 0.9, 0.4]);
    }
    sheet.dot(flat(eye), white);
    sheet.vertices
}

impl Sheet {
    fn new(shown: &Bounds, (width, height): (u32, u32)) -> Self {
        let size = flat(shown.size()).max(DVec2::splat(1e-6)) * 1.08;
        let per_pixel = (size.x / f64::from(width)).max(size.y / f64::from(height));
        let scale = DVec2::new(2.0 / (f64::from(width) * per_pixel), -2.0 / (f64::from(height) * per_pixel));
        Self { middle: flat(shown.center()), scale, pixel: per_pixel, vertices: Vec::new() }
    }

    fn at(&self, p: DVec2) -> Vec2 {
        ((p - self.middle) * self.scale).as_vec2()
    }

    fn quad(&mut self, corners: [DVec2; 4], [r, g, b]: [f32; 3], opacity: f32) {
        for i in [0, 1, 2, 0, 2, 3] {
            let p = self.at(corners[i]);
            self.vertices.push([p.x, p.y, r, g, b, opacity]);
        }
    }

    fn line(&mut self, a: DVec2, b: DVec2, color: [f32; 3], pixels: f64) {
        let across = (b - a).normalize_or_zero().perp() * (0.5 * pixels * self.pixel);
        self.quad([a - across, b - across, b + across, a + across], color, 0.9);
    }

    fn dot(&mut self, p: DVec2, color: [f32; 3]) {
        let r = DVec2::splat(4.0 * self.pixel);
        self.quad([p - r, p + DVec2::new(r.x, -r.y), p + r, p + DVec2::new(-r.x, r.y)], color, 1.0);
    }

    fn area(&mut self, bounds: &Bounds, color: [f32; 3]) {
        if bounds.is_empty() {
            return;
        }
        let (low, high) = (flat(bounds.min), flat(bounds.max));
        let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
        self.quad(corners, color, 0.35);
        for i in 0..4 {
            self.line(corners[i], corners[(i + 1) % 4], color, 1.0);
        }
    }

    /// The outline of what the camera sees, out to `far` metres.
    fn camera(&mut self, view: &View<'_>, far: f64) {
        let world_from_clip = view.clip_from_eye().inverse();
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| {
            let p = world_from_clip * DVec4::new(x, y, 0.5, 1.0);
            let direction = (p.truncate() * p.w.signum()).normalize_or_zero();
            flat(view.camera.eye + direction * far)
        });
        let eye = flat(view.camera.eye);
        for corner in corners {
            self.line(eye, corner, [1.0; 3], 1.0);
        }
    }
}

fn flat(v: DVec3) -> DVec2 {
    DVec2::new(v.x, v.z)
}

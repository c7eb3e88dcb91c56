//! The receivers' depth for volumes to be compared with, where their own buffer will not do.

use crate::fullscreen::{UNIFORM, bind, layout};
use crate::receivers::Eye;
use crate::shader::{Shader, shader_struct};
use crate::{gpu::Gpu, passes::Passes, receivers::Receivers, view::View};
use umbrage_core::CameraView;
use umbrage_core::glam::{DMat4, DVec4};

pub(super) const DEPTH_SHADER: Shader =
    Shader::new("volume depth", include_str!("depth.wgsl")).with_layouts(&[DepthBounds::LAYOUT]);

shader_struct! {
    /// See `depth.wgsl`.
    pub(crate) struct DepthBounds {
        eye: Eye,
        light: [f32; 3],
        range_squared: f32,
        nearest: f32,
        own_near: f32,
        pad_a: f32,
        pad_b: f32,
    }
}

/// What copying depth takes.
pub(super) struct DepthCopy {
    module: wgpu::ShaderModule,
    pipeline_layout: wgpu::PipelineLayout,
    uniform: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
    pipelines: Vec<((wgpu::TextureFormat, bool), wgpu::RenderPipeline)>,
}

impl DepthBounds {
    /// Leaves out what is farther than `range` from the light, and takes depth to projection `own`.
    pub fn new(view: &View<'_>, range: Option<f64>, own: Option<&Projection>, reversed: bool) -> Self {
        let center = view.light.shape.center();
        let light = (center.truncate() - view.camera.eye) * center.w;
        Self {
            eye: Eye::new(view),
            light: light.as_vec3().to_array(),
            // A little more, so that rounding loses no lit point.
            range_squared: range.map_or(f32::INFINITY, |range| (range * range * 1.0001) as f32),
            nearest: if reversed { 1.0 } else { 0.0 },
            own_near: own.map_or(0.0, |p| p.near as f32),
            ..Self::default()
        }
    }
}

/// A projection for volumes where the camera's own would clip them: at its far plane, on adapters
/// that can't clamp depth.
pub(super) struct Projection {
    pub clip_from_world: DMat4,
    /// Depth is this over the distance along the view.
    near: f64,
}

impl Projection {
    /// `None` where the camera's own will do.
    pub fn of(camera: &CameraView, clamps: bool) -> Option<Self> {
        let far = camera.clip_from_view * DVec4::new(0.0, 0.0, -1.0, 0.0);
        let is_infinite = camera.background_depth() == 0.0 && far.z.abs() <= 1e-12 * far.w.abs();
        if clamps || is_infinite || camera.is_parallel() {
            return None;
        }
        let near_depth = if camera.background_depth() == 0.0 { 1.0 } else { 0.0 };
        let on_near = camera.clip_from_view.inverse() * DVec4::new(0.0, 0.0, near_depth, 1.0);
        let near = on_near.w.recip().abs();
        let [x, y, w] = [0, 1, 3].map(|i| camera.clip_from_view.row(i));
        let clip_from_view = DMat4::from_cols(x, y, DVec4::new(0.0, 0.0, 0.0, near), w).transpose();
        Some(Self { clip_from_world: clip_from_view * DMat4::from(camera.view_from_world), near })
    }
}

impl DepthCopy {
    pub fn new(gpu: &Gpu) -> Self {
        let own = layout(gpu, "depth bounds", wgpu::ShaderStages::FRAGMENT, &[UNIFORM]);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniform = gpu.buffer("depth bounds", &[DepthBounds::default()], usage);
        let pipeline_layout = gpu.pipeline_layout(&[Some(&Receivers::layout(gpu)), Some(&own)]);
        let bind_group = bind(gpu, "depth bounds", &own, &[uniform.as_entire_binding()]);
        Self { module: DEPTH_SHADER.module(gpu), pipeline_layout, uniform, bind_group, pipelines: Vec::new() }
    }

    pub fn prepare(&mut self, gpu: &Gpu, format: wgpu::TextureFormat, bounded: bool) {
        if self.pipelines.iter().any(|(key, _)| *key == (format, bounded)) {
            return;
        }
        let pipeline = gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("copy depth"),
            layout: Some(&self.pipeline_layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some("fullscreen"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some(if bounded { "changed_depth" } else { "copy_depth" }),
                compilation_options: Default::default(),
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        });
        self.pipelines.push(((format, bounded), pipeline));
    }

    pub fn record(
        &self,
        passes: &mut Passes<'_>,
        receivers: &Receivers,
        target: &wgpu::TextureView,
        format: wgpu::TextureFormat,
        bounds: Option<&DepthBounds>,
    ) {
        let key = (format, bounds.is_some());
        let Some((_, pipeline)) = self.pipelines.iter().find(|(k, _)| *k == key) else { return };
        if let Some(bounds) = bounds {
            passes.upload(&self.uniform, bytemuck::bytes_of(bounds));
        }
        let depth_stencil = wgpu::RenderPassDepthStencilAttachment {
            view: target,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        };
        let mut pass = passes.render("depth for volumes", &[], Some(depth_stencil));
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &receivers.bind_group, &[]);
        pass.set_bind_group(1, &self.bind_group, &[]);
        pass.draw(0..3, 0..1);
    }
}

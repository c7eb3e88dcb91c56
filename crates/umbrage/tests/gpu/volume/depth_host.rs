//! A host that draws depth only, in its own way.

use crate::common::pairs;
use umbrage::core::glam::{DMat4, DVec4};
use umbrage::core::{Camera, CameraView, Image, Scene};
use umbrage::{Casters, Error, Gpu, Receivers, Recorder, View, VisibilityTarget, find};
use wgpu::util::DeviceExt;

pub const SIZE: (u32, u32) = (160, 120);

/// Draws the depth of scenes.
pub struct Host {
    gpu: Gpu,
    depth: wgpu::Texture,
    format: wgpu::TextureFormat,
    projection: Projection,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    Finite,
    FiniteReversed,
    InfiniteReversed,
    /// Parallel lines of sight, 4 m of picture to both sides.
    Parallel,
}

impl Host {
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat, projection: Projection) -> Self {
        let depth = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("host depth"),
            size: wgpu::Extent3d { width: SIZE.0, height: SIZE.1, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        Self { gpu: gpu.clone(), depth, format, projection }
    }

    /// As `camera`, with its own projection.
    pub fn camera(&self, camera: &Camera) -> CameraView {
        let far = 30.0;
        let infinite = camera.clip_from_view(f64::from(SIZE.0) / f64::from(SIZE.1));
        // Of depth: what distance is multiplied by, and what is added.
        let (a, b) = match self.projection {
            Projection::Parallel => {
                return CameraView::from_matrices(camera.view_from_world(), parallel(camera.near, far));
            }
            Projection::Finite => (far / (camera.near - far), camera.near * far / (camera.near - far)),
            Projection::FiniteReversed => (camera.near / (far - camera.near), camera.near * far / (far - camera.near)),
            Projection::InfiniteReversed => (0.0, camera.near),
        };
        let [x, y] = [infinite.x_axis, infinite.y_axis];
        let clip_from_view = DMat4::from_cols(x, y, DVec4::new(0.0, 0.0, a, -1.0), DVec4::new(0.0, 0.0, b, 0.0));
        CameraView::from_matrices(camera.view_from_world(), clip_from_view)
    }

    fn draw(&self, encoder: &mut wgpu::CommandEncoder, scene: &Scene, camera: &Camera) {
        let clip_from_world = self.camera(camera).clip_from_world();
        let corners = scene.instances.iter().flat_map(|instance| {
            let mesh = &scene.meshes[instance.mesh];
            let clip_from_mesh = clip_from_world * DMat4::from(instance.world_from_mesh);
            mesh.indices
                .iter()
                .map(move |i| (clip_from_mesh * mesh.positions[*i as usize].as_dvec3().extend(1.0)).as_vec4())
        });
        let corners: Vec<_> = corners.collect();
        let contents = bytemuck::cast_slice(&corners);
        let descriptor = wgpu::util::BufferInitDescriptor { label: None, contents, usage: wgpu::BufferUsages::VERTEX };
        let buffer = self.gpu.device.create_buffer_init(&descriptor);
        let background = if self.is_reversed() { 0.0 } else { 1.0 };
        let store = wgpu::StoreOp::Store;
        let stencil_ops =
            self.format.has_stencil_aspect().then_some(wgpu::Operations { load: wgpu::LoadOp::Clear(7), store });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth.create_view(&Default::default()),
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(background), store }),
                stencil_ops,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline());
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..corners.len() as u32, 0..1);
    }

    fn is_reversed(&self) -> bool {
        matches!(self.projection, Projection::FiniteReversed | Projection::InfiniteReversed)
    }

    fn pipeline(&self) -> wgpu::RenderPipeline {
        let source = "@vertex fn vertex(@location(0) clip: vec4f) -> @builtin(position) vec4f { return clip; }";
        let source = wgpu::ShaderSource::Wgsl(source.into());
        let module = &self.gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let compare = if self.is_reversed() { wgpu::CompareFunction::Greater } else { wgpu::CompareFunction::Less };
        let attributes = &wgpu::vertex_attr_array![0 => Float32x4];
        let step_mode = wgpu::VertexStepMode::Vertex;
        let buffers = &[Some(wgpu::VertexBufferLayout { array_stride: 16, step_mode, attributes })];
        self.gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("host depth"),
            layout: None,
            vertex: wgpu::VertexState { module, entry_point: None, compilation_options: Default::default(), buffers },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: self.format,
                depth_write_enabled: Some(true),
                depth_compare: Some(compare),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        })
    }

    /// The visibility of the scene's light.
    pub fn visibility(
        &self,
        scene: &Scene,
        camera: &Camera,
        set: &str,
        lends_stencil: bool,
    ) -> Result<Image<f32>, Error> {
        let aspect = wgpu::TextureAspect::DepthOnly;
        let depth = self.depth.create_view(&wgpu::TextureViewDescriptor { aspect, ..Default::default() });
        let mut receivers = Receivers::new(&self.gpu, &depth, None, SIZE)?;
        if lends_stencil {
            receivers = receivers.with_stencil(&self.depth.create_view(&Default::default()))?;
        }
        let casters = Casters::new(&self.gpu, scene)?;
        let visibility = VisibilityTarget::new(&self.gpu, SIZE.0, SIZE.1)?;
        let info = find("volume")?;
        let mut technique = info.settings(&pairs(set))?.make(&self.gpu)?;
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.draw(&mut encoder, scene, camera);
        let light = &scene.lights[0];
        let view = View { camera: self.camera(camera), receivers: &receivers, casters: &casters, light, textures: &[] };
        let prepared = technique.prepare(&self.gpu, &view)?;
        let mut recorder = Recorder::new(&self.gpu);
        let mut passes = recorder.begin(&mut encoder);
        prepared.record(&mut passes, &visibility)?;
        passes.finish();
        self.gpu.queue.submit([encoder.finish()]);
        visibility.read(&self.gpu)
    }
}

fn parallel(near: f64, far: f64) -> DMat4 {
    let [width, height] = [1.0 / 4.0, 1.0 / 3.0];
    DMat4::from_cols(
        DVec4::X * width,
        DVec4::Y * height,
        DVec4::Z / (near - far),
        DVec4::new(0.0, 0.0, near / (near - far), 1.0),
    )
}

//! What hosts can do wrong, and what can befall them: a right picture or an error that says what to
//! do, and nothing that stays wrong.

mod lights;
mod loss;
mod order;

use crate::common::pairs;
use std::sync::{Arc, Mutex};
use umbrage::core::glam::DVec3;
use umbrage::core::{Camera, CameraView, Image, Scene};
use umbrage::{Casters, Error, Gpu, Receivers, Recorder, Technique, View, VisibilityTarget, find};

const SIZE: (u32, u32) = (96, 72);

/// Height of the eye, which looks straight down at a floor.
const HEIGHT: f64 = 9.0;

/// An engine with a device of its own and one light, of which everything visible is a floor.
struct Host {
    gpu: Gpu,
    /// What the driver told the engine.
    complaints: Arc<Mutex<Vec<String>>>,
    scene: Scene,
    casters: Casters,
    receivers: Receivers,
    technique: Box<dyn Technique>,
    recorder: Recorder,
    camera: CameraView,
    target: VisibilityTarget,
    /// What befalls it between preparing and recording.
    between: Option<Box<dyn FnOnce()>>,
}

/// A device without features, at the default limits; errors go to a list.
fn device() -> (wgpu::Device, wgpu::Queue, Arc<Mutex<Vec<String>>>) {
    let (device, queue) = pollster::block_on(async {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = instance.request_adapter(&Default::default()).await.unwrap();
        adapter.request_device(&Default::default()).await.unwrap()
    });
    let complaints = Arc::new(Mutex::new(Vec::new()));
    let kept = complaints.clone();
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| kept.lock().unwrap().push(error.to_string())));
    (device, queue, complaints)
}

impl Host {
    fn new(scene: &Scene, id: &str, set: &str) -> Self {
        let (device, queue, complaints) = device();
        Self::on(Gpu::new(device, queue), complaints, scene, id, set).unwrap()
    }

    fn on(gpu: Gpu, complaints: Arc<Mutex<Vec<String>>>, scene: &Scene, id: &str, set: &str) -> Result<Self, Error> {
        Ok(Self {
            casters: Casters::new(&gpu, scene)?,
            receivers: Receivers::new(&gpu, &floor(&gpu), None, SIZE)?,
            technique: find(id)?.settings(&pairs(set))?.make(&gpu)?,
            recorder: Recorder::new(&gpu),
            camera: camera().view(SIZE.0, SIZE.1),
            target: VisibilityTarget::new(&gpu, SIZE.0, SIZE.1)?,
            scene: scene.clone(),
            complaints,
            between: None,
            gpu,
        })
    }

    /// Moves what bends to where it is after so many seconds.
    fn pose(&mut self, seconds: f64) {
        self.scene.advance(seconds);
        for (number, instance) in self.scene.instances.iter().enumerate() {
            if let Some(joints) = self.scene.joints(instance) {
                self.casters.set_pose(self.casters.instance(number).unwrap(), &joints).unwrap();
            }
        }
    }

    /// Records a frame without submitting it.
    fn record(&mut self) -> Result<wgpu::CommandEncoder, Error> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut passes = self.recorder.begin(&mut encoder);
        self.casters.record(&mut passes)?;
        let view = View {
            camera: self.camera,
            receivers: &self.receivers,
            casters: &self.casters,
            light: &self.scene.lights[0],
            textures: &[],
        };
        let prepared = self.technique.prepare(&self.gpu, &view)?;
        self.between.take().into_iter().for_each(|befall| befall());
        prepared.record(&mut passes, &self.target)?;
        passes.finish();
        Ok(encoder)
    }

    fn submit(&self, encoder: wgpu::CommandEncoder) {
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Draws a frame and reads it back.
    fn frame(&mut self) -> Image<f32> {
        let encoder = self.record().unwrap();
        self.submit(encoder);
        self.target.read(&self.gpu).unwrap()
    }

    /// Fails where the driver told the engine anything.
    fn assert_quiet(&self) {
        let complaints = self.complaints.lock().unwrap();
        assert!(complaints.is_empty(), "{complaints:?}");
    }
}

fn camera() -> Camera {
    let eye = DVec3::new(0.0, HEIGHT, 0.0);
    Camera { eye, target: DVec3::ZERO, up: DVec3::NEG_Z, fov_y_deg: 50.0, ..Camera::default() }
}

/// The depth of the plane y = 0 as [`camera`] sees it.
fn floor(gpu: &Gpu) -> wgpu::TextureView {
    let depth = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("depth of a floor"),
        size: wgpu::Extent3d { width: SIZE.0, height: SIZE.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let view = depth.create_view(&Default::default());
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let load = wgpu::LoadOp::Clear((camera().near / HEIGHT) as f32);
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &view,
            depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    gpu.queue.submit([encoder.finish()]);
    view
}

/// The largest difference of two pictures.
fn difference(a: &Image<f32>, b: &Image<f32>) -> f32 {
    a.data.iter().zip(&b.data).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

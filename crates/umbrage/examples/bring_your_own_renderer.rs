//! A host engine with its own device, depth buffer and camera gets the visibility of a light from
//! umbrage.
//!
//!     cargo run -p umbrage --example bring_your_own_renderer
//!
//! The "engine" draws a turning box over a floor into a depth buffer of its own, finite and not
//! reversed, and asks for the shadow of one light. It prints how much is lit in a few frames.

use umbrage::core::glam::{DAffine3, DMat4, DVec3, DVec4};
use umbrage::core::{CameraView, Light, LightShape, Material, Scene, primitive};
use umbrage::depth_maps::Kernel;
use umbrage::techniques::pcf::Pcf;
use umbrage::{Casters, Configure, Gpu, Receivers, Recorder, View, VisibilityTarget};
use wgpu::util::DeviceExt;

const SIZE: (u32, u32) = (640, 480);

/// The host's own depth pass: it knows nothing of umbrage.
const HOST_SHADER: &str = "@vertex fn vertex(@location(0) clip: vec4f) -> @builtin(position) vec4f { return clip; }";

/// Four frames.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    frames(4).map(|_| ())
}

/// Renders frames and returns the visibility of the last one.
pub fn frames(count: u32) -> Result<umbrage::core::Image<f32>, Box<dyn std::error::Error>> {
    // The host's device and depth buffer.
    let (device, queue) = pollster::block_on(async {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = instance.request_adapter(&Default::default()).await?;
        Ok::<_, Box<dyn std::error::Error>>(adapter.request_device(&Default::default()).await?)
    })?;
    let depth = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("host depth"),
        size: wgpu::Extent3d { width: SIZE.0, height: SIZE.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let depth = depth.create_view(&Default::default());
    let host = HostDepthPass::new(&device);

    // The host's scene, as casters: two meshes and where they are.
    let mut scene = Scene::default();
    let (floor, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let material = scene.add_material(Material::default());
    scene.place(floor, material, DAffine3::from_scale(DVec3::splat(8.0)));
    scene.place(cube, material, DAffine3::from_translation(DVec3::Y));
    let light = Light::new(LightShape::Point { position: DVec3::new(1.0, 4.0, 1.5) });

    // umbrage, once.
    let gpu = Gpu::new(device.clone(), queue.clone());
    let mut casters = Casters::new(&gpu, &scene)?;
    let moving = casters.instance(1).ok_or("the cube is instance 1 of the scene")?;
    let receivers = Receivers::new(&gpu, &depth, None, SIZE)?;
    let visibility = VisibilityTarget::new(&gpu, SIZE.0, SIZE.1)?;
    let mut technique = Pcf { kernel: Kernel::Square5, ..Default::default() }.make(&gpu)?;
    let mut recorder = Recorder::new(&gpu);
    for frame in 0..count {
        // The host moves things and draws its depth.
        let turned = DAffine3::from_translation(DVec3::Y) * DAffine3::from_rotation_y(0.4 * f64::from(frame));
        scene.instances[1].world_from_mesh = turned;
        let mut encoder = device.create_command_encoder(&Default::default());
        host.record(&device, &mut encoder, &depth, &scene);

        // umbrage: what has changed, then the light's visibility, in the same encoder.
        casters.move_instance(moving, &turned)?;
        let mut passes = recorder.begin(&mut encoder);
        casters.record(&mut passes)?;
        let view =
            View { camera: host_camera(), receivers: &receivers, casters: &casters, light: &light, textures: &[] };
        let prepared = technique.prepare(&gpu, &view)?;
        prepared.record(&mut passes, &visibility)?;
        passes.finish();
        queue.submit([encoder.finish()]);

        // Now the host would shade with `visibility.view`.
        let seen = visibility.read(&gpu)?.data;
        println!("frame {frame}: mean visibility {:.4}", seen.iter().sum::<f32>() / seen.len() as f32);
    }
    Ok(visibility.read(&gpu)?)
}

/// The host's camera: any view and projection matrices do.
fn host_camera() -> CameraView {
    let camera = umbrage::core::Camera { eye: DVec3::new(0.0, 5.0, 6.0), ..Default::default() };
    let (near, far, f) = (0.1, 100.0, 2.0);
    let clip_from_view = DMat4::from_cols(
        DVec4::new(f * f64::from(SIZE.1) / f64::from(SIZE.0), 0.0, 0.0, 0.0),
        DVec4::new(0.0, f, 0.0, 0.0),
        DVec4::new(0.0, 0.0, far / (near - far), -1.0),
        DVec4::new(0.0, 0.0, near * far / (near - far), 0.0),
    );
    CameraView::from_matrices(camera.view_from_world(), clip_from_view)
}

struct HostDepthPass(wgpu::RenderPipeline);

impl HostDepthPass {
    fn new(device: &wgpu::Device) -> Self {
        let source = wgpu::ShaderSource::Wgsl(HOST_SHADER.into());
        let module = &device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let attributes = &wgpu::vertex_attr_array![0 => Float32x4];
        let step_mode = wgpu::VertexStepMode::Vertex;
        let buffers = &[Some(wgpu::VertexBufferLayout { array_stride: 16, step_mode, attributes })];
        let depth = wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: Default::default(),
            bias: Default::default(),
        };
        Self(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("host depth"),
            layout: None,
            vertex: wgpu::VertexState { module, entry_point: None, compilation_options: Default::default(), buffers },
            primitive: Default::default(),
            depth_stencil: Some(depth),
            multisample: Default::default(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        }))
    }

    fn record(&self, device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder, view: &wgpu::TextureView, s: &Scene) {
        let corners = s.instances.iter().flat_map(|instance| {
            let mesh = &s.meshes[instance.mesh];
            let clip_from_mesh = host_camera().clip_from_world() * DMat4::from(instance.world_from_mesh);
            let clip = move |&i: &u32| clip_from_mesh * mesh.positions[i as usize].as_dvec3().extend(1.0);
            mesh.indices.iter().map(move |i| clip(i).as_vec4())
        });
        let (contents, usage) = (corners.collect::<Vec<_>>(), wgpu::BufferUsages::VERTEX);
        let contents = bytemuck::cast_slice(&contents);
        let corners = device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage });
        let depth_ops = Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops,
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.0);
        pass.set_vertex_buffer(0, corners.slice(..));
        pass.draw(0..contents.len() as u32 / 16, 0..1);
    }
}

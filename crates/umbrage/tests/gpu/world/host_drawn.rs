//! Casters that the host draws into maps cast the shadows of meshes of the same shape.

use crate::common::gpu;
use std::sync::Arc;
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Bounds, Camera, Image, Light, LightShape, Material, Scene, primitive};
use umbrage::{CasterView, Error, Gpu, HostCasters, Needs, TechniqueInfo, techniques};
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (64, 48);
const SHADER: &str = "@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;
@vertex fn vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return clip_from_world * vec4f(position, 1.0);
}";

/// A host's own pipeline and vertices, relative to the origin of the casters.
struct Own {
    pipeline: wgpu::RenderPipeline,
    corners: wgpu::Buffer,
    count: u32,
}

impl Own {
    fn new(gpu: &Gpu, place: &DAffine3, origin: DVec3) -> Self {
        let mesh = primitive::cube();
        let at = |i: &u32| place.transform_point3(mesh.positions[*i as usize].as_dvec3()) - origin;
        let corners: Vec<[f32; 3]> = mesh.indices.iter().map(|i| at(i).as_vec3().to_array()).collect();
        let source = wgpu::ShaderSource::Wgsl(SHADER.into());
        let module = &gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let group = CasterView::layout(gpu);
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            bind_group_layouts: &[Some(&group)],
            ..Default::default()
        });
        let attributes = &wgpu::vertex_attr_array![0 => Float32x3];
        let step_mode = wgpu::VertexStepMode::Vertex;
        let buffers = &[Some(wgpu::VertexBufferLayout { array_stride: 12, step_mode, attributes })];
        let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&layout),
            vertex: wgpu::VertexState { module, entry_point: None, compilation_options: Default::default(), buffers },
            primitive: Default::default(),
            depth_stencil: Some(CasterView::depth_stencil()),
            multisample: Default::default(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        });
        let count = corners.len() as u32;
        Self { pipeline, corners: gpu.buffer("the host's", &corners, wgpu::BufferUsages::VERTEX), count }
    }
}

impl HostCasters for Own {
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _: &CasterView<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_vertex_buffer(0, self.corners.slice(..));
        pass.draw(0..self.count, 0..1);
    }
}

/// A floor, and a block above it that the camera does not see.
fn scene(shape: LightShape) -> (Scene, DAffine3) {
    let mut scene = Scene { lights: vec![Light::new(shape)], ..Scene::default() };
    let (floor, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let material = scene.add_material(Material::default());
    scene.place(floor, material, DAffine3::from_scale(DVec3::splat(12.0)));
    let place = DAffine3::from_translation(DVec3::new(0.0, 5.0, 0.0)) * DAffine3::from_rotation_y(0.4);
    scene.place(cube, material, place).receives = false;
    scene.camera = Camera { eye: DVec3::new(0.0, 3.0, 5.0), target: DVec3::ZERO, ..Camera::default() };
    (scene, place)
}

fn renderer(gpu: &Gpu, scene: &Scene, info: &'static TechniqueInfo) -> Renderer {
    let set: &[_] = if info.family.has_maps() { &[("size".into(), "128".into())] } else { &[] };
    let technique = info.settings(set).unwrap().make(gpu).unwrap();
    Renderer::new(gpu, scene, SIZE.0, SIZE.1, vec![LightPass { light: 0, technique }]).unwrap()
}

fn seen(renderer: &mut Renderer, scene: &Scene) -> Result<Image<f32>, Error> {
    renderer.frame(&scene.camera)?;
    renderer.visibility(0)
}

#[test]
fn what_a_host_draws_casts_the_shadow_of_a_mesh_or_is_refused() {
    let gpu = gpu();
    let shapes = [
        LightShape::Point { position: DVec3::new(0.5, 9.0, 0.5) },
        LightShape::Directional { direction: DVec3::new(0.1, -1.0, 0.2).normalize(), angle_deg: 0.0 },
    ];
    for info in techniques() {
        for shape in shapes.iter().filter(|shape| info.lights.contains(shape.kind())) {
            let (scene, place) = scene(shape.clone());
            let mut meshes = renderer(&gpu, &scene, info);
            let mut own = renderer(&gpu, &scene, info);
            let block = own.casters().instance(1).unwrap();
            own.casters_mut().remove(block).unwrap();
            let origin = meshes.casters().origin();
            let bounds = primitive::cube().bounds().transformed(&place);
            let drawn = Arc::new(Own::new(&gpu, &place, origin));
            own.casters_mut().set_host_casters(Some((bounds, drawn))).unwrap();
            let (wanted, got) = (seen(&mut meshes, &scene).unwrap(), seen(&mut own, &scene));
            let name = format!("{} under {:?}", info.id, shape.kind());
            if !matches!(info.casters, Needs::Depth | Needs::Nothing) {
                let text = got.err().map(|e| e.to_string()).unwrap_or_default();
                assert!(text.contains("casters that the host draws"), "{name}: {text}");
                continue;
            }
            let got = got.unwrap_or_else(|e| panic!("{name}: {e}"));
            let off = wanted.data.iter().zip(&got.data).filter(|(a, b)| (*a - *b).abs() > 0.02).count();
            assert!(off <= 2, "{name}: {off} pixels differ");
            let again = seen(&mut own, &scene).unwrap();
            assert!(again.data == got.data, "{name}: a map that is kept");
            let dark = got.data.iter().filter(|v| **v < 0.5).count();
            assert!(dark > 30 || info.casters == Needs::Nothing, "{name}: {dark} dark pixels");
            own.casters_mut().set_host_casters(None).unwrap();
            let without = seen(&mut own, &scene).unwrap();
            assert!(without.data.iter().all(|v| *v > 0.99), "{name}: the shadow goes with its caster");
        }
    }
    let mut casters = umbrage::Casters::empty(&gpu).unwrap();
    let nowhere = Arc::new(Own::new(&gpu, &DAffine3::IDENTITY, DVec3::ZERO));
    assert!(casters.set_host_casters(Some((Bounds::EMPTY, nowhere))).is_err());
}

//! A host that draws depth alone, in its own way, and what the ray tracer says of the same view.

use umbrage::core::glam::{DAffine3, DMat3, DMat4, DVec3, DVec4};
use umbrage::core::{Camera, CameraView, Image, Light, LightShape, Material, Scene, primitive};
use umbrage::{Casters, Error, Gpu, Passes, Receivers, Recorder, Settings, Technique, View, VisibilityTarget, find};
use umbrage_metrics::discontinuities;
use umbrage_reference::{Options, Tracer};
use wgpu::util::DeviceExt;

/// Of most pictures.
pub const SIZE: (u32, u32) = (96, 72);

/// The adapter that is asked for, or the best one.
pub fn gpu() -> Gpu {
    let chosen = std::env::var("UMBRAGE_ADAPTER").ok();
    Gpu::request(chosen.as_deref()).unwrap_or_else(|e| panic!("this test needs a graphics adapter: {e}"))
}

/// A floor with a cube and a sphere on it, and one light above.
pub fn scene(shape: LightShape) -> Scene {
    let mut scene = Scene::default();
    let meshes = [primitive::plane(), primitive::cube(), primitive::sphere(24, 16)];
    let [floor, cube, sphere] = meshes.map(|mesh| scene.add_mesh(mesh));
    let material = scene.add_material(Material::default());
    scene.place(floor, material, DAffine3::from_scale(DVec3::splat(8.0)));
    let turned = DAffine3::from_translation(DVec3::new(-0.6, 0.5, 0.0)) * DAffine3::from_rotation_y(0.4);
    scene.place(cube, material, turned);
    let raised = DAffine3::from_translation(DVec3::new(0.9, 0.9, 0.3));
    scene.place(sphere, material, raised * DAffine3::from_mat3(DMat3::from_diagonal(DVec3::splat(0.5))));
    scene.camera =
        Camera { eye: DVec3::new(0.4, 3.0, 4.0), target: DVec3::new(0.2, 0.3, 0.0), near: 0.1, ..Camera::default() };
    scene.lights.push(Light::new(shape));
    scene
}

/// Where the light is.
pub const LAMP: DVec3 = DVec3::new(1.5, 4.0, 1.0);

/// A light that all techniques take.
pub fn point() -> LightShape {
    LightShape::Point { position: LAMP }
}

/// Depth as `draw` leaves it.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    pub view: &'a wgpu::TextureView,
    pub samples: u32,
    /// Corner and size in the target; what is around it is filled with nonsense.
    pub part: Option<[u32; 4]>,
    /// WGSL of the depth that is stored for `clip`, the position before division.
    pub stored: Option<&'a str>,
    /// Packed normals.
    pub normal: Option<&'a wgpu::TextureView>,
}

/// A depth buffer that can be drawn to and read.
pub fn depth_texture(gpu: &Gpu, size: (u32, u32), samples: u32, layers: u32) -> wgpu::Texture {
    texture(gpu, FORMAT, size, samples, layers)
}

/// A texture that can be drawn to, read in shaders and copied from.
pub fn texture(gpu: &Gpu, format: wgpu::TextureFormat, size: (u32, u32), samples: u32, layers: u32) -> wgpu::Texture {
    let copied = if samples == 1 { wgpu::TextureUsages::COPY_SRC } else { wgpu::TextureUsages::empty() };
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("host depth"),
        size: wgpu::Extent3d { width: size.0, height: size.1, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: copied | wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

/// The geometric normal of a triangle that casts, turned to the camera.
fn facing(camera: &CameraView, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let normal = (b - a).cross(c - a).normalize_or(DVec3::Y);
    let sight = if camera.is_parallel() { camera.forward() } else { a - camera.eye };
    if normal.dot(sight) > 0.0 { -normal } else { normal }
}

/// As `pack_normal` does it.
fn packed(n: DVec3) -> u32 {
    let flat = n / n.abs().element_sum();
    let sign = |x: f64| if x >= 0.0 { 1.0 } else { -1.0 };
    let folded = [(1.0 - flat.y.abs()) * sign(flat.x), (1.0 - flat.x.abs()) * sign(flat.y)];
    let [x, y] = if flat.z >= 0.0 { [flat.x, flat.y] } else { folded };
    let snorm = |v: f64| u32::from((v.clamp(-1.0, 1.0) * 32767.0).round() as i16 as u16);
    ((snorm(x) | snorm(y) << 16) & !1) | 1
}

pub const NORMAL: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// One layer of it.
pub fn layer(texture: &wgpu::Texture, layer: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

impl<'a> Target<'a> {
    pub fn of(view: &'a wgpu::TextureView) -> Self {
        Self { view, samples: 1, part: None, stored: None, normal: None }
    }

    /// Draws the depth of what `camera` sees.
    pub fn draw(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, scene: &Scene, camera: &CameraView) {
        let clip_from_world = camera.clip_from_world();
        let corners = scene.instances.iter().flat_map(|instance| {
            let mesh = scene.posed_mesh(instance);
            let place = |i: u32| instance.world_from_mesh.transform_point3(mesh.positions[i as usize].as_dvec3());
            let corners = mesh.triangles().flat_map(|t| {
                let corners = t.map(place);
                let normal = packed(facing(camera, corners));
                corners.map(|p| (clip_from_world * p.extend(1.0), normal))
            });
            corners.collect::<Vec<_>>()
        });
        let background = camera.background_depth();
        // A part is filled with the background by two triangles first.
        let square = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
        let fill = square.map(|(x, y)| (DVec4::new(x, y, background.into(), 1.0), 0));
        let bits = |(p, normal): (DVec4, u32)| {
            let [x, y, z, w] = p.as_vec4().to_array().map(f32::to_bits);
            [x, y, z, w, normal]
        };
        let corners: Vec<[u32; 5]> = fill.into_iter().chain(corners).map(bits).collect();
        let contents = bytemuck::cast_slice(&corners);
        let descriptor = wgpu::util::BufferInitDescriptor { label: None, contents, usage: wgpu::BufferUsages::VERTEX };
        let buffer = gpu.device.create_buffer_init(&descriptor);
        let empty = if self.stored.is_some() { 1.0 } else { background };
        let clear = if self.part.is_some() { 0.3 } else { empty };
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store };
        let color = |view| wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops };
        let colors: Vec<_> = self.normal.map(|view| Some(color(view))).into_iter().collect();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &colors,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: self.view,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        if let Some([x, y, w, h]) = self.part {
            pass.set_viewport(x as f32, y as f32, w as f32, h as f32, 0.0, 1.0);
            pass.set_scissor_rect(x, y, w, h);
        }
        pass.set_vertex_buffer(0, buffer.slice(..));
        if self.part.is_some() {
            pass.set_pipeline(&self.pipeline(gpu, wgpu::CompareFunction::Always));
            pass.draw(0..6, 0..1);
        }
        let is_reversed = background == 0.0 && self.stored.is_none();
        let nearer = if is_reversed { wgpu::CompareFunction::Greater } else { wgpu::CompareFunction::Less };
        pass.set_pipeline(&self.pipeline(gpu, nearer));
        pass.draw(6..corners.len() as u32, 0..1);
    }

    fn pipeline(&self, gpu: &Gpu, compare: wgpu::CompareFunction) -> wgpu::RenderPipeline {
        let source = format!(
            "struct Corner {{
                @builtin(position) position: vec4f,
                @location(0) clip: vec4f,
                @location(1) @interpolate(flat) normal: u32,
            }}
            @vertex fn vertex(@location(0) clip: vec4f, @location(1) normal: u32) -> Corner {{
                return Corner(clip, clip, normal);
            }}
            fn stored(clip: vec4f) -> f32 {{ {} }}
            @fragment fn depth(in: Corner) -> @builtin(frag_depth) f32 {{ return stored(in.clip); }}
            @fragment fn normal(in: Corner) -> @location(0) u32 {{ return in.normal; }}",
            self.stored.unwrap_or("return 0.0;")
        );
        let source = wgpu::ShaderSource::Wgsl(source.into());
        let module = &gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let attributes = &wgpu::vertex_attr_array![0 => Float32x4, 1 => Uint32];
        let step_mode = wgpu::VertexStepMode::Vertex;
        let buffers = &[Some(wgpu::VertexBufferLayout { array_stride: 20, step_mode, attributes })];
        let targets: Vec<_> = self.normal.map(|_| Some(NORMAL.into())).into_iter().collect();
        let compilation_options = wgpu::PipelineCompilationOptions::default();
        let fragment = wgpu::FragmentState {
            module,
            entry_point: Some(if self.normal.is_some() { "normal" } else { "depth" }),
            compilation_options: compilation_options.clone(),
            targets: &targets,
        };
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("host depth"),
            layout: None,
            vertex: wgpu::VertexState { module, entry_point: Some("vertex"), compilation_options, buffers },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(compare),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState { count: self.samples, ..Default::default() },
            fragment: (self.stored.is_some() || self.normal.is_some()).then_some(fragment),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// A technique by its name and settings, `pcf:size=512`; maps of 512 texels where it has maps.
pub fn technique(gpu: &Gpu, id: &str) -> Box<dyn Technique> {
    settings(id).make(gpu).unwrap_or_else(|e| panic!("{id}: {e}"))
}

fn settings(id: &str) -> Settings {
    let info = find(id).unwrap_or_else(|e| panic!("{e}"));
    let has_resolution = info.params().iter().any(|p| p.name == "resolution");
    let set: Vec<_> = has_resolution.then(|| ("resolution".to_string(), "512".to_string())).into_iter().collect();
    info.settings(&set).unwrap_or_else(|e| panic!("{id}: {e}"))
}

/// Visibility of the scene's first light for receivers that are drawn or made in `passes`.
pub fn visibility(
    gpu: &Gpu,
    technique: &mut dyn Technique,
    passes: &mut Passes<'_>,
    scene: &Scene,
    (camera, receivers): (&CameraView, &Receivers),
) -> Result<VisibilityTarget, Error> {
    let mut casters = Casters::new(gpu, scene)?;
    casters.record(passes)?;
    let target = VisibilityTarget::new(gpu, receivers.size.0, receivers.size.1)?;
    let light = &scene.lights[0];
    let view = View { camera: *camera, receivers, casters: &casters, light, textures: &[] };
    technique.prepare(gpu, &view)?.record(passes, &target)?;
    Ok(target)
}

/// Records in an encoder of its own and submits that.
pub fn frame<T>(gpu: &Gpu, record: impl FnOnce(&mut Passes<'_>) -> T) -> T {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut recorder = Recorder::new(gpu);
    let mut passes = recorder.begin(&mut encoder);
    let made = record(&mut passes);
    passes.finish();
    gpu.queue.submit([encoder.finish()]);
    made
}

/// Draws depth, and normals where `has_normals`, and finds the visibility of the first light.
pub fn seen(
    gpu: &Gpu,
    technique: &mut dyn Technique,
    scene: &Scene,
    camera: &CameraView,
    size: (u32, u32),
    has_normals: bool,
) -> Result<Image<f32>, Error> {
    let depth = layer(&depth_texture(gpu, size, 1, 1), 0);
    let normal = has_normals.then(|| layer(&texture(gpu, NORMAL, size, 1, 1), 0));
    let receivers = Receivers::new(gpu, &depth, normal.as_ref(), size)?;
    let target = Target { normal: normal.as_ref(), ..Target::of(&depth) };
    let made = frame(gpu, |passes| {
        target.draw(gpu, passes.encoder(), scene, camera);
        visibility(gpu, technique, passes, scene, (camera, &receivers))
    });
    made?.read(gpu)
}

/// What the ray tracer says, and where it counts.
pub struct Truth {
    pub visibility: Image<f32>,
    pub mask: Image<bool>,
}

impl Truth {
    pub fn of(scene: &Scene, camera: &Camera, size: (u32, u32)) -> Self {
        let tracer = Tracer::new(scene);
        let geometry = tracer.geometry(camera, size.0, size.1);
        let is_hard = matches!(scene.lights[0].shape, LightShape::Point { .. } | LightShape::Directional { .. });
        let options = Options { samples: if is_hard { 1 } else { 256 }, ..Options::default() };
        let truth = tracer.visibility(&geometry, &scene.lights[0], &[], &options, &|_, _| ());
        let beside_edges = discontinuities(&geometry.depth, &geometry.model);
        let mask = Image::from_fn(size.0, size.1, |x, y| truth.scored[(x, y)] && !beside_edges[(x, y)]);
        assert!(mask.data.iter().filter(|scored| **scored).count() * 3 > mask.data.len(), "too little is compared");
        Self { visibility: truth.visibility, mask }
    }

    /// As a camera sees it whose picture is mirrored.
    pub fn mirrored(&self, [across, down]: [bool; 2]) -> Self {
        let (w, h) = self.mask.size();
        let at = |x: u32, y: u32| (if across { w - 1 - x } else { x }, if down { h - 1 - y } else { y });
        Self {
            visibility: Image::from_fn(w, h, |x, y| self.visibility[at(x, y)]),
            mask: Image::from_fn(w, h, |x, y| self.mask[at(x, y)]),
        }
    }

    /// Mean error where edges of hard shadows move as far as the rasteriser may shift them.
    pub fn shifted(&self, gpu: &Gpu) -> f64 {
        let (w, h) = self.mask.size();
        let steps = |x: u32, y: u32| {
            let beside = [(x + 1, y), (x, y + 1)].into_iter().filter(|&(x, y)| x < w && y < h);
            beside.filter(|at| self.visibility[*at] != self.visibility[(x, y)]).count()
        };
        let places = (0..h).flat_map(|y| (0..w).map(move |x| (x, y))).filter(|at| self.mask[*at]);
        let (count, sum) = places.fold((0_u32, 0), |(count, sum), (x, y)| (count + 1, sum + steps(x, y)));
        f64::from(gpu.snapping()) * sum as f64 / f64::from(count)
    }

    /// Mean absolute error of a picture.
    pub fn error(&self, seen: &Image<f32>) -> f64 {
        assert_eq!(seen.size(), self.mask.size());
        let pixels = seen.data.iter().zip(&self.visibility.data).zip(&self.mask.data).filter(|(_, scored)| **scored);
        let (mut sum, mut count) = (0.0, 0_u32);
        for ((a, b), _) in pixels {
            assert!((0.0..=1.0).contains(a), "{a} is no visibility");
            (sum, count) = (sum + f64::from((a - b).abs()), count + 1);
        }
        sum / f64::from(count)
    }
}

/// A perspective projection of `camera` between two planes.
pub fn finite(camera: &Camera, size: (u32, u32), [near, far]: [f64; 2], is_reversed: bool) -> CameraView {
    let infinite = camera.clip_from_view(f64::from(size.0) / f64::from(size.1));
    let (a, b) = if is_reversed {
        (near / (far - near), near * far / (far - near))
    } else {
        (far / (near - far), near * far / (near - far))
    };
    let [x, y] = [infinite.x_axis, infinite.y_axis];
    let clip_from_view = DMat4::from_cols(x, y, DVec4::new(0.0, 0.0, a, -1.0), DVec4::new(0.0, 0.0, b, 0.0));
    CameraView::from_matrices(camera.view_from_world(), clip_from_view)
}

/// The other way round in depth.
pub fn turned(view: &CameraView) -> CameraView {
    let flip = DMat4::from_cols(DVec4::X, DVec4::Y, DVec4::NEG_Z, DVec4::new(0.0, 0.0, 1.0, 1.0));
    CameraView { clip_from_view: flip * view.clip_from_view, ..*view }
}

/// With its picture mirrored.
pub fn mirrored(view: &CameraView, [across, down]: [bool; 2]) -> CameraView {
    let sign = |is: bool| if is { -1.0 } else { 1.0 };
    let flip = DMat4::from_scale(DVec3::new(sign(across), sign(down), 1.0));
    CameraView { clip_from_view: flip * view.clip_from_view, ..*view }
}

//! A host that shades forward: it draws depth and normals, then the same triangles once more with
//! the look-ups of lights in its own shader.

use umbrage::core::glam::{DMat4, Vec3};
use umbrage::core::{Camera, Image, Light, Scene};
use umbrage::fullscreen::{attachment, target_texture};
use umbrage::{Casters, Gpu, Inline, Lent, Passes, Receivers, Recorder, Technique, View, VisibilityTarget, read};
use wgpu::util::DeviceExt;

pub const SIZE: (u32, u32) = (96, 72);

const SHADER: &str = include_str!("forward.wgsl");

/// What is not covered by anything.
pub const NOTHING: f32 = 2.0;

/// What a frame shows.
pub struct Frame {
    /// Of each light, what the technique's own pass says.
    pub full_screen: Vec<Image<f32>>,
    /// What the host's shader says.
    pub inline: Image<f32>,
    /// What that shader has of the library.
    pub lookups: Inline,
}

pub struct Host {
    pub gpu: Gpu,
    pub scene: Scene,
    pub casters: Casters,
    pub receivers: Receivers,
    /// No full-screen pass is recorded.
    pub only_maps: bool,
    depth: wgpu::TextureView,
    normals: wgpu::TextureView,
    target: wgpu::Texture,
    frame: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    gbuffer: wgpu::RenderPipeline,
    recorder: Recorder,
}

impl Host {
    pub fn new(gpu: &Gpu, scene: &Scene) -> Self {
        let texture = |label, format| target_texture(gpu, label, SIZE, 1, format);
        let [depth, normals] = [wgpu::TextureFormat::Depth32Float, wgpu::TextureFormat::R32Uint]
            .map(|format| texture("host", format).create_view(&Default::default()));
        let layout = umbrage::fullscreen::layout(
            gpu,
            "host",
            wgpu::ShaderStages::VERTEX_FRAGMENT,
            &[umbrage::fullscreen::UNIFORM],
        );
        let frame = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            scene: scene.clone(),
            casters: Casters::new(gpu, scene).unwrap(),
            receivers: Receivers::new(gpu, &depth, Some(&normals), SIZE).unwrap(),
            only_maps: false,
            target: texture("inline", wgpu::TextureFormat::R32Float),
            frame: gpu.buffer("host frame", &[0f32; 20], frame),
            gbuffer: pipeline(gpu, "", "packed", wgpu::TextureFormat::R32Uint, &[&layout]),
            recorder: Recorder::new(gpu),
            gpu: gpu.clone(),
            depth,
            normals,
            layout,
        }
    }

    /// Triangles relative to the eye, each corner with the triangle's normal.
    fn vertices(&self, camera: &Camera) -> Vec<[Vec3; 2]> {
        let mut vertices = Vec::new();
        for instance in &self.scene.instances {
            let mesh = &self.scene.meshes[instance.mesh];
            for triangle in mesh.indices.chunks_exact(3) {
                let corner = |i: usize| {
                    let p = mesh.positions[triangle[i] as usize].as_dvec3();
                    instance.world_from_mesh.transform_point3(p) - camera.eye
                };
                let corners = [0, 1, 2].map(corner);
                let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
                vertices.extend(corners.map(|p| [p.as_vec3(), normal.as_vec3()]));
            }
        }
        vertices
    }

    fn pass<'e>(
        &self,
        passes: &'e mut Passes<'_>,
        color: &wgpu::TextureView,
        clear: f64,
        load: wgpu::LoadOp<f32>,
    ) -> wgpu::RenderPass<'e> {
        let color = attachment(color, wgpu::LoadOp::Clear(wgpu::Color { r: clear, ..wgpu::Color::BLACK }));
        passes.encoder().begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[color],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    /// A frame: what each technique's full-screen pass says of its light, and what `call` of the
    /// host's shader says, an expression of WGSL. `make` makes the look-ups of what is lent.
    pub fn frame(
        &mut self,
        camera: &Camera,
        lights: &mut [(&Light, &mut Box<dyn Technique>)],
        make: impl FnOnce(&Gpu, Vec<Lent>) -> Inline,
        call: &str,
    ) -> Frame {
        let gpu = self.gpu.clone();
        let vertices = self.vertices(camera);
        let contents: Vec<f32> = vertices.iter().flatten().flat_map(|v| v.to_array()).collect();
        let vertices = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("host vertices"),
            contents: bytemuck::cast_slice(&contents),
            usage: wgpu::BufferUsages::VERTEX,
        });
        let count = contents.len() as u32 / 6;
        let camera = camera.view(SIZE.0, SIZE.1);
        let clip_from_eye = camera.clip_from_view * DMat4::from_mat3(camera.view_from_world.matrix3);
        gpu.queue.write_buffer(&self.frame, 0, bytemuck::cast_slice(&clip_from_eye.as_mat4().to_cols_array()));
        let frame = umbrage::fullscreen::bind(&gpu, "host", &self.layout, &[self.frame.as_entire_binding()]);

        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut recorder = std::mem::replace(&mut self.recorder, Recorder::new(&gpu));
        let mut passes = recorder.begin(&mut encoder);
        let mut pass = self.pass(&mut passes, &self.normals, 0.0, wgpu::LoadOp::Clear(0.0));
        pass.set_pipeline(&self.gbuffer);
        pass.set_bind_group(0, &frame, &[]);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.draw(0..count, 0..1);
        drop(pass);
        let mut targets = Vec::new();
        let mut lent = Vec::new();
        for (light, technique) in lights {
            let view = View { camera, receivers: &self.receivers, casters: &self.casters, light, textures: &[] };
            let target = VisibilityTarget::new(&gpu, SIZE.0, SIZE.1).unwrap();
            let prepared = technique.prepare(&gpu, &view).unwrap();
            match self.only_maps {
                true => prepared.record_maps(&mut passes).unwrap(),
                false => prepared.record(&mut passes, &target).unwrap(),
            }
            targets.push(target);
            lent.push(technique.lend(&gpu).unwrap());
        }
        let lookups = make(&gpu, lent);
        let text =
            format!("{}\n@fragment\nfn lit(in: Corner) -> @location(0) f32 {{ return {call}; }}", lookups.wgsl());
        let groups = [&self.layout, lookups.layout()];
        let pipeline = pipeline(&gpu, &text, "lit", wgpu::TextureFormat::R32Float, &groups);
        let target = self.target.create_view(&Default::default());
        let mut pass = self.pass(&mut passes, &target, f64::from(NOTHING), wgpu::LoadOp::Load);
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &frame, &[]);
        pass.set_bind_group(1, lookups.bind_group(), &[]);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.draw(0..count, 0..1);
        drop(pass);
        passes.finish();
        gpu.queue.submit([encoder.finish()]);
        self.recorder = recorder;
        let full_screen = targets.iter().map(|target| target.read(&gpu).unwrap()).collect();
        let inline = read::one_channel(&gpu, &self.target, 0).unwrap();
        Frame { full_screen, inline, lookups }
    }
}

fn pipeline(
    gpu: &Gpu,
    text: &str,
    entry: &str,
    format: wgpu::TextureFormat,
    groups: &[&wgpu::BindGroupLayout],
) -> wgpu::RenderPipeline {
    let text = format!("{}\n{SHADER}\n{text}", umbrage::wgsl::PACK_NORMAL);
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("host"),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let groups: Vec<_> = groups.iter().map(|group| Some(*group)).collect();
    let layout = gpu
        .device
        .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor { bind_group_layouts: &groups, ..Default::default() });
    let attributes = &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
    let buffers =
        [Some(wgpu::VertexBufferLayout { array_stride: 24, step_mode: wgpu::VertexStepMode::Vertex, attributes })];
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("host"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: Default::default(),
            buffers: &buffers,
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

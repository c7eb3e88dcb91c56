//! A host keeps its geometry in buffers of its own and lends them: 50 blocks that come and go, in
//! vertex, index and instance buffers, and a ring whose vertices a compute shader of the host
//! moves. A tentacle is bent by umbrage, and drawn by the host from where umbrage has its vertices.
//! No vertex is copied, and none is moved twice.
//!
//!     cargo run -p umbrage --example own_buffers -- picture.png

use umbrage::core::glam::{DAffine3, DVec3, Mat4, Vec3};
use umbrage::core::{Bounds, Camera, Image, Light, LightShape, Material, Mesh, Scene, primitive, scenes};
use umbrage::{
    CasterView, Casters, Configure, Gpu, InstanceId, LentIndices, LentInstances, LentMatrices, LentMesh, LentShape,
    LentVertices, MatrixForm, MeshId, Placement, Receivers, Recorder, View, VisibilityTarget, techniques::pcf::Pcf,
};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Blocks that are there in every frame, the ground not counted.
const BLOCKS: usize = 50;

/// Positions, then the columns of a matrix for each instance.
const SHADER: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;
@group(1) @binding(0) var visibility: texture_2d<f32>;
struct Out { @invariant @builtin(position) position: vec4f, @location(0) color: vec3f }
@vertex fn vertex(@location(0) p: vec3f, @location(1) x: vec4f, @location(2) y: vec4f, @location(3) z: vec4f,
                  @location(4) w: vec4f) -> Out {
    let color = 0.5 + 0.4 * cos(vec3f(0.0, 2.0, 4.0) + dot(vec3f(x.x, y.y, z.z), vec3f(7.0, 13.0, 5.0)));
    return Out(clip_from_world * (mat4x4f(x, y, z, w) * vec4f(p, 1.0)), color);
}
@fragment fn shade(in: Out) -> @location(0) vec4f {
    let lit = textureLoad(visibility, vec2i(in.position.xy), 0).x;
    return vec4f(in.color * (0.25 + 0.75 * lit), 1.0);
}";

/// Has the ring wave.
const WAVE: &str = "
@group(0) @binding(0) var<storage, read> rest: array<f32>;
@group(0) @binding(1) var<storage, read_write> moved: array<f32>;
@group(0) @binding(2) var<uniform> seconds: f32;
@compute @workgroup_size(64) fn wave(@builtin(global_invocation_id) id: vec3u) {
    let at = 3u * id.x;
    if at + 2u >= arrayLength(&rest) { return; }
    let angle = atan2(rest[at + 2u], rest[at]);
    moved[at] = rest[at];
    moved[at + 1u] = rest[at + 1u] + 0.25 * sin(2.0 * angle + seconds);
    moved[at + 2u] = rest[at + 2u];
}";

/// Where the blocks of a frame are: the ground, then some of a spiral of which the oldest goes and
/// a new one comes.
fn blocks(frame: usize) -> Vec<Mat4> {
    let block = |at: Vec3, size: Vec3| Mat4::from_translation(at) * Mat4::from_scale(size);
    let of = |i: usize| {
        let (turn, away) = (i as f32 * 2.4, 0.62 * (i % BLOCKS) as f32);
        let height = 0.3 + 1.4 * (i as f32 * 0.7).sin().abs();
        block(
            Vec3::new(turn.cos() * away.sqrt(), 0.5 * height, turn.sin() * away.sqrt()),
            Vec3::new(0.35, height, 0.35),
        )
    };
    let ground = block(Vec3::new(0.0, -0.05, 0.0), Vec3::new(16.0, 0.1, 16.0));
    std::iter::once(ground).chain((frame..frame + BLOCKS).map(of)).collect()
}

/// A picture of 480 × 360 pixels, into the PNG file that is named, else into none.
pub fn main() -> Result<()> {
    let (picture, _) = frames(8, (480, 360))?;
    if let Some(path) = std::env::args().nth(1).filter(|path| path.ends_with(".png")) {
        umbrage_io::pictures::save_png(path.as_ref(), &picture)?;
    }
    Ok(())
}

/// What umbrage knows of the host's world.
struct Known {
    casters: Casters,
    blocks: InstanceId,
    ring: MeshId,
    tentacle: InstanceId,
    /// The tentacle's joints come from it.
    scene: Scene,
}

/// Where blocks and ring may be.
const WORLD: Bounds = Bounds { min: DVec3::new(-8.0, -0.1, -8.0), max: DVec3::new(8.0, 1.8, 8.0) };
const RING: Bounds = Bounds { min: DVec3::new(-1.5, -0.4, -1.5), max: DVec3::new(1.5, 0.4, 1.5) };

impl Known {
    fn new(gpu: &Gpu, host: &Host) -> Result<Self> {
        let mut casters = Casters::empty(gpu)?;
        let material = casters.add_material(&Material::default(), None)?;
        let block = casters.lend_mesh(&host.block.lend(LentShape::Unknown(primitive::cube().bounds())))?;
        let buffer = host.places.clone();
        let count = 1 + BLOCKS as u32;
        let blocks = casters.insert_lent(&LentInstances {
            mesh: block,
            material,
            world_from_group: DAffine3::IDENTITY,
            matrices: LentMatrices { buffer, offset: 0, stride: 64, form: MatrixForm::Columns4x4, count },
            bounds: WORLD,
            casts: true,
            receives: true,
        })?;
        let ring = casters.lend_mesh(&host.ring.lend(LentShape::Unknown(RING)))?;
        casters.insert(&Placement::new(ring, material, RING_AT))?;
        let scene = (scenes::find("tentacles").ok_or("no tentacles")?.build)(0.3);
        let bent = scene.instances.iter().find(|instance| instance.pose.is_some()).ok_or("nothing is bent")?;
        let mesh = casters.add_mesh(&scene.meshes[bent.mesh])?;
        let joints = scene.joints(bent);
        let tentacle = casters.insert(&Placement { joints, ..Placement::new(mesh, material, TENTACLE_AT) })?;
        Ok(Self { casters, blocks, ring, tentacle, scene })
    }

    /// The host has written to its buffers, and the tentacle bends.
    fn follow(&mut self, seconds: f64) -> Result<()> {
        self.casters.touch_instances(self.blocks, 1 + BLOCKS as u32, &WORLD)?;
        self.casters.touch_mesh(self.ring, &RING)?;
        self.scene.advance(seconds);
        let joints = self.scene.instances.iter().find_map(|instance| self.scene.joints(instance));
        self.casters.set_pose(self.tentacle, &joints.unwrap_or_default())?;
        Ok(())
    }
}

const RING_AT: DAffine3 = DAffine3 { translation: DVec3::new(-0.4, 2.3, 0.2), ..DAffine3::IDENTITY };
const TENTACLE_AT: DAffine3 = DAffine3 { translation: DVec3::new(2.4, 0.0, 1.4), ..DAffine3::IDENTITY };

/// Draws frames; the last one, and what of the sun is seen in it.
pub fn frames(count: usize, size: (u32, u32)) -> Result<(Image<[u8; 4]>, Image<f32>)> {
    let gpu = pollster::block_on(Gpu::request_async(None))?;
    let camera = Camera { eye: DVec3::new(2.5, 5.0, 7.5), target: DVec3::new(0.0, 0.6, 0.4), ..Camera::default() };
    let camera = camera.view(size.0, size.1);
    let sun = LightShape::Directional { direction: DVec3::new(0.6, -0.8, -0.35).normalize(), angle_deg: 0.0 };
    let light = Light::new(sun);

    let mut technique = Pcf::default().make(&gpu)?;
    let target = VisibilityTarget::new(&gpu, size.0, size.1)?;
    let mut recorder = Recorder::new(&gpu);
    let host = Host::new(&gpu, size, &target);
    let receivers = Receivers::new(&gpu, &host.depth, None, size)?;
    let mut known = Known::new(&gpu, &host)?;
    for frame in 0..count {
        // The host's blocks come and go, its ring waves, and umbrage is told.
        let seconds = 0.25 * frame as f32;
        gpu.queue.write_buffer(&host.places, 0, bytemuck::cast_slice(&blocks(frame)));
        gpu.queue.write_buffer(&host.seconds, 0, bytemuck::bytes_of(&seconds));
        known.follow(f64::from(seconds))?;

        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = recorder.begin(&mut encoder);
        host.wave(passes.encoder());
        known.casters.record(&mut passes)?;
        let matrix = camera.clip_from_world().as_mat4().to_cols_array();
        gpu.queue.write_buffer(&host.matrix, 0, bytemuck::cast_slice(&matrix));
        host.pass(passes.encoder(), &known, None)?;
        let view = View { camera, receivers: &receivers, casters: &known.casters, light: &light, textures: &[] };
        technique.prepare(&gpu, &view)?.record(&mut passes, &target)?;
        host.pass(passes.encoder(), &known, Some(&host.color))?;
        passes.finish();
        gpu.queue.submit([encoder.finish()]);
    }
    Ok((host.read(&gpu)?, target.read(&gpu)?))
}

/// A mesh of the host's.
struct Own {
    positions: wgpu::Buffer,
    indices: wgpu::Buffer,
    counts: [u32; 2],
}

impl Own {
    fn new(gpu: &Gpu, mesh: &Mesh, more: wgpu::BufferUsages) -> Self {
        let indices: Vec<u16> = mesh.indices.iter().map(|i| *i as u16).collect();
        Self {
            positions: gpu.buffer("positions", &mesh.positions, wgpu::BufferUsages::VERTEX | more),
            indices: gpu.buffer("indices", &indices, wgpu::BufferUsages::INDEX),
            counts: [mesh.positions.len() as u32, indices.len() as u32],
        }
    }

    fn lend<'a>(&self, shape: LentShape<'a>) -> LentMesh<'a> {
        let [vertex_count, index_count] = self.counts;
        let (buffer, format) = (self.positions.clone(), wgpu::VertexFormat::Float32x3);
        let positions = LentVertices { buffer, offset: 0, stride: 12, format };
        let (buffer, format) = (self.indices.clone(), wgpu::IndexFormat::Uint16);
        let indices = LentIndices { buffer, format, range: 0..index_count, base_vertex: 0 };
        LentMesh { positions, vertex_count, uvs: None, indices, shape }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, places: &wgpu::Buffer, count: u32) {
        pass.set_vertex_buffer(0, self.positions.slice(..));
        pass.set_vertex_buffer(1, places.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
        pass.draw_indexed(0..self.counts[1], 0, 0..count);
    }
}

/// The host's pipelines, buffers and targets.
struct Host {
    depth: wgpu::TextureView,
    color: wgpu::Texture,
    pipeline: wgpu::RenderPipeline,
    shade: wgpu::RenderPipeline,
    groups: [wgpu::BindGroup; 2],
    matrix: wgpu::Buffer,
    block: Own,
    places: wgpu::Buffer,
    ring: Own,
    /// Of ring and tentacle.
    single: [wgpu::Buffer; 2],
    seconds: wgpu::Buffer,
    waves: (wgpu::ComputePipeline, wgpu::BindGroup),
}

impl Host {
    fn new(gpu: &Gpu, size: (u32, u32), target: &VisibilityTarget) -> Self {
        use wgpu::{BufferUsages as Of, TextureFormat as Format, TextureUsages as Use};
        let texture = |format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("the host's"),
                size: wgpu::Extent3d { width: size.0, height: size.1, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let depth = texture(Format::Depth32Float, Use::RENDER_ATTACHMENT | Use::TEXTURE_BINDING);
        let color = texture(Format::Rgba8Unorm, Use::RENDER_ATTACHMENT | Use::COPY_SRC);
        // Depth as umbrage's own: 1 is nearest.
        let state = CasterView::depth_stencil();
        let pipeline = pipeline(gpu, state.clone(), None);
        let compare = Some(wgpu::CompareFunction::GreaterEqual);
        let shade =
            self::pipeline(gpu, wgpu::DepthStencilState { depth_compare: compare, ..state }, Some(color.format()));
        let matrix = gpu.buffer("camera", &[[0f32; 4]; 4], Of::UNIFORM | Of::COPY_DST);
        let of_matrix = [matrix.as_entire_binding()];
        let of_target = [wgpu::BindingResource::TextureView(&target.view)];
        let groups = [
            bind(gpu, &shade.get_bind_group_layout(0), &of_matrix),
            bind(gpu, &shade.get_bind_group_layout(1), &of_target),
        ];
        let torus = primitive::torus(1.3, 0.12, 48, 10);
        let ring = Own::new(gpu, &torus, Of::STORAGE);
        let rest = gpu.buffer("ring at rest", &torus.positions, Of::STORAGE);
        let seconds = gpu.buffer("seconds", &[0f32; 4], Of::UNIFORM | Of::COPY_DST);
        let waves = wave(gpu, [&rest, &ring.positions, &seconds]);
        let at =
            |place: DAffine3| gpu.buffer("place", &[Mat4::from_translation(place.translation.as_vec3())], Of::VERTEX);
        Self {
            depth: depth.create_view(&Default::default()),
            pipeline,
            shade,
            color,
            groups,
            matrix,
            block: Own::new(gpu, &primitive::cube(), Of::empty()),
            places: gpu.buffer("places", &blocks(0), Of::VERTEX | Of::COPY_DST),
            ring,
            single: [RING_AT, TENTACLE_AT].map(at),
            seconds,
            waves,
        }
    }

    /// Moves the ring's vertices.
    fn wave(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.waves.0);
        pass.set_bind_group(0, &self.waves.1, &[]);
        pass.dispatch_workgroups(self.ring.counts[0].div_ceil(64), 1, 1);
    }

    /// Depth alone, then colours where that is the nearest.
    fn pass(&self, encoder: &mut wgpu::CommandEncoder, known: &Known, color: Option<&wgpu::Texture>) -> Result<()> {
        let view = color.map(|color| color.create_view(&Default::default()));
        let load = if color.is_some() { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(0.0) };
        let sky = wgpu::Color { r: 0.6, g: 0.7, b: 0.8, a: 1.0 };
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(sky), store: wgpu::StoreOp::Store };
        let attachments: Vec<_> = view
            .iter()
            .map(|view| Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }))
            .collect();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("the host's"),
            color_attachments: &attachments,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(if color.is_some() { &self.shade } else { &self.pipeline });
        pass.set_bind_group(0, &self.groups[0], &[]);
        if color.is_some() {
            pass.set_bind_group(1, &self.groups[1], &[]);
        }
        self.block.draw(&mut pass, &self.places, 1 + BLOCKS as u32);
        self.ring.draw(&mut pass, &self.single[0], 1);
        // What umbrage has bent is drawn from where it is.
        let bent = known.casters.vertices(known.tentacle)?;
        pass.set_vertex_buffer(0, bent.positions);
        pass.set_vertex_buffer(1, self.single[1].slice(..));
        pass.set_index_buffer(bent.indices, wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..bent.index_count, 0, 0..1);
        Ok(())
    }

    fn read(&self, gpu: &Gpu) -> Result<Image<[u8; 4]>> {
        let (width, height) = (self.color.width(), self.color.height());
        let bytes_per_row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let back = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(bytes_per_row) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout { bytes_per_row: Some(bytes_per_row), ..Default::default() };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let to = wgpu::TexelCopyBufferInfo { buffer: &back, layout };
        encoder.copy_texture_to_buffer(self.color.as_image_copy(), to, self.color.size());
        gpu.queue.submit([encoder.finish()]);
        back.map_async(wgpu::MapMode::Read, .., |_| ());
        gpu.wait()?;
        let bytes = back.get_mapped_range(..)?;
        let at = |x: u32, y: u32| (y * bytes_per_row + 4 * x) as usize;
        Ok(Image::from_fn(width, height, |x, y| std::array::from_fn(|i| bytes[at(x, y) + i])))
    }
}

fn bind(gpu: &Gpu, layout: &wgpu::BindGroupLayout, resources: &[wgpu::BindingResource<'_>]) -> wgpu::BindGroup {
    let numbered = (0..).zip(resources.iter().cloned());
    let entries: Vec<_> = numbered.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

fn module(gpu: &Gpu, text: &'static str) -> wgpu::ShaderModule {
    let source = wgpu::ShaderSource::Wgsl(text.into());
    gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
}

fn wave(gpu: &Gpu, buffers: [&wgpu::Buffer; 3]) -> (wgpu::ComputePipeline, wgpu::BindGroup) {
    let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("the host's"),
        layout: None,
        module: &module(gpu, WAVE),
        entry_point: Some("wave"),
        compilation_options: Default::default(),
        cache: None,
    });
    let group = bind(gpu, &pipeline.get_bind_group_layout(0), &buffers.map(|buffer| buffer.as_entire_binding()));
    (pipeline, group)
}

fn pipeline(gpu: &Gpu, depth: wgpu::DepthStencilState, color: Option<wgpu::TextureFormat>) -> wgpu::RenderPipeline {
    let entry = |visibility, ty| wgpu::BindGroupLayoutEntry { binding: 0, visibility, ty, count: None };
    let uniform = wgpu::BufferBindingType::Uniform;
    let matrix = wgpu::BindingType::Buffer { ty: uniform, has_dynamic_offset: false, min_binding_size: None };
    let seen = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let groups = [entry(wgpu::ShaderStages::VERTEX, matrix), entry(wgpu::ShaderStages::FRAGMENT, seen)].map(|entry| {
        let entries = &[entry];
        gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries })
    });
    let groups = [Some(&groups[0]), Some(&groups[1])];
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &groups[..if color.is_some() { 2 } else { 1 }],
        ..Default::default()
    });
    let position = wgpu::vertex_attr_array![0 => Float32x3];
    let columns = wgpu::vertex_attr_array![1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4];
    let buffer = |array_stride, step_mode, attributes| wgpu::VertexBufferLayout { array_stride, step_mode, attributes };
    let targets = color.map(|format| [Some(wgpu::ColorTargetState::from(format))]);
    let module = &module(gpu, SHADER);
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("the host's"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[
                Some(buffer(12, wgpu::VertexStepMode::Vertex, &position)),
                Some(buffer(64, wgpu::VertexStepMode::Instance, &columns)),
            ],
        },
        primitive: Default::default(),
        depth_stencil: Some(depth),
        multisample: Default::default(),
        fragment: targets.as_ref().map(|targets| wgpu::FragmentState {
            module,
            entry_point: Some("shade"),
            compilation_options: Default::default(),
            targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

//! A host keeps all geometry in buffers of its own, and umbrage never sees them: 50 blocks that
//! come and go, in one vertex and one instance buffer, are drawn by the host's one pipeline into
//! its depth buffer and into the maps of a sun.
//!
//!     cargo run -p umbrage --example own_buffers -- picture.png

use std::sync::Arc;
use umbrage::core::glam::{DVec3, Vec3};
use umbrage::core::{Bounds, Camera, Image, Light, LightShape, primitive};
use umbrage::{
    CasterView, Casters, Configure, Gpu, HostCasters, Receivers, Recorder, View, VisibilityTarget, techniques::pcf::Pcf,
};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Blocks that are there in every frame, the ground not counted.
const BLOCKS: usize = 50;

/// One shader for the camera and for the light: group 0 is a matrix.
const SHADER: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;
@group(1) @binding(0) var visibility: texture_2d<f32>;
struct Out { @invariant @builtin(position) position: vec4f, @location(0) color: vec3f }
@vertex fn vertex(@location(0) p: vec3f, @location(1) at: vec3f, @location(2) size: vec3f) -> Out {
    let color = 0.5 + 0.4 * cos(vec3f(0.0, 2.0, 4.0) + dot(size, vec3f(7.0, 13.0, 5.0)));
    return Out(clip_from_world * vec4f(at + size * p, 1.0), color);
}
@fragment fn shade(in: Out) -> @location(0) vec4f {
    let lit = textureLoad(visibility, vec2i(in.position.xy), 0).x;
    return vec4f(in.color * (0.25 + 0.75 * lit), 1.0);
}";

/// The host's buffers, and how it draws them.
struct Blocks {
    depth: wgpu::RenderPipeline,
    corners: wgpu::Buffer,
    places: wgpu::Buffer,
    count: u32,
}

impl HostCasters for Blocks {
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _: &CasterView<'_>) {
        self.draw_with(pass, &self.depth);
    }
}

impl Blocks {
    fn draw_with(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, self.corners.slice(..));
        pass.set_vertex_buffer(1, self.places.slice(..));
        pass.draw(0..36, 0..self.count);
    }
}

/// Where the blocks of a frame are, and their sizes: the ground, then some of a spiral of which the
/// oldest goes and a new one comes.
fn blocks(frame: usize) -> Vec<[Vec3; 2]> {
    let of = |i: usize| {
        let (turn, away) = (i as f32 * 2.4, 0.62 * (i % BLOCKS) as f32);
        let height = 0.3 + 1.4 * (i as f32 * 0.7).sin().abs();
        let at = Vec3::new(turn.cos() * away.sqrt(), 0.5 * height, turn.sin() * away.sqrt());
        [at, Vec3::new(0.35, height, 0.35)]
    };
    let ground = [Vec3::new(0.0, -0.05, 0.0), Vec3::new(16.0, 0.1, 16.0)];
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

/// Draws frames; the last one, and what of the sun is seen in it.
pub fn frames(count: usize, size: (u32, u32)) -> Result<(Image<[u8; 4]>, Image<f32>)> {
    let gpu = pollster::block_on(Gpu::request_async(None))?;
    let camera = Camera { eye: DVec3::new(2.5, 5.0, 7.5), target: DVec3::new(0.0, 0.3, 0.4), ..Camera::default() };
    let camera = camera.view(size.0, size.1);
    let sun = LightShape::Directional { direction: DVec3::new(0.6, -0.8, -0.35).normalize(), angle_deg: 0.0 };
    let light = Light::new(sun);

    // umbrage, once. Where the host's things are is all that it knows of them.
    let world = Bounds { min: DVec3::new(-8.0, -0.1, -8.0), max: DVec3::new(8.0, 1.8, 8.0) };
    let mut casters = Casters::empty(&gpu)?;
    casters.receive_in(&[world]);
    let mut technique = Pcf::default().make(&gpu)?;
    let target = VisibilityTarget::new(&gpu, size.0, size.1)?;
    let mut recorder = Recorder::new(&gpu);

    let host = Host::new(&gpu, size, &target);
    let receivers = Receivers::new(&gpu, &host.depth, None, size)?;
    for frame in 0..count {
        // The host's blocks come and go.
        let there = blocks(frame);
        gpu.queue.write_buffer(&host.places, 0, bytemuck::cast_slice(&there));
        let (corners, places) = (host.corners.clone(), host.places.clone());
        let own = Arc::new(Blocks { depth: host.pipeline.clone(), corners, places, count: there.len() as u32 });
        casters.set_host_casters(Some((world, own.clone())))?;

        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = recorder.begin(&mut encoder);
        casters.record(&mut passes)?;
        // The host's vertices lie about the world's origin, which is that of the casters here.
        let matrix = camera.clip_from_world().as_mat4().to_cols_array();
        gpu.queue.write_buffer(&host.matrix, 0, bytemuck::cast_slice(&matrix));
        host.pass(passes.encoder(), None, |pass| own.draw_with(pass, &host.pipeline));
        let view = View { camera, receivers: &receivers, casters: &casters, light: &light, textures: &[] };
        technique.prepare(&gpu, &view)?.record(&mut passes, &target)?;
        host.pass(passes.encoder(), Some(&host.color), |pass| own.draw_with(pass, &host.shade));
        passes.finish();
        gpu.queue.submit([encoder.finish()]);
    }
    Ok((host.read(&gpu)?, target.read(&gpu)?))
}

/// The host's pipelines and targets.
struct Host {
    depth: wgpu::TextureView,
    color: wgpu::Texture,
    pipeline: wgpu::RenderPipeline,
    shade: wgpu::RenderPipeline,
    groups: [wgpu::BindGroup; 2],
    matrix: wgpu::Buffer,
    corners: wgpu::Buffer,
    places: wgpu::Buffer,
}

impl Host {
    fn new(gpu: &Gpu, size: (u32, u32), target: &VisibilityTarget) -> Self {
        use wgpu::{BufferUsages as Of, TextureFormat as Format, TextureUsages as Use};
        let device = &gpu.device;
        let texture = |format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
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
        let cube = primitive::cube();
        let corners: Vec<Vec3> = cube.indices.iter().map(|i| cube.positions[*i as usize]).collect();
        let group = CasterView::layout(gpu);
        let seen = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            }],
        });
        let bind = |layout, resource| {
            let entries = &[wgpu::BindGroupEntry { binding: 0, resource }];
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries })
        };
        let matrix = gpu.buffer("camera", &[[0f32; 4]; 10], Of::UNIFORM | Of::COPY_DST);
        let groups =
            [bind(&group, matrix.as_entire_binding()), bind(&seen, wgpu::BindingResource::TextureView(&target.view))];
        let shaded = wgpu::CompareFunction::GreaterEqual;
        Self {
            depth: depth.create_view(&Default::default()),
            pipeline: pipeline(gpu, &[Some(&group)], CasterView::depth_stencil(), None),
            shade: pipeline(
                gpu,
                &[Some(&group), Some(&seen)],
                wgpu::DepthStencilState { depth_compare: Some(shaded), ..CasterView::depth_stencil() },
                Some(color.format()),
            ),
            color,
            groups,
            matrix,
            corners: gpu.buffer("corners", &corners, Of::VERTEX),
            places: gpu.buffer("places", &blocks(0), Of::VERTEX | Of::COPY_DST),
        }
    }

    /// Depth alone, then colours where that is the nearest.
    fn pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        color: Option<&wgpu::Texture>,
        draw: impl FnOnce(&mut wgpu::RenderPass<'_>),
    ) {
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
        pass.set_bind_group(0, &self.groups[0], &[]);
        if color.is_some() {
            pass.set_bind_group(1, &self.groups[1], &[]);
        }
        draw(&mut pass);
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

fn pipeline(
    gpu: &Gpu,
    groups: &[Option<&wgpu::BindGroupLayout>],
    depth: wgpu::DepthStencilState,
    color: Option<wgpu::TextureFormat>,
) -> wgpu::RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(SHADER.into());
    let module = &gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let layout = gpu
        .device
        .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor { bind_group_layouts: groups, ..Default::default() });
    let attributes =
        [&wgpu::vertex_attr_array![0 => Float32x3][..], &wgpu::vertex_attr_array![1 => Float32x3, 2 => Float32x3]];
    let steps = [(12, wgpu::VertexStepMode::Vertex), (24, wgpu::VertexStepMode::Instance)];
    let buffers = [0, 1].map(|i| {
        let (array_stride, step_mode) = steps[i];
        Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes: attributes[i] })
    });
    let targets = color.map(|format| [Some(wgpu::ColorTargetState::from(format))]);
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("the host's"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &buffers,
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

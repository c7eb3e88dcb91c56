//! The host: triangles, a G-buffer, and a shader of its own.

use umbrage::core::glam::{DMat4, DVec3};
use umbrage::core::{CameraView, Scene};
use umbrage::fullscreen::{UNIFORM, attachment, bind, layout, target_texture};
use umbrage::{Gpu, Inline, Passes};

const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const NORMALS: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
const SHADED: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// With a look-up: the host's shading times what it says.
const LIT: &str = "@fragment fn lit(in: Corner) -> @location(0) f32 {
    return shaded(in) * sun_visibility(in.position, normal_of(in));
}";

pub struct Host {
    pub depth: wgpu::TextureView,
    pub normals: wgpu::TextureView,
    target: wgpu::TextureView,
    layout: wgpu::BindGroupLayout,
    bind_group: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    count: u32,
    gbuffer: wgpu::RenderPipeline,
    own: wgpu::RenderPipeline,
}

impl Host {
    /// For the scene's own camera.
    pub fn new(gpu: &Gpu, scene: &Scene, size: (u32, u32)) -> Self {
        let [depth, normals, target] = [DEPTH, NORMALS, SHADED]
            .map(|format| target_texture(gpu, "host", size, 1, format).create_view(&Default::default()));
        let layout = layout(gpu, "host", wgpu::ShaderStages::VERTEX_FRAGMENT, &[UNIFORM]);
        let camera = scene.camera.view(size.0, size.1);
        let frame = gpu.buffer("host", &clip_from_eye(&camera), wgpu::BufferUsages::UNIFORM);
        let vertices = vertices(scene, camera.eye);
        Self {
            bind_group: bind(gpu, "host", &layout, &[frame.as_entire_binding()]),
            gbuffer: pipeline(gpu, "", "packed", NORMALS, &[&layout]),
            own: pipeline(gpu, "", "own", SHADED, &[&layout]),
            vertices: gpu.buffer("host", &vertices, wgpu::BufferUsages::VERTEX),
            count: vertices.len() as u32,
            depth,
            normals,
            target,
            layout,
        }
    }

    /// The host's shading with a look-up.
    pub fn pipeline(&self, gpu: &Gpu, inline: &Inline) -> wgpu::RenderPipeline {
        let text = format!("{}\n{LIT}", inline.wgsl());
        pipeline(gpu, &text, "lit", SHADED, &[&self.layout, inline.layout()])
    }

    pub fn record_gbuffer(&self, passes: &mut Passes<'_>) {
        let mut pass = self.pass(passes, "depth", &self.normals, wgpu::LoadOp::Clear(0.0));
        self.draw(&mut pass, &self.gbuffer);
    }

    /// Shades what the depth buffer shows, without a look-up where there is none.
    pub fn record_shading(
        &self,
        passes: &mut Passes<'_>,
        label: &str,
        lookup: Option<(&wgpu::BindGroup, &wgpu::RenderPipeline)>,
    ) {
        let mut pass = self.pass(passes, label, &self.target, wgpu::LoadOp::Load);
        if let Some((bind_group, _)) = lookup {
            pass.set_bind_group(1, bind_group, &[]);
        }
        self.draw(&mut pass, lookup.map_or(&self.own, |(_, pipeline)| pipeline));
    }

    fn pass<'p>(
        &self,
        passes: &'p mut Passes<'_>,
        label: &str,
        color: &wgpu::TextureView,
        load: wgpu::LoadOp<f32>,
    ) -> umbrage::Pass<'p> {
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth,
            depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        };
        passes.render(label, &[attachment(color, wgpu::LoadOp::Clear(wgpu::Color::BLACK))], Some(depth))
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.bind_group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..self.count, 0..1);
    }
}

fn clip_from_eye(camera: &CameraView) -> [f32; 16] {
    (camera.clip_from_view * DMat4::from_mat3(camera.view_from_world.matrix3)).as_mat4().to_cols_array()
}

/// Corners relative to the eye, each with its triangle's normal.
fn vertices(scene: &Scene, eye: DVec3) -> Vec<[f32; 6]> {
    let mut vertices = Vec::new();
    for instance in &scene.instances {
        let mesh = &scene.meshes[instance.mesh];
        for triangle in mesh.indices.as_chunks::<3>().0 {
            let place = |i: u32| instance.world_from_mesh.transform_point3(mesh.positions[i as usize].as_dvec3()) - eye;
            let corners = triangle.map(place);
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero().as_vec3();
            vertices.extend(corners.map(|p| {
                let [x, y, z] = p.as_vec3().to_array();
                [x, y, z, normal.x, normal.y, normal.z]
            }));
        }
    }
    vertices
}

fn pipeline(
    gpu: &Gpu,
    text: &str,
    entry: &str,
    format: wgpu::TextureFormat,
    groups: &[&wgpu::BindGroupLayout],
) -> wgpu::RenderPipeline {
    let text = format!("{}\n{}\n{text}", umbrage::wgsl::PACK_NORMAL, include_str!("host.wgsl"));
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("host"), source });
    let groups: Vec<_> = groups.iter().map(|group| Some(*group)).collect();
    let layout = gpu
        .device
        .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor { bind_group_layouts: &groups, ..Default::default() });
    let attributes = &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
    let step_mode = wgpu::VertexStepMode::Vertex;
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("host"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout { array_stride: 24, step_mode, attributes })],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
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

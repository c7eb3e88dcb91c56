//! The host: a device, a depth buffer, a colour target, triangles and pipelines. It knows of
//! umbrage only that some text stands before its shader and that bind group 1 goes with it.

use super::Result;
use super::things::{self, Corner};
use umbrage::core::glam::{DMat4, DVec3};
use umbrage::core::{Camera, Light};
use wgpu::util::DeviceExt;

const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// The scene.
    Colors,
    /// The share of a light that what does not let light through sees, in red.
    Share(usize),
}

pub struct Host {
    pub color: wgpu::Texture,
    pub depth: wgpu::TextureView,
    device: wgpu::Device,
    shown: Shown,
    layout: wgpu::BindGroupLayout,
    bind_group: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    /// Corners of what is solid; the others follow.
    solid: u32,
    all: u32,
    /// For what is solid, and for what is not.
    pipelines: Vec<wgpu::RenderPipeline>,
}

/// A device that asks for nothing.
pub fn device() -> Result<(wgpu::Device, wgpu::Queue)> {
    pollster::block_on(async {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = instance.request_adapter(&Default::default()).await?;
        Ok(adapter.request_device(&Default::default()).await?)
    })
}

impl Host {
    pub fn new(device: &wgpu::Device, size: (u32, u32), camera: &Camera, lights: &[Light], shown: Shown) -> Self {
        let solid = things::solids();
        let transparent = things::transparent(camera.eye);
        let vertices: Vec<f32> = solid.iter().chain(&transparent).flat_map(|c| floats(c, camera.eye)).collect();
        let buffer = |label, contents: &[f32], usage| {
            let contents = bytemuck::cast_slice(contents);
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let frame = buffer("frame", &frame(size, camera, lights), wgpu::BufferUsages::UNIFORM);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("frame"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: frame.as_entire_binding() }],
        });
        let color = match shown {
            Shown::Colors => wgpu::TextureFormat::Rgba8UnormSrgb,
            Shown::Share(_) => wgpu::TextureFormat::Rgba8Unorm,
        };
        Self {
            color: target(device, "color", size, color, wgpu::TextureUsages::COPY_SRC),
            depth: target(device, "depth", size, DEPTH, wgpu::TextureUsages::TEXTURE_BINDING)
                .create_view(&Default::default()),
            device: device.clone(),
            shown,
            layout,
            bind_group,
            vertices: buffer("vertices", &vertices, wgpu::BufferUsages::VERTEX),
            solid: solid.len() as u32,
            all: (solid.len() + transparent.len()) as u32,
            pipelines: Vec::new(),
        }
    }

    /// Pipelines of the host's shader after the look-ups of its lights.
    pub fn make_pipelines(&mut self, lookups: &str, layout: &wgpu::BindGroupLayout) {
        let text = format!("{lookups}\n{}", include_str!("forward.wgsl"));
        let source = wgpu::ShaderSource::Wgsl(text.into());
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("forward"), source });
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("forward"),
            bind_group_layouts: &[Some(&self.layout), Some(layout)],
            ..Default::default()
        });
        let passes: &[bool] = if self.shown == Shown::Colors { &[true, false] } else { &[true] };
        self.pipelines = passes.iter().map(|solid| self.pipeline(&module, &layout, *solid)).collect();
    }

    fn pipeline(
        &self,
        module: &wgpu::ShaderModule,
        layout: &wgpu::PipelineLayout,
        is_solid: bool,
    ) -> wgpu::RenderPipeline {
        let (entry, constants) = match self.shown {
            Shown::Colors => ("shaded", Vec::new()),
            Shown::Share(light) => ("share", vec![("LIGHT", light as f64)]),
        };
        let attributes = &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Uint32];
        let step_mode = wgpu::VertexStepMode::Vertex;
        let buffers = [Some(wgpu::VertexBufferLayout { array_stride: 44, step_mode, attributes })];
        let blend = (!is_solid).then_some(wgpu::BlendState::ALPHA_BLENDING);
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("forward"),
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &buffers,
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(is_solid),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                targets: &[Some(wgpu::ColorTargetState { blend, ..self.color.format().into() })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// Draws what is solid, then what one sees through.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder, lights: &wgpu::BindGroup) {
        let view = self.color.create_view(&Default::default());
        let sky = wgpu::LoadOp::Clear(wgpu::Color { r: 0.05, g: 0.07, b: 0.1, a: 1.0 });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("forward"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: sky, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.bind_group, &[]);
        pass.set_bind_group(1, lights, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        for (pipeline, corners) in self.pipelines.iter().zip([0..self.solid, self.solid..self.all]) {
            pass.set_pipeline(pipeline);
            pass.draw(corners, 0..1);
        }
    }
}

/// A vertex: position relative to the eye, normal, colour and kind.
fn floats(corner: &Corner, eye: DVec3) -> [f32; 11] {
    let [x, y, z] = (corner.position - eye).as_vec3().to_array();
    let [r, g, b, a] = corner.color;
    let normal = corner.normal;
    [x, y, z, normal.x, normal.y, normal.z, r, g, b, a, f32::from_bits(corner.kind)]
}

/// `Frame` of the shader.
fn frame((width, height): (u32, u32), camera: &Camera, lights: &[Light]) -> Vec<f32> {
    let view = camera.view(width, height);
    let rotation = DMat4::from_mat3(view.view_from_world.matrix3);
    let clip_from_eye = (view.clip_from_view * rotation).as_mat4();
    let colors = [[1.0, 0.92, 0.8, 0.0], [1.3, 0.8, 0.4, 0.0]];
    let lights = lights.iter().zip(colors).flat_map(|(light, color)| {
        let center = light.shape.center();
        let relative = center.truncate() - camera.eye * center.w;
        relative.extend(center.w).as_vec4().to_array().into_iter().chain(color)
    });
    clip_from_eye.to_cols_array().into_iter().chain(lights).collect()
}

fn target(
    device: &wgpu::Device,
    label: &str,
    (width, height): (u32, u32),
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    })
}

//! Shaders, and the pipelines made of them.

use crate::casters::{Casters, texture_layout};
use crate::compute::compute_pipeline;
use crate::fullscreen::{STORAGE, STORAGE_WRITE, UNIFORM, layout, texture};
use crate::shader::{Shader, shader_struct};
use crate::{Gpu, RadianceTarget};

const SUM: Shader = Shader::new("sum of transfer", include_str!("prt_sum.wgsl"))
    .with_layouts(&[PrtPart::LAYOUT, PrtMesh::LAYOUT, PrtPoint::LAYOUT])
    .with_constants(&[("BLOCK", BLOCK as f64)]);
const DRAW: Shader = Shader::new("transferred radiance", include_str!("prt_draw.wgsl"))
    .with_layouts(&[PrtView::LAYOUT, PrtMesh::LAYOUT])
    .with_constants(&[("HIDDEN", HIDDEN as f64)]);
pub(super) const SHADERS: [Shader; 2] = [SUM, DRAW];

/// Those of the sum.
pub(super) const STORAGE_BUFFERS: u32 = 5;

/// Points of a block of vectors, and threads of a group.
pub(super) const BLOCK: usize = 64;

/// What a vertex sends out: a colour for its front and one for its back.
pub(super) const SENT_BYTES: u64 = 24;

/// In place of the number of an instance that is not drawn.
pub(super) const HIDDEN: u32 = u32::MAX;

/// Of what is drawn: its own nearest surfaces hide the others.
pub(super) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

shader_struct! {
    /// A part of the points.
    pub(super) struct PrtPart {
        count: u32,
        functions: u32,
        first: u32,
        spare: u32,
    }
}

shader_struct! {
    /// A mesh as it stands in this frame.
    pub(super) struct PrtMesh {
        instance: u32,
        light: u32,
        turned: u32,
        spare: u32,
    }
}

shader_struct! {
    /// Whose sum goes where.
    pub(super) struct PrtPoint {
        mesh: u32,
        place: u32,
    }
}

shader_struct! {
    /// The camera.
    pub(super) struct PrtView {
        clip_from_world: [[f32; 4]; 4],
        rounding: [f32; 2],
        mirrored: u32,
        spare: u32,
    }
}

/// Numbers of a vertex, without what it sends out.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Vertex {
    pub position: [f32; 3],
    /// Texture coordinates and opacity.
    pub uv: [f32; 3],
    pub mesh: u32,
}

/// What is compiled once.
pub(super) struct Pipelines {
    pub sum_layout: wgpu::BindGroupLayout,
    pub draw_layout: wgpu::BindGroupLayout,
    /// For one colour and for three.
    sums: [wgpu::ComputePipeline; 2],
    /// Opaque and masked, for depth that grows towards the eye and away from it.
    draws: [[wgpu::RenderPipeline; 2]; 2],
}

impl Pipelines {
    pub fn new(gpu: &Gpu) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let bindings = [UNIFORM, STORAGE, STORAGE, STORAGE, STORAGE, STORAGE_WRITE];
        let sum_layout = layout(gpu, "sum of transfer", compute, &bindings);
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let depth = texture(wgpu::TextureSampleType::Depth);
        let draw_layout = layout(gpu, "transferred radiance", stages, &[UNIFORM, STORAGE, depth]);
        let module = SUM.module(gpu);
        let sum =
            |channels: f64| compute_pipeline(gpu, &module, "sum", &[Some(&sum_layout)], &[("CHANNELS", channels)]);
        let draw = |compare| ["opaque", "masked"].map(|entry| draw(gpu, &draw_layout, entry, compare));
        Self {
            sums: [sum(1.0), sum(3.0)],
            draws: [draw(wgpu::CompareFunction::GreaterEqual), draw(wgpu::CompareFunction::LessEqual)],
            sum_layout,
            draw_layout,
        }
    }

    pub fn sum(&self, channels: usize) -> &wgpu::ComputePipeline {
        &self.sums[usize::from(channels == 3)]
    }

    /// For depth that is `background` where nothing is.
    pub fn draw(&self, background: f32, is_masked: bool) -> &wgpu::RenderPipeline {
        &self.draws[usize::from(background > 0.5)][usize::from(is_masked)]
    }
}

fn draw(gpu: &Gpu, own: &wgpu::BindGroupLayout, entry: &str, compare: wgpu::CompareFunction) -> wgpu::RenderPipeline {
    const OWN: &[wgpu::VertexAttribute] = &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Uint32];
    const SENT: &[wgpu::VertexAttribute] = &wgpu::vertex_attr_array![3 => Float32x3, 4 => Float32x3];
    let vertices = |array_stride, attributes| {
        Some(wgpu::VertexBufferLayout { array_stride, step_mode: wgpu::VertexStepMode::Vertex, attributes })
    };
    let module = DRAW.module(gpu);
    let (casters, textures) = (Casters::layout(gpu), texture_layout(gpu));
    let groups = [own, &casters, &textures].map(Some);
    gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("transferred radiance"),
        layout: Some(&gpu.pipeline_layout(&groups)),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[vertices(size_of::<Vertex>() as u64, OWN), vertices(SENT_BYTES, SENT)],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &[Some(RadianceTarget::FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

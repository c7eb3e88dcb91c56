//! Depth, normals and looks of the visible surfaces.

use crate::targets::{GBuffer, PACKED, SURFACE, depth_format};
use umbrage::fullscreen::{UNIFORM, attachment, bind, layout};
use umbrage::{Casters, Gpu, Module, Passes, SeenCasters, SeenSurface, Shader, shader_struct};
use umbrage_core::{CameraView, glam::DMat4};

/// What the G-buffer has of a surface, and how shading reads it.
pub const SURFACE_MODULE: Module = Module { name: "surface", source: include_str!("surface.wgsl") };

/// The shader.
pub const SHADER: Shader = Shader::new("G-buffer", include_str!("gbuffer.wgsl"))
    .with_modules(&[SURFACE_MODULE])
    .with_layouts(&[GBufferView::LAYOUT]);

shader_struct! {
    /// The camera as the vertex shader needs it.
    struct GBufferView {
        clip_from_world: [[f32; 4]; 4],
        eye: [f32; 3],
        spare: f32,
        sight: [f32; 3],
        last_spare: f32,
    }
}

/// Shaders of vertices and of fragments: for surfaces of one colour, textured and masked ones.
const ENTRIES: [[&str; 2]; 3] =
    [["plain_vertex", "plain"], ["textured_vertex", "textured"], ["textured_vertex", "masked"]];

/// Draws the G-buffer.
pub(crate) struct GBufferPass {
    /// For surfaces of one colour, textured ones and those with an alpha mask; each with its back
    /// faces, and without.
    pipelines: [[wgpu::RenderPipeline; 2]; 3],
    seen: SeenCasters,
    uniforms: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl GBufferPass {
    pub fn new(gpu: &Gpu) -> Self {
        let view_layout = layout(gpu, "camera", wgpu::ShaderStages::VERTEX_FRAGMENT, &[UNIFORM]);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniforms = gpu.buffer("camera", &[GBufferView::default()], usage);
        Self {
            pipelines: ENTRIES
                .map(|entry| [None, Some(wgpu::Face::Back)].map(|cull| pipeline(gpu, &view_layout, entry, cull))),
            seen: SeenCasters::default(),
            bind_group: bind(gpu, "camera", &view_layout, &[uniforms.as_entire_binding()]),
            uniforms,
        }
    }

    /// Draws what `camera` sees of the casters.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        passes: &mut Passes<'_>,
        target: &GBuffer,
        casters: &Casters,
        camera: &CameraView,
    ) {
        let clip_from_world = camera.clip_from_world() * DMat4::from_translation(casters.origin());
        self.seen.find(gpu, passes, casters, camera);
        let data = GBufferView {
            clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
            eye: (camera.eye - casters.origin()).as_vec3().to_array(),
            sight: if camera.is_parallel() { camera.forward().as_vec3().to_array() } else { [0.0; 3] },
            ..GBufferView::default()
        };
        passes.upload(&self.uniforms, bytemuck::bytes_of(&data));
        let clear = |view| attachment(view, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: target.stencil_view.as_ref().unwrap_or(&target.depth_view),
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        };
        let targets = [&target.normal_view, &target.surface_view].map(clear);
        let mut pass = passes.render("gbuffer", &targets, Some(depth));
        pass.set_bind_group(0, &self.bind_group, &[]);
        self.seen.draw(&mut pass, casters, |surface: SeenSurface| {
            let look = if surface.masked { 2 } else { usize::from(surface.textured) };
            &self.pipelines[look][usize::from(surface.one_sided)]
        });
    }
}

fn pipeline(
    gpu: &Gpu,
    view_layout: &wgpu::BindGroupLayout,
    [vertex, fragment]: [&str; 2],
    cull_mode: Option<wgpu::Face>,
) -> wgpu::RenderPipeline {
    let module = SHADER.module(gpu);
    let [casters, texture] = &SeenCasters::layouts(gpu);
    let layout = gpu.pipeline_layout(&[Some(view_layout), Some(casters), Some(texture)]);
    gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("G-buffer"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &SeenCasters::vertex_layouts(),
        },
        primitive: wgpu::PrimitiveState { cull_mode, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: depth_format(gpu),
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[PACKED, SURFACE].map(|format| Some(format.into())),
        }),
        multiview_mask: None,
        cache: None,
    })
}

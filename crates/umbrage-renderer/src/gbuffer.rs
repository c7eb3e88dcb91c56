//! Depth, normals and materials of the visible surfaces; ambient and emitted light at once.

use crate::targets::{GBuffer, PACKED, WIDE, depth_format};
use umbrage::fullscreen::{UNIFORM, attachment, bind, layout};
use umbrage::{Casters, Gpu, Passes, SeenCasters, Shader, shader_struct};
use umbrage_core::{CameraView, glam::DMat4};

/// The shader.
pub const SHADER: Shader = Shader::new("G-buffer", include_str!("gbuffer.wgsl")).with_layouts(&[GBufferView::LAYOUT]);

shader_struct! {
    /// The camera as the vertex shader needs it.
    struct GBufferView {
        clip_from_world: [[f32; 4]; 4],
        eye: [f32; 3],
        spare: f32,
        ambient: [f32; 3],
        more_spare: f32,
        sight: [f32; 3],
        last_spare: f32,
    }
}

/// Draws the G-buffer.
pub(crate) struct GBufferPass {
    /// For opaque surfaces and for those with an alpha mask.
    pipelines: [wgpu::RenderPipeline; 2],
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
            pipelines: ["opaque", "masked"].map(|entry| pipeline(gpu, &view_layout, entry)),
            seen: SeenCasters::default(),
            bind_group: bind(gpu, "camera", &view_layout, &[uniforms.as_entire_binding()]),
            uniforms,
        }
    }

    /// Draws what `camera` sees of the casters, with ambient and emitted light.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        passes: &mut Passes<'_>,
        target: &GBuffer,
        casters: &Casters,
        camera: &CameraView,
        ambient: [f32; 3],
    ) {
        let clip_from_world = camera.clip_from_world() * DMat4::from_translation(casters.origin());
        self.seen.find(gpu, passes, casters, camera);
        let data = GBufferView {
            clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
            eye: (camera.eye - casters.origin()).as_vec3().to_array(),
            ambient,
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
        let targets = [&target.normal_view, &target.shading_view, &target.color_view, &target.radiance_view].map(clear);
        let mut pass = passes.render("gbuffer", &targets, Some(depth));
        pass.set_bind_group(0, &self.bind_group, &[]);
        let [opaque, masked] = &self.pipelines;
        self.seen.draw(&mut pass, casters, opaque, masked);
    }
}

fn pipeline(gpu: &Gpu, view_layout: &wgpu::BindGroupLayout, entry: &str) -> wgpu::RenderPipeline {
    let module = SHADER.module(gpu);
    let [casters, texture] = &SeenCasters::layouts(gpu);
    let layout = gpu.pipeline_layout(&[Some(view_layout), Some(casters), Some(texture)]);
    gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("G-buffer"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &SeenCasters::vertex_layouts(),
        },
        primitive: Default::default(),
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
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &[PACKED, WIDE, WIDE, WIDE].map(|format| Some(format.into())),
        }),
        multiview_mask: None,
        cache: None,
    })
}

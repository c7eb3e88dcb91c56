//! The pipelines of passes that draw casters.

use super::{Casters, material::texture_layout, vertices::vertex_layouts};
use crate::gpu::Gpu;

/// What pipelines that draw casters differ in. Group 1 is the casters'.
pub(crate) struct CasterDraw<'a> {
    /// For messages of the driver.
    pub label: &'a str,
    /// Group 0, what casters are drawn into.
    pub view: &'a wgpu::BindGroupLayout,
    /// Group 2 is the texture of a caster, as where it has an alpha mask.
    pub textured: bool,
    /// Group 3; there is a group 2 then.
    pub more: Option<&'a wgpu::BindGroupLayout>,
    /// The shader.
    pub module: &'a wgpu::ShaderModule,
    /// The vertex shader; those called `masked…` read texture coordinates.
    pub vertex: &'a str,
    /// The fragment shader, without which depth alone is written.
    pub fragment: Option<&'a str>,
    /// Pipeline-overridable constants of the fragment shader.
    pub constants: &'a [(&'a str, f64)],
    /// Formats of colours, and how they are blended.
    pub targets: &'a [Option<wgpu::ColorTargetState>],
    /// Tests of depth and stencil.
    pub depth_stencil: Option<wgpu::DepthStencilState>,
    /// Faces that are left out.
    pub cull_mode: Option<wgpu::Face>,
}

impl CasterDraw<'_> {
    /// Makes the pipeline, or finds that of another light.
    pub fn pipeline(&self, gpu: &Gpu) -> wgpu::RenderPipeline {
        let (casters, textures) = (Casters::layout(gpu), texture_layout(gpu));
        let groups = [Some(self.view), Some(&casters), Some(&textures), self.more];
        let count = if self.more.is_some() { 4 } else { 2 + usize::from(self.textured) };
        gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(&gpu.pipeline_layout(&groups[..count])),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(self.vertex),
                compilation_options: Default::default(),
                buffers: &vertex_layouts(self.vertex.starts_with("masked")),
            },
            primitive: wgpu::PrimitiveState { cull_mode: self.cull_mode, ..Default::default() },
            depth_stencil: self.depth_stencil.clone(),
            multisample: Default::default(),
            fragment: self.fragment.map(|entry| wgpu::FragmentState {
                module: self.module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: self.constants,
                    ..Default::default()
                },
                targets: self.targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

//! The pipelines of passes that draw casters.

use super::form::Form;
use super::{Casters, material::texture_layout};
use crate::gpu::Gpu;

/// What pipelines that draw casters differ in. Group 1 is the casters'.
pub(crate) struct CasterDraw<'a> {
    /// For messages of the driver.
    pub label: &'a str,
    /// The buffers that it reads.
    pub form: Form,
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
        let reads_uvs = self.vertex.starts_with("masked");
        let (entry, constants) = (self.form.entry(self.vertex), self.form.constants(reads_uvs));
        let layout = gpu.pipeline_layout(&groups[..count]);
        self.form.with_layouts(reads_uvs, |buffers| {
            let compilation_options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
            let (module, entry_point) = (self.module, Some(&*entry));
            let vertex = wgpu::VertexState { module, entry_point, compilation_options, buffers };
            self.with_vertices(gpu, &layout, vertex)
        })
    }

    fn with_vertices(
        &self,
        gpu: &Gpu,
        layout: &wgpu::PipelineLayout,
        vertex: wgpu::VertexState<'_>,
    ) -> wgpu::RenderPipeline {
        gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(layout),
            vertex,
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

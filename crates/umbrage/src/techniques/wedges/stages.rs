//! A render pipeline of wedges: shaders and what comes between them.

use crate::{fullscreen::front_face, gpu::Gpu};

/// Shaders of a render pipeline and what comes between them.
pub(super) struct Stages<'a> {
    pub module: &'a wgpu::ShaderModule,
    pub vertex: &'a str,
    pub fragment: &'a str,
    pub vertex_constants: &'a [(&'a str, f64)],
    pub fragment_constants: &'a [(&'a str, f64)],
    pub front_face: wgpu::FrontFace,
    pub cull_mode: Option<wgpu::Face>,
    pub unclipped_depth: bool,
}

impl<'a> Stages<'a> {
    pub fn new(module: &'a wgpu::ShaderModule, vertex: &'a str, fragment: &'a str) -> Self {
        let (vertex_constants, fragment_constants): (&[_], &[_]) = (&[], &[]);
        Self {
            module,
            vertex,
            fragment,
            vertex_constants,
            fragment_constants,
            front_face: front_face(false),
            cull_mode: None,
            unclipped_depth: false,
        }
    }

    pub fn pipeline(
        &self,
        gpu: &Gpu,
        groups: &[&wgpu::BindGroupLayout],
        depth_stencil: Option<wgpu::DepthStencilState>,
        target: Option<wgpu::ColorTargetState>,
    ) -> wgpu::RenderPipeline {
        let groups: Vec<_> = groups.iter().map(|g| Some(*g)).collect();
        let layout = gpu.pipeline_layout(&groups);
        let options = |constants| wgpu::PipelineCompilationOptions { constants, ..Default::default() };
        let targets: Vec<_> = target.into_iter().map(Some).collect();
        gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.fragment),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(self.vertex),
                compilation_options: options(self.vertex_constants),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                front_face: self.front_face,
                cull_mode: self.cull_mode,
                unclipped_depth: self.unclipped_depth,
                ..Default::default()
            },
            depth_stencil,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: self.module,
                entry_point: Some(self.fragment),
                compilation_options: options(self.fragment_constants),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// What is behind all of a body is in no wedge.
pub(super) fn compare(tests: bool, reversed: bool) -> wgpu::CompareFunction {
    match (tests, reversed) {
        (false, _) => wgpu::CompareFunction::Always,
        (true, true) => wgpu::CompareFunction::LessEqual,
        (true, false) => wgpu::CompareFunction::GreaterEqual,
    }
}

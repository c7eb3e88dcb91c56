//! What was compiled on a device, as plain data: for tools that compile the same for another one.

use super::Gpu;
use super::shared::{Shared, Stage};
use crate::shader::Shader;

/// A pipeline that techniques have had compiled: [`Gpu::pipelines`].
#[derive(Clone, Debug, PartialEq)]
pub struct PipelineParts {
    /// The entries of its bind groups in order; `None` where there is no group of this number.
    pub groups: Vec<Option<Vec<wgpu::BindGroupLayoutEntry>>>,
    /// Its shaders, and what is fixed between them.
    pub kind: PipelineKind,
}

/// What a pipeline is for.
#[derive(Clone, Debug, PartialEq)]
pub enum PipelineKind {
    /// Compute passes.
    Compute(StageParts),
    /// Render passes.
    Render(Box<RenderParts>),
}

/// A pipeline for render passes.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderParts {
    /// The vertex shader.
    pub vertex: StageParts,
    /// The vertex buffers: bytes from one element to the next, what a step is, and attributes.
    pub buffers: Vec<Option<(u64, wgpu::VertexStepMode, Vec<wgpu::VertexAttribute>)>>,
    /// How vertices become triangles.
    pub primitive: wgpu::PrimitiveState,
    /// Depth and stencil, where there are any.
    pub depth_stencil: Option<wgpu::DepthStencilState>,
    /// Samples of a pixel.
    pub multisample: wgpu::MultisampleState,
    /// The fragment shader and its targets, where there is one.
    pub fragment: Option<(StageParts, Vec<Option<wgpu::ColorTargetState>>)>,
}

/// A shader in a pipeline.
#[derive(Clone, Debug, PartialEq)]
pub struct StageParts {
    /// The file that the shader is named for.
    pub name: &'static str,
    /// The whole WGSL.
    pub text: String,
    /// The entry point; `None` where the shader has one alone.
    pub entry: Option<String>,
    /// Values of pipeline-overridable constants by name.
    pub constants: Vec<(String, f64)>,
    /// Whether workgroup memory starts as zeroes.
    pub zeroes: bool,
}

impl Gpu {
    /// The pipelines that this value and its clones have compiled so far, in no particular order;
    /// those with text of a host's in them are left out.
    pub fn pipelines(&self) -> Vec<PipelineParts> {
        let shared = &*self.shared;
        let compute = shared.compute.keys().into_iter().filter_map(|(layout, stage)| {
            let kind = PipelineKind::Compute(shared.stage_parts(&stage)?);
            Some(PipelineParts { groups: shared.groups_of(layout.as_ref())?, kind })
        });
        let render = shared.render.keys().into_iter().filter_map(|made| {
            let fragment = match made.fragment {
                Some((stage, targets)) => Some((shared.stage_parts(&stage)?, targets)),
                None => None,
            };
            let parts = RenderParts {
                vertex: shared.stage_parts(&made.vertex)?,
                buffers: made.buffers,
                primitive: made.primitive,
                depth_stencil: made.depth_stencil,
                multisample: made.multisample,
                fragment,
            };
            let kind = PipelineKind::Render(Box::new(parts));
            Some(PipelineParts { groups: shared.groups_of(made.layout.as_ref())?, kind })
        });
        compute.chain(render).collect()
    }
}

impl Shared {
    fn stage_parts(&self, stage: &Stage) -> Option<StageParts> {
        let (name, source, modules) = self.modules.key_of(&stage.module)?;
        let text = Shader::new(name, source).with_modules(modules).text().ok()?;
        let constants = stage.constants.iter().map(|(name, bits)| (name.clone(), f64::from_bits(*bits))).collect();
        Some(StageParts { name, text, entry: stage.entry.clone(), constants, zeroes: stage.zeroes })
    }

    fn groups_of(&self, layout: Option<&wgpu::PipelineLayout>) -> Option<Vec<Option<Vec<wgpu::BindGroupLayoutEntry>>>> {
        // Pipelines that bind nothing have none.
        let Some(layout) = layout else { return Some(Vec::new()) };
        let groups = self.pipeline_layouts.key_of(layout)?;
        let entries = |group: Option<wgpu::BindGroupLayout>| match group {
            Some(group) => self.bind_group_layouts.key_of(&group).map(Some),
            None => Some(None),
        };
        groups.into_iter().map(entries).collect()
    }
}

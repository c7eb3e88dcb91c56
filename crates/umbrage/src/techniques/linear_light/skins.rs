//! Skins from steps in maps.

use super::channel::{NONE, least};
use super::options::{LinearLight, Shares};
use super::pictures;
use super::steps::{GROUP, INDICES, MAPS, StepList};
use super::uniform::VIEWS;
use crate::fullscreen::{STORAGE, UNIFORM, additive, bind, layout};
use crate::gpu::Gpu;
use crate::shader::HostConstant;

/// What `step_skins.wgsl` and its modules call them.
pub(super) const CONSTANTS: &[HostConstant] =
    &[("GROUP", GROUP as f64), ("INDICES", INDICES as f64), ("VIEWS", VIEWS as f64), ("NONE", NONE)];

/// The pipeline and what all draws share.
pub(super) struct Skins {
    /// Of the point whose steps are drawn: list, maps, views.
    source: wgpu::BindGroupLayout,
    /// Into a channel, and into a picture of it.
    pipelines: [wgpu::RenderPipeline; 2],
    indices: wgpu::Buffer,
}

impl Skins {
    /// `into` is the layout of what skins are drawn into.
    pub fn new(gpu: &Gpu, settings: &LinearLight, into: &wgpu::BindGroupLayout) -> Self {
        let source = layout(gpu, "steps of a point", wgpu::ShaderStages::VERTEX, &[STORAGE, MAPS, UNIFORM]);
        let share = match settings.shares {
            Shares::Exact => "exact_share",
            Shares::Linear => "linear_share",
        };
        Self {
            pipelines: [
                pipeline(gpu, settings, [&source, into], share, least()),
                pipeline(gpu, settings, [&source, into], "shown_skin", additive(pictures::FORMAT)),
            ],
            indices: gpu.buffer("corners of skins", &corners(), wgpu::BufferUsages::INDEX),
            source,
        }
    }

    /// For the steps in a point's maps.
    pub fn bind(&self, gpu: &Gpu, list: &StepList, [maps, point]: [wgpu::BindingResource<'_>; 2]) -> wgpu::BindGroup {
        bind(gpu, "steps of a point", &self.source, &[list.buffer.as_entire_binding(), maps, point])
    }

    /// Draws the steps of another point into a layer, or into a picture of that.
    pub fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        (source, list): (&wgpu::BindGroup, &StepList),
        into: &wgpu::BindGroup,
        is_picture: bool,
    ) {
        pass.set_pipeline(&self.pipelines[usize::from(is_picture)]);
        pass.set_bind_group(0, source, &[]);
        pass.set_bind_group(3, into, &[]);
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
        pass.draw_indexed_indirect(&list.buffer, 0);
    }

    pub fn bytes(&self) -> u64 {
        self.indices.size()
    }
}

/// Two triangles for each of [`GROUP`] quads.
fn corners() -> Vec<u16> {
    (0..GROUP as u16).flat_map(|i| [0, 1, 2, 0, 2, 3].map(|corner| 4 * i + corner)).collect()
}

fn pipeline(
    gpu: &Gpu,
    settings: &LinearLight,
    [source, into]: [&wgpu::BindGroupLayout; 2],
    entry: &str,
    target: wgpu::ColorTargetState,
) -> wgpu::RenderPipeline {
    let module = super::STEP_SKINS.module(gpu);
    let pipeline_layout = gpu.pipeline_layout(&[Some(source), None, None, Some(into)]);
    let threshold = [("THRESHOLD", settings.threshold)];
    gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("skins"),
        layout: Some(&pipeline_layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("step_skin"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[("ENDLESS", f64::from(u8::from(settings.shares == Shares::Exact)))],
                ..Default::default()
            },
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: if entry == "shown_skin" { &[] } else { &threshold },
                ..Default::default()
            },
            targets: &[Some(target)],
        }),
        multiview_mask: None,
        cache: None,
    })
}

//! Finding silhouettes by compute.

use super::buffers::{Buffers, FindSilhouettes};
use super::shape::{Part, Shape};
use super::work::Work;
use crate::casters::{Edges, Reads};
use crate::compute::compute_pipeline;
use crate::fullscreen::{STORAGE, UNIFORM, layout};
use crate::shader::Shader;
use crate::{gpu::Gpu, passes::Passes};
use std::ops::Range;

/// Finds what bounds a shadow, by compute.
pub(crate) const FIND_SHADER: Shader =
    Shader::new("find silhouettes", include_str!("find_silhouettes.wgsl")).with_layouts(&[FindSilhouettes::LAYOUT]);

/// Workgroups in a row, the most that every adapter allows.
const ROW: u32 = 65_535;

pub(super) struct Find {
    layout: wgpu::BindGroupLayout,
    sides: wgpu::ComputePipeline,
    caps: wgpu::ComputePipeline,
    group: wgpu::ComputePipeline,
}

impl Find {
    pub fn new(gpu: &Gpu) -> Self {
        let written = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: false },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let bindings = [STORAGE, written, written, UNIFORM];
        let layout = layout(gpu, "find silhouettes", wgpu::ShaderStages::COMPUTE, &bindings);
        let module = FIND_SHADER.module(gpu);
        let edges = Reads::Sides.layout(gpu);
        let groups = [Some(&layout), Some(&edges)];
        let pipeline = |entry| compute_pipeline(gpu, &module, entry, &groups, &[]);
        Self { sides: pipeline("find_sides"), caps: pipeline("find_caps"), group: pipeline("group_entries"), layout }
    }

    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    pub fn record(&self, passes: &mut Passes<'_>, buffers: &Buffers, edges: &Edges, work: &Work, shape: Shape) {
        let Some(bind_group) = &buffers.find else { return };
        let triangle_chunks = work.triangle_chunks();
        let edge_chunks = work.edge_chunks;
        let uniform =
            FindSilhouettes { edge_chunks, triangle_chunks, weighted: shape.weighted.into(), ..Default::default() };
        passes.upload(&buffers.find_uniform, bytemuck::bytes_of(&uniform));
        let arguments = Part::ALL.map(|part| {
            let Range { start, end } = shape.indices(part);
            [end - start, 0, start, part.first_vertex(), 0]
        });
        passes.upload(&buffers.arguments, bytemuck::cast_slice(&arguments));
        let mut pass = passes.compute("silhouettes");
        pass.set_bind_group(0, bind_group, &[]);
        pass.set_bind_group(1, edges.group(Reads::Sides), &[]);
        for (pipeline, groups) in [(&self.sides, edge_chunks), (&self.caps, triangle_chunks), (&self.group, 1)] {
            if groups > 0 {
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(groups.min(ROW), groups.div_ceil(ROW), 1);
            }
        }
    }
}

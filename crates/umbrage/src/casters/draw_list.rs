//! Which instances a view draws.

use super::{Casters, Placed};
use crate::{gpu::Gpu, passes::Passes};
use std::ops::Range;
use umbrage_core::glam::{DVec3, DVec4};
use umbrage_core::{Bounds, Frustum};

/// Which instances a draw list is about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Which {
    /// All of them.
    Visible,
    /// Those that throw shadows.
    Casting,
    /// Those whose shadow can fall on something.
    Shadowing(Light),
}

/// A light and what its shadows may fall on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Light {
    /// Its centre, homogeneous: see [`umbrage_core::LightShape::center`].
    pub center: DVec4,
    /// A box around all receivers.
    pub receivers: Bounds,
}

impl Placed {
    /// True where the instance is flat and all receivers are on the light's side of it: a floor that everything stands on
    /// shadows nothing, and need not be drawn into a map.
    pub(crate) fn shadows_nothing(&self, light: &Light) -> bool {
        let Some(plane) = self.plane else { return false };
        let side = plane.dot(light.center);
        let rounding = 1e-9 * light.receivers.largest_coordinate();
        let beyond = |p: DVec3| side.signum() * plane.dot(p.extend(1.0)) < -rounding;
        side != 0.0 && !light.receivers.corners().into_iter().any(beyond)
    }

    fn is_in(&self, which: &Which) -> bool {
        match which {
            Which::Visible => true,
            Which::Casting => self.casts,
            Which::Shadowing(light) => self.casts && !self.shadows_nothing(light),
        }
    }
}

/// What one view draws: filled on the CPU, uploaded when recorded. Keeps its memory from frame to frame.
#[derive(Default)]
pub(crate) struct DrawList {
    ids: Vec<u32>,
    draws: Vec<(usize, Range<u32>)>,
    buffer: Option<wgpu::Buffer>,
    /// Instances that the view doesn't see.
    pub culled: u32,
}

impl DrawList {
    /// Chooses the instances that `frustum` may see.
    pub fn fill(&mut self, gpu: &Gpu, casters: &Casters, which: Which, frustum: &Frustum) {
        self.ids.clear();
        self.draws.clear();
        self.culled = 0;
        for (i, batch) in casters.batches.iter().enumerate() {
            let first = self.ids.len() as u32;
            for placed in &casters.placed[batch.members.clone()] {
                if !placed.is_in(&which) {
                    continue;
                }
                if frustum.may_see(&placed.bounds) {
                    self.ids.push(placed.number);
                } else {
                    self.culled += 1;
                }
            }
            if self.ids.len() as u32 > first && !batch.indices.is_empty() {
                self.draws.push((i, first..self.ids.len() as u32));
            }
        }
        let needed = (casters.placed.len() as u64 * 4).max(16);
        if self.buffer.as_ref().is_none_or(|b| b.size() < needed) {
            self.buffer = Some(gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("instance numbers"),
                size: needed,
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
    }

    /// Uploads the list; before the pass that draws it.
    pub fn upload(&self, passes: &mut Passes<'_>) {
        if let Some(buffer) = &self.buffer {
            passes.upload(buffer, bytemuck::cast_slice(&self.ids));
        }
    }

    /// Draws the list with positions in vertex buffer 0, instance numbers in 1 and attributes in 2. `pipeline` chooses
    /// the pipeline of opaque (false) and alpha-masked (true) meshes; textures are bound as group 2 for the latter,
    /// and for all where `textured`.
    pub fn draw<'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        casters: &Casters,
        textured: bool,
        pipeline: impl Fn(bool) -> &'p wgpu::RenderPipeline,
    ) {
        let Some(ids) = &self.buffer else { return };
        pass.set_bind_group(1, &casters.bind_group, &[]);
        pass.set_vertex_buffer(0, casters.positions.slice(..));
        pass.set_vertex_buffer(1, ids.slice(..));
        pass.set_vertex_buffer(2, casters.attributes.slice(..));
        pass.set_index_buffer(casters.indices.slice(..), wgpu::IndexFormat::Uint32);
        let mut current = None;
        for (batch, instances) in &self.draws {
            let batch = &casters.batches[*batch];
            if current != Some(batch.masked) {
                current = Some(batch.masked);
                pass.set_pipeline(pipeline(batch.masked));
            }
            if textured || batch.masked {
                pass.set_bind_group(2, &casters.textures[batch.texture], &[]);
            }
            pass.draw_indexed(batch.indices.clone(), batch.base_vertex, instances.clone());
        }
    }

    /// Draw calls.
    pub fn draws(&self) -> u32 {
        self.draws.len() as u32
    }

    /// Instances drawn.
    pub fn drawn(&self) -> u32 {
        self.ids.len() as u32
    }

    /// Triangles drawn.
    pub fn triangles(&self, casters: &Casters) -> u64 {
        let of = |(batch, ids): &(usize, Range<u32>)| {
            u64::from(casters.batches[*batch].indices.len() as u32 / 3) * u64::from(ids.end - ids.start)
        };
        self.draws.iter().map(of).sum()
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        self.buffer.as_ref().map_or(0, wgpu::Buffer::size)
    }
}

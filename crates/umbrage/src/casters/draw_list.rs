//! Which instances a view draws.

use super::form::{Form, MATRICES, NUMBERS};
use super::placed::Placed;
use super::world::Casters;
use crate::{gpu::Gpu, passes::Passes};
use std::ops::Range;
use umbrage_core::Bounds;
use umbrage_core::glam::{DVec3, DVec4};

/// A light and what its shadows may fall on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Light {
    /// Its centre, homogeneous: see [`umbrage_core::LightShape::center`].
    pub center: DVec4,
    /// A box around all receivers.
    pub receivers: Bounds,
}

impl Placed {
    /// True where the instance is flat and all receivers are on the light's side of it: a floor
    /// that everything stands on shadows nothing, and need not be drawn into a map.
    pub(crate) fn shadows_nothing(&self, light: &Light) -> bool {
        let Some(plane) = self.plane else { return false };
        let side = plane.dot(light.center);
        let rounding = 1e-9 * light.receivers.largest_coordinate();
        let beyond = |p: DVec3| side.signum() * plane.dot(p.extend(1.0)) < -rounding;
        side != 0.0 && !light.receivers.corners().into_iter().any(beyond)
    }
}

/// The numbers of the instances that the views of a frame draw: filled on the CPU, all in one
/// buffer that is uploaded once. Keeps its memory from frame to frame.
#[derive(Default)]
pub(crate) struct InstanceNumbers {
    numbers: Vec<u32>,
    /// Members of each batch, open ones and solid ones; then where the next one goes.
    slots: Vec<[u32; 2]>,
    buffer: Option<wgpu::Buffer>,
}

/// What a view draws: a part of the numbers for each batch, or two.
#[derive(Default)]
pub(crate) struct DrawList {
    draws: Vec<Draw>,
}

struct Draw {
    batch: u32,
    surface: Surface,
    instances: Range<u32>,
}

/// What pipelines differ in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Surface {
    /// Opaque, and its back faces hide nothing that its front faces don't.
    Solid,
    /// Opaque.
    Open,
    /// Alpha-masked.
    Masked,
}

impl InstanceNumbers {
    /// Starts a frame in which every instance may be in so many lists.
    pub fn clear(&mut self, gpu: &Gpu, casters: &Casters, lists: u32) {
        self.numbers.clear();
        let needed = (casters.len() as u64 * u64::from(lists) * 4).max(16);
        if self.buffer.as_ref().is_none_or(|b| b.size() < needed) {
            // Half as much again where it grew, or instances that come would make it grow all the
            // time.
            let needed = if self.buffer.is_some() { needed + needed / 8 * 4 } else { needed };
            self.buffer = Some(gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("instance numbers"),
                size: needed,
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
    }

    /// Lists instances, by their places, for one view; but for those that can shadow nothing where
    /// a light is given. Solid ones that are not among `pierced`, in order, can do without their
    /// back faces; all need them where that is `None`.
    pub fn list(
        &mut self,
        casters: &Casters,
        places: &[u32],
        light: Option<&Light>,
        pierced: Option<&[u32]>,
        list: &mut DrawList,
    ) {
        list.clear();
        self.slots.clear();
        self.slots.resize(casters.batches.end(), [0; 2]);
        let is_idle = |placed: &Placed| light.is_some_and(|light| placed.shadows_nothing(light));
        let is_solid = |place: u32| {
            casters.solid.has(place) && pierced.is_some_and(|pierced| pierced.binary_search(&place).is_err())
        };
        let drawn = || {
            let all = places.iter().map(|place| (*place, &casters.placed[*place as usize]));
            all.filter(|(_, placed)| !is_idle(placed)).map(|(place, placed)| (place, placed.batch as usize))
        };
        drawn().for_each(|(place, batch)| self.slots[batch][usize::from(is_solid(place))] += 1);
        let mut next = self.numbers.len() as u32;
        for &number in casters.batches.order() {
            let (batch, slots) = (casters.batches.get(number), &mut self.slots[number as usize]);
            let many = batch.many.and_then(|place| casters.placed[place as usize].many.as_ref());
            let count = many.map_or(1, |many| many.matrices.count);
            let is_empty = casters.meshes()[batch.mesh as usize].index_count() == 0 || count == 0;
            let open = if batch.masked { Surface::Masked } else { Surface::Open };
            for (slot, surface) in slots.iter_mut().zip([open, Surface::Solid]) {
                let first = next;
                next += std::mem::replace(slot, first);
                if next > first && !is_empty {
                    list.draws.push(Draw { batch: number, surface, instances: first..next });
                }
            }
        }
        self.numbers.resize(next as usize, 0);
        for (place, batch) in drawn() {
            let slot = &mut self.slots[batch][usize::from(is_solid(place))];
            self.numbers[*slot as usize] = place;
            *slot += 1;
        }
    }

    /// Uploads the lists; before the first pass that draws one.
    pub fn upload(&self, passes: &mut Passes<'_>) {
        if let Some(buffer) = &self.buffer {
            passes.upload(buffer, bytemuck::cast_slice(&self.numbers));
        }
    }

    /// Draws a list with positions in vertex buffer 0, instance numbers in 1, attributes in 2 and
    /// matrices of a host's in 3, each surface, with and without a texture, and form of buffers
    /// with its `pipeline`; nothing where there is none. Textures are bound as group 2 for
    /// alpha-masked meshes, and for all where `textured`.
    pub fn draw<'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        casters: &Casters,
        list: &DrawList,
        textured: bool,
        pipeline: impl Fn(Surface, bool, &Form) -> Option<&'p wgpu::RenderPipeline>,
    ) {
        let Some(numbers) = &self.buffer else { return };
        pass.set_bind_group(1, &casters.bind_group, &[]);
        let (mut current, mut bound, mut has_numbers) = (None, None, false);
        for Draw { batch, surface, instances } in &list.draws {
            let batch = casters.batches.get(*batch);
            let part = &casters.meshes()[batch.mesh as usize];
            let many = batch.many.and_then(|place| casters.placed[place as usize].many.as_ref());
            let form = part.form(many.map(|many| &many.matrices));
            let has_texture = batch.texture.is_some();
            let Some(pipeline) = pipeline(*surface, has_texture, &form) else { continue };
            if current != Some((*surface, has_texture, form)) {
                current = Some((*surface, has_texture, form));
                pass.set_pipeline(pipeline);
            }
            let reads_uvs = textured || batch.masked;
            // The library's meshes are parts of the same buffers.
            let source = (part.lent.is_some().then_some(batch.mesh), reads_uvs);
            if bound != Some(source) {
                bound = Some(source);
                casters.geometry.bind(pass, part, reads_uvs);
            }
            if reads_uvs {
                pass.set_bind_group(2, casters.appearance.group(batch.texture), &[]);
            }
            let Some(many) = many else {
                if !std::mem::replace(&mut has_numbers, true) {
                    pass.set_vertex_buffer(NUMBERS, numbers.slice(..));
                }
                pass.draw_indexed(part.drawn(), part.drawn_from(), instances.clone());
                continue;
            };
            has_numbers = false;
            pass.set_vertex_buffer(NUMBERS, numbers.slice(4 * u64::from(instances.start)..));
            pass.set_vertex_buffer(MATRICES, many.matrices.buffer.slice(many.matrices.offset..));
            pass.draw_indexed(part.drawn(), part.drawn_from(), 0..many.matrices.count);
        }
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        self.buffer.as_ref().map_or(0, wgpu::Buffer::size)
    }
}

impl DrawList {
    /// Draws nothing.
    pub fn clear(&mut self) {
        self.draws.clear();
    }

    /// Draw calls.
    pub fn draws(&self) -> u32 {
        self.draws.len() as u32
    }

    /// Instances drawn.
    pub fn drawn(&self) -> u32 {
        self.draws.iter().map(|draw| draw.instances.end - draw.instances.start).sum()
    }

    /// Triangles drawn.
    pub fn triangles(&self, casters: &Casters) -> u64 {
        let of = |Draw { batch, instances, .. }: &Draw| {
            let batch = casters.batches.get(*batch);
            let many = batch.many.and_then(|place| casters.placed[place as usize].many.as_ref());
            let count = many.map_or(instances.end - instances.start, |many| many.matrices.count);
            u64::from(casters.meshes()[batch.mesh as usize].index_count() / 3) * u64::from(count)
        };
        self.draws.iter().map(of).sum()
    }
}

//! The edges and triangles of casters that bound their shadows under one light, found on the CPU,
//! in vertex shaders, or by compute and drawn indirectly; with the vertex shaders that extrude
//! them.
//!
//! Casters are described in [`Caster`]s, their edges in chunks of 64 that name their caster. What
//! is drawn is a list of 32-bit entries, so that the CPU touches no edge in the compute path,
//! whatever the number of casters.

mod buffers;
mod caster;
mod find;
mod shape;
mod work;

use crate::casters::{Edges, Reads};
use crate::choices;
use crate::fullscreen::{STORAGE, UNIFORM, layout};
use crate::shader::Shared;
use crate::{casters::Casters, error::Error, gpu::Gpu, passes::Passes};
pub(crate) use buffers::casters_layout;
use buffers::{ARGUMENTS, Buffers, Extrusion};
pub(crate) use caster::Throw;
use caster::{Caster, FLAGS};
pub(crate) use find::FIND_SHADER;
use find::Find;
pub(crate) use shape::{Part, Style};
use shape::{Shape, VERTICES, indices};
use std::ops::Range;
use umbrage_core::glam::{DMat4, DVec4};
use work::Work;

/// What the host has to agree on with the modules that extrude what was found.
pub(crate) const SHARED: &[Shared] = &[
    Shared { module: "edges", layouts: &[Caster::LAYOUT], constants: FLAGS },
    Shared { module: "extrude", layouts: &[Extrusion::LAYOUT], constants: &[("PART", VERTICES as f64)] },
];

choices! {
    /// Where silhouettes are found.
    pub enum Extrude {
        /// By compute shaders that list them on the GPU.
        Compute = "compute",
        /// Every edge is drawn, and vertex shaders collapse those that bound no shadow.
        Vertex = "vertex",
        /// By the CPU, every frame.
        Cpu = "cpu",
    }
}

/// Silhouettes of one light's casters.
pub(crate) struct Silhouettes {
    extrude: Extrude,
    find: Option<Find>,
    work: Work,
    shape: Shape,
    extrusion: Extrusion,
    indices: wgpu::Buffer,
    draw_layout: wgpu::BindGroupLayout,
    buffers: Option<Buffers>,
}

impl Silhouettes {
    /// Makes pipelines; buffers follow.
    pub fn new(gpu: &Gpu, extrude: Extrude) -> Self {
        let storage = [STORAGE; 2];
        let stages = wgpu::ShaderStages::VERTEX | wgpu::ShaderStages::COMPUTE;
        Self {
            extrude,
            find: (extrude == Extrude::Compute).then(|| Find::new(gpu)),
            work: Work::default(),
            shape: Shape::default(),
            extrusion: Extrusion::default(),
            indices: gpu.buffer("corners of sides and caps", &indices(), wgpu::BufferUsages::INDEX),
            draw_layout: layout(gpu, "silhouettes", stages, &[&storage[..], &[UNIFORM]].concat()),
            buffers: None,
        }
    }

    /// The layout of [`Silhouettes::found_by_gpu`].
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.draw_layout
    }

    /// Names of the vertex shaders for sides and for caps.
    pub fn entries(&self) -> [&'static str; 2] {
        if self.extrude == Extrude::Vertex { ["any_side", "any_cap"] } else { ["listed_side", "listed_cap"] }
    }

    /// The layout of pipelines that draw a part.
    pub fn pipeline_layout(&self, gpu: &Gpu, part: Part) -> wgpu::PipelineLayout {
        gpu.pipeline_layout(&[Some(&self.draw_layout), Some(&self.reads(part).layout(gpu))])
    }

    /// What the vertex shaders of a part read.
    fn reads(&self, part: Part) -> Reads {
        match (part, self.extrude) {
            (Part::Caps, _) => Reads::Triangles,
            (_, Extrude::Vertex) => Reads::AllEdges,
            _ => Reads::Edges,
        }
    }

    /// Describes the casters of a frame: first all that are counted from the eye, then the others.
    /// With the camera's matrix goes whether near is 1. `light`: its centre, homogeneous.
    ///
    /// # Errors
    /// [`Error::Size`] where there are too many edges.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        casters: &Casters,
        (clip_from_world, reversed): (&DMat4, bool),
        light: DVec4,
        throws: &[Throw],
        style: Style,
    ) -> Result<(), Error> {
        let edges = casters.edges(gpu)?;
        if self.extrude == Extrude::Cpu {
            casters.check_told(throws.iter().map(|throw| throw.place))?;
        }
        let origin = casters.origin();
        self.shape = Shape::of(light, throws, style);
        let clip_from_origin = *clip_from_world * DMat4::from_translation(origin);
        self.extrusion = Extrusion {
            clip_from_world: clip_from_origin.as_mat4().to_cols_array_2d(),
            light: (light.truncate() - origin * light.w).extend(light.w).as_vec4().to_array(),
            // A few roundings of a depth that is reversed, and so relative, or of one that is not.
            away: if reversed { [-4e-7, 0.0] } else { [0.0, 2.4e-7] },
            ..Extrusion::default()
        };
        self.work.clear();
        for throw in throws {
            self.work.add(casters, edges, throw, self.shape.weighted);
        }
        self.work.finish(self.shape)?;
        if self.extrude == Extrude::Cpu {
            self.work.list(edges, casters, throws, self.shape);
        }
        self.make_room(gpu)
    }

    fn make_room(&mut self, gpu: &Gpu) -> Result<(), Error> {
        let needs = self.work.needs(self.extrude != Extrude::Vertex);
        if self.buffers.as_ref().is_none_or(|b| !b.hold(&needs)) {
            let find = self.find.as_ref().map(Find::layout);
            self.buffers = Some(Buffers::new(gpu, &needs, &self.draw_layout, find)?);
        }
        Ok(())
    }

    /// Uploads, and finds silhouettes where that is done by compute. Before the pass that draws.
    pub fn record(&self, passes: &mut Passes<'_>, edges: &Edges) {
        let Some(buffers) = &self.buffers else { return };
        passes.upload(&buffers.extrusion, bytemuck::bytes_of(&self.extrusion));
        passes.upload(&buffers.casters, bytemuck::cast_slice(&self.work.casters));
        passes.upload(&buffers.list, bytemuck::cast_slice(&self.work.list));
        if let Some(find) = &self.find {
            find.record(passes, buffers, edges, &self.work, self.shape);
        }
    }

    /// Draws a part with the pipeline that is set.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, edges: &Edges, part: Part) {
        let Some(buffers) = &self.buffers else { return };
        pass.set_bind_group(0, &buffers.draw, &[]);
        pass.set_bind_group(1, edges.group(self.reads(part)), &[]);
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
        let indices = self.shape.indices(part);
        match self.extrude {
            Extrude::Compute => pass.draw_indexed_indirect(&buffers.arguments, part as u64 * ARGUMENTS),
            Extrude::Cpu => pass.draw_indexed(indices, part.first_vertex() as i32, self.work.listed(part)),
            Extrude::Vertex => {
                for again in 0..self.work.repeats(part, self.shape) {
                    pass.draw_indexed(indices.clone(), (again * VERTICES) as i32, self.work.all(part));
                }
            }
        }
    }

    /// What compute shaders take as group 0 to read casters and what was found; group 1 is of
    /// [`Edges::group`].
    pub fn found_by_gpu(&self) -> Option<&wgpu::BindGroup> {
        self.buffers.as_ref().map(|b| &b.draw)
    }

    /// The same for casters alone, see [`casters_layout`].
    pub fn casters_on_gpu(&self) -> Option<&wgpu::BindGroup> {
        self.buffers.as_ref().map(|b| &b.casters_alone)
    }

    /// Sides that may be found at most.
    pub fn room(&self, part: Part) -> u32 {
        self.work.room(part)
    }

    /// Arguments of an indirect draw of a part with a quad for each side, whatever draws it.
    pub fn arguments(&self, part: Part) -> Option<(&wgpu::Buffer, u64)> {
        self.buffers.as_ref().map(|b| (&b.arguments, part as u64 * ARGUMENTS))
    }

    /// The indices that go with them.
    pub fn corner_indices(&self) -> &wgpu::Buffer {
        &self.indices
    }

    /// True where a part has nothing to draw, as far as the CPU knows.
    pub fn is_empty(&self, part: Part) -> bool {
        self.work.all(part).is_empty()
    }

    /// Bytes of GPU memory, without those of [`Edges`].
    pub fn bytes(&self) -> u64 {
        self.indices.size() + self.buffers.as_ref().map_or(0, Buffers::bytes)
    }

    /// Edges, and triangles of caps, that are looked at.
    pub fn looked_at(&self) -> (u64, u64) {
        self.work.looked_at()
    }

    /// Numbers of sides (from the eye, from infinity) and caps that were found, where the CPU found
    /// them.
    pub fn found(&self) -> Option<[u32; 3]> {
        (self.extrude == Extrude::Cpu).then(|| self.work.counts())
    }

    /// Of each caster the numbers of its sides, where the CPU found them.
    pub fn sides(&self) -> &[Range<u32>] {
        &self.work.sides
    }

    /// The edge of a caster's mesh that a side belongs to, and whether it counts twice.
    pub fn side(&self, caster: usize, number: u32) -> (u32, bool) {
        self.work.side(caster, number)
    }
}

//! The edges and triangles of casters that bound their shadows under one light, found on the CPU, in vertex shaders, or by
//! compute and drawn indirectly; with the vertex shaders that extrude them.
//!
//! Casters are described in [`Caster`]s, their edges in chunks of 64 that name their caster. What is drawn is a list of
//! 32-bit entries, so that the CPU touches no edge in the compute path, whatever the number of casters.

mod find;
mod work;

use crate::casters::Edges;
use crate::choices;
use crate::fullscreen::{STORAGE, UNIFORM, layout};
use crate::shader::{HostConstant, Shader, Shared, shader_struct};
use crate::{casters::Casters, error::Error, gpu::Gpu, passes::Passes};
use find::Find;
use std::ops::Range;
use umbrage_core::glam::{DMat4, DVec4, Vec3};
use umbrage_core::silhouette::{Rule, light_in_mesh};
use work::{Buffers, Work};

/// Finds what bounds a shadow, by compute.
pub(crate) const FIND_SHADER: Shader = Shader::new("find silhouettes", include_str!("find_silhouettes.wgsl"))
    .with_layouts(&[find::FindSilhouettes::LAYOUT]);

/// What the host has to agree on with the modules that extrude what was found.
pub(crate) const SHARED: &[Shared] = &[
    Shared { module: "edges", layouts: &[Caster::LAYOUT], constants: FLAGS },
    Shared { module: "extrude", layouts: &[Extrusion::LAYOUT], constants: &[] },
];

shader_struct! {
    /// A caster under one light, see `casters/edges.wgsl`.
    pub(crate) struct Caster {
        light: [f32; 4],
        end: [f32; 4],
        first_edge: u32,
        edge_count: u32,
        edge_chunk: u32,
        first_triangle: u32,
        triangle_count: u32,
        triangle_chunk: u32,
        first_index: u32,
        base_vertex: u32,
        instance: u32,
        flags: u32,
        reach: f32,
        pad: u32,
        seen_from: [f32; 3],
        pad_seen_from: f32,
        axis: [f32; 3],
        pad_axis: f32,
    }
}

shader_struct! {
    /// What the vertex shaders need of camera and light, see `extrude.wgsl`.
    pub(crate) struct Extrusion {
        clip_from_world: [[f32; 4]; 4],
        light: [f32; 4],
        away: [f32; 2],
        pad: [f32; 2],
    }
}

/// Bits of `Caster::flags`.
const AWAY: u32 = 1;
const MIRRORED: u32 = 2;
const Z_FAIL: u32 = 4;
const LIGHT_CAP: u32 = 8;
const DARK_CAP: u32 = 16;
const BODY: u32 = 32;
const COUNT_FROM_INFINITY: u32 = 64;

/// Edges, or triangles, of one caster that go together.
const CHUNK: u32 = 64;

/// The same for `casters/edges.wgsl`.
const FLAGS: &[HostConstant] = &[
    ("AWAY", AWAY as f64),
    ("MIRRORED", MIRRORED as f64),
    ("Z_FAIL", Z_FAIL as f64),
    ("LIGHT_CAP", LIGHT_CAP as f64),
    ("DARK_CAP", DARK_CAP as f64),
    ("BODY", BODY as f64),
    ("COUNT_FROM_INFINITY", COUNT_FROM_INFINITY as f64),
    ("CHUNK", CHUNK as f64),
];

/// Vertex numbers of one part end before those of the next one start.
const VERTICES: u32 = 512;

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

/// A caster to extrude.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Throw {
    /// Its number in [`Casters::placed`].
    pub place: u32,
    /// From where its silhouette is seen: a place of the light, or a direction to it (w = 0).
    pub light: DVec4,
    pub rule: Rule,
    /// A body with holes: what it covers with its near side and with its far side is nearly the same and counts once.
    pub is_body: bool,
    /// Wedges only: counted from infinity instead of from the eye.
    pub from_infinity: bool,
    /// Volumes only: the same, with sides in a part of their own; needs caps.
    pub z_fail: bool,
    pub light_cap: bool,
    pub dark_cap: bool,
    /// The plane n · p = w where the shadow may end since nothing that is seen lies beyond, in world space; zero for none.
    pub end: DVec4,
    /// Where the shadow ends otherwise, metres from the light; 0 for nowhere.
    pub reach: f32,
    /// Wedges only, in the light's own space: from where the silhouette is seen, and the x axis of a piece of a sphere.
    pub anchor: [Vec3; 2],
}

/// How sides and caps are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Sides are triangles that meet infinitely far away, those counted from the eye and those counted from infinity.
    pub parallel: [bool; 2],
    /// Some cap is a dark one.
    pub dark_caps: bool,
    /// Sides that count twice are drawn once, with that weight.
    pub weighted: bool,
}

impl Shape {
    fn of(light: DVec4, throws: &[Throw], style: Style) -> Self {
        let parallel = |z_fail| {
            let mut own = throws.iter().filter(|t| t.z_fail == z_fail);
            light.w == 0.0 && !style.quads && own.all(|t| t.end == DVec4::ZERO)
        };
        Self {
            parallel: [false, true].map(parallel),
            dark_caps: throws.iter().any(|t| t.z_fail && t.dark_cap),
            weighted: style.weighted,
        }
    }

    /// True where the sides of a part are triangles.
    pub fn is_parallel(self, part: Part) -> bool {
        part != Part::Caps && self.parallel[part as usize]
    }

    /// The indices of a group of the part's entries, see [`indices`].
    fn indices(self, part: Part) -> Range<u32> {
        match (part, self.dark_caps) {
            (Part::Caps, true) => 576..960,
            (Part::Caps, false) => 960..1152,
            _ if self.is_parallel(part) => 384..576,
            _ => 0..384,
        }
    }
}

/// For 64 sides of four corners two triangles each; then one triangle each, since both shadows are one point. For 64 caps of six
/// corners both triangles each; then the light caps alone.
fn indices() -> Vec<u16> {
    let each =
        |stride: u16, corners: &'static [u16]| (0..64).flat_map(move |i| corners.iter().map(move |c| i * stride + c));
    let sides = each(4, &[0, 1, 2, 0, 2, 3]).chain(each(4, &[0, 1, 2]));
    sides.chain(each(6, &[0, 1, 2, 3, 4, 5])).chain(each(6, &[0, 1, 2])).collect()
}

/// What the user of silhouettes chooses of their [`Shape`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style {
    /// See [`Shape::weighted`].
    pub weighted: bool,
    /// Sides of parallel light are quads in any case.
    pub quads: bool,
}

/// What is drawn in one call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// Sides of casters that are counted from the eye.
    PassSides,
    /// Sides of casters that are counted from infinity.
    FailSides,
    /// Caps of the latter.
    Caps,
}

impl Part {
    pub const ALL: [Self; 3] = [Self::PassSides, Self::FailSides, Self::Caps];

    /// By which the shader knows it.
    fn first_vertex(self) -> u32 {
        self as u32 * VERTICES
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

    /// The layout of the bind group that the vertex shaders take as group 0; group 1 is [`Edges::draw_layout`].
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.draw_layout
    }

    /// Names of the vertex shaders for sides and for caps.
    pub fn entries(&self) -> [&'static str; 2] {
        if self.extrude == Extrude::Vertex { ["any_side", "any_cap"] } else { ["listed_side", "listed_cap"] }
    }

    /// Describes the casters of a frame: first all that are counted from the eye, then the others. With the camera's
    /// matrix goes whether near is 1. `light`: its centre, homogeneous.
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
        pass.set_bind_group(1, &edges.draw, &[]);
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
        let indices = self.shape.indices(part);
        match self.extrude {
            Extrude::Compute => pass.draw_indexed_indirect(&buffers.arguments, part as u64 * find::ARGUMENTS),
            Extrude::Cpu => pass.draw_indexed(indices, part.first_vertex() as i32, self.work.listed(part)),
            Extrude::Vertex => {
                for again in 0..self.work.repeats(part, self.shape) {
                    pass.draw_indexed(indices.clone(), (again * VERTICES) as i32, self.work.all(part));
                }
            }
        }
    }

    /// What compute shaders take as group 0 to read casters and what was found; group 1 is [`Edges::draw`].
    pub fn found_by_gpu(&self) -> Option<&wgpu::BindGroup> {
        self.buffers.as_ref().map(|b| &b.draw)
    }

    /// Sides that may be found at most.
    pub fn room(&self, part: Part) -> u32 {
        self.work.room(part)
    }

    /// Arguments of an indirect draw of a part with a quad for each side, whatever draws it.
    pub fn arguments(&self, part: Part) -> Option<(&wgpu::Buffer, u64)> {
        self.buffers.as_ref().map(|b| (&b.arguments, part as u64 * find::ARGUMENTS))
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

    /// Numbers of sides (from the eye, from infinity) and caps that were found, where the CPU found them.
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

/// A caster as the shaders see it; chunks are filled in later.
fn caster(casters: &Casters, edges: &Edges, throw: &Throw) -> Option<Caster> {
    let placed = &casters.placed()[throw.place as usize];
    let part = &casters.meshes()[placed.mesh as usize];
    let mesh = edges.of_mesh(placed.mesh);
    let sides = placed.sides?;
    let flags = [
        (throw.rule == Rule::Away, AWAY),
        (sides.is_mirrored, MIRRORED),
        (throw.z_fail, Z_FAIL),
        (throw.light_cap, LIGHT_CAP),
        (throw.dark_cap, DARK_CAP),
        (throw.is_body, BODY),
        (throw.from_infinity, COUNT_FROM_INFINITY),
    ];
    let end = throw.end.truncate();
    Some(Caster {
        end: end.extend(throw.end.w - end.dot(casters.origin())).as_vec4().to_array(),
        light: light_in_mesh(throw.light, &sides.mesh_from_world, mesh.adjacency.center).to_array(),
        first_edge: mesh.first_edge,
        edge_count: mesh.adjacency.edges.len() as u32,
        first_triangle: mesh.first_triangle,
        triangle_count: mesh.triangle_count,
        first_index: part.first_index,
        base_vertex: part.base_vertex,
        instance: placed.number,
        flags: flags.into_iter().filter(|(on, _)| *on).map(|(_, bit)| bit).sum(),
        reach: throw.reach,
        seen_from: throw.anchor[0].to_array(),
        axis: throw.anchor[1].to_array(),
        ..Caster::default()
    })
}

//! Edges and planes of the meshes on the GPU, for techniques that extrude silhouettes.
//!
//! They lie in four arrays, none with more bytes than indices have: a binding of 128 MiB, which
//! WebGPU promises, holds what belongs to 11 million triangles.

mod groups;

use super::eye_tree::EyeTree;
use super::geometry::MeshPart;
use super::journal::Journal;
use super::poses::{self, Poses};
use super::store::{Parts, Store};
use crate::{error::Error, gpu::Gpu, shader::Shared, shader::shader_struct};
pub(crate) use groups::Reads;
use groups::{Groups, too_large};
use std::ops::Range;
use std::sync::{Arc, OnceLock};
use umbrage_core::adjacency::{self, Adjacency, NONE, without_copies};
use umbrage_core::{Mesh, glam::Vec4};

/// What the host has to agree on with `edges.wgsl`.
pub(super) const SHARED: Shared = Shared {
    module: "edges",
    layouts: &[Edge::LAYOUT, Pair::LAYOUT],
    constants: &[
        ("NO_TRIANGLE", NO_TRIANGLE as f64),
        ("SAME_DIRECTION", SAME_DIRECTION as f64),
        ("ONE_WAY", ONE_WAY as f64),
    ],
};

shader_struct! {
    /// An edge between two vertices, see `edges.wgsl`.
    pub(crate) struct Edge {
        start: u32,
        end: u32,
    }
}

shader_struct! {
    /// The triangles at an edge, see `edges.wgsl`.
    pub(crate) struct Pair {
        first: u32,
        second: u32,
    }
}

/// `Pair::second` where there is no second triangle.
const NO_TRIANGLE: u32 = 0x7fff_ffff;
/// Bit of `Pair::second`: both triangles run along the edge the same way.
const SAME_DIRECTION: u32 = 0x8000_0000;
/// Bit of `Edge::start`: no triangles lie on both sides of the edge.
const ONE_WAY: u32 = 0x8000_0000;

const EDGES: &str = "edges";
const PLANES: &str = "planes";
/// The plane of a triangle that no edge has, such as a copy of another one.
const LEFT_OUT: Vec4 = Vec4::new(0.0, 0.0, 0.0, -1.0);

/// Of all meshes, made when a technique first asks, kept up from then on, and shared by every
/// light.
pub(crate) struct Edges {
    stores: Stores,
    parts: [Parts; 2],
    meshes: Vec<MeshEdges>,
    groups: Groups,
}

/// The edges of one mesh and where they lie in the shared buffers.
#[derive(Default)]
pub(crate) struct MeshEdges {
    pub adjacency: Arc<Adjacency>,
    pub first_edge: u32,
    /// Planes lie in the order of the mesh's own triangles.
    pub first_triangle: u32,
    pub triangle_count: u32,
    eye_tree: OnceLock<EyeTree>,
    parts: [Range<u32>; 2],
}

impl MeshEdges {
    /// Most shadows of the mesh that one point can be in: fronts and backs of a closed one, where
    /// both count.
    pub(super) fn layers(&self) -> u32 {
        self.adjacency.layers.saturating_mul(if self.adjacency.is_closed { 2 } else { 1 })
    }

    /// What remakes the planes of a posed mesh has to know.
    pub(super) fn planes(&self) -> poses::Planes {
        poses::Planes {
            first_triangle: self.first_triangle,
            triangle_count: self.triangle_count,
            center: self.adjacency.center.as_vec3().to_array(),
        }
    }

    /// For counts that start at the eye; made when first asked for.
    pub fn eye_tree(&self, mesh: &Mesh) -> &EyeTree {
        self.eye_tree.get_or_init(|| EyeTree::new(mesh, &self.adjacency))
    }
}

impl Edges {
    /// Of all meshes; `of_vertices` has their positions, their indices, and instances.
    ///
    /// # Errors
    /// [`Error::Size`] where they do not fit the adapter's limits.
    pub(super) fn new(
        gpu: &Gpu,
        (meshes, poses): (&[MeshPart], &Poses),
        of_vertices: [&wgpu::Buffer; 3],
    ) -> Result<Self, Error> {
        let stores = Stores::new(gpu, [0; 2])?;
        let groups = Groups::new(gpu, stores.buffers(of_vertices))?;
        let mut made = Self { stores, parts: [Parts::new(), Parts::new()], meshes: Vec::new(), groups };
        // Those of posed instances have the edges of the meshes that they are made of.
        let mut added = Vec::new();
        for posed in [false, true] {
            let numbers = (0..).zip(meshes).filter(|(_, part)| part.version != 0 && part.source.is_some() == posed);
            added.extend(numbers.map(|(number, _)| number));
        }
        added.iter().try_for_each(|number| made.add(*number, meshes))?;
        made.stores = Stores::new(gpu, made.ends())?;
        let mut journal = Journal::default();
        added.iter().for_each(|number| made.write(&mut journal, *number, (meshes, poses)));
        journal.finish(gpu);
        made.bind(gpu, of_vertices)?;
        Ok(made)
    }

    /// Adds the edges of a mesh, or makes them anew.
    ///
    /// # Errors
    /// [`Error::Size`] where they do not fit the adapter's limits.
    pub(super) fn set(
        &mut self,
        gpu: &Gpu,
        journal: &mut Journal,
        number: u32,
        (meshes, poses): (&[MeshPart], &Poses),
    ) -> Result<(), Error> {
        self.remove(number);
        self.add(number, meshes)?;
        self.stores.fit(gpu, self.ends(), journal)?;
        self.write(journal, number, (meshes, poses));
        Ok(())
    }

    /// How many edges and triangles there have to be.
    fn ends(&self) -> [u64; 2] {
        self.parts.each_ref().map(|parts| u64::from(parts.end()))
    }

    fn write(&self, journal: &mut Journal, number: u32, (meshes, poses): (&[MeshPart], &Poses)) {
        let (part, mesh) = (&meshes[number as usize], &self.meshes[number as usize]);
        let adjacency = &mesh.adjacency;
        let edge = |e: &adjacency::Edge| Edge {
            start: (part.base_vertex + e.vertices[0]) | if e.is_balanced() { 0 } else { ONE_WAY },
            end: part.base_vertex + e.vertices[1],
        };
        let number_of = |t: u32| match t {
            NONE => NO_TRIANGLE,
            t => mesh.first_triangle + adjacency.numbers[t as usize],
        };
        let pair = |e: &adjacency::Edge| Pair {
            first: number_of(e.triangles[0]),
            second: number_of(e.triangles[1]) | if e.same_direction { SAME_DIRECTION } else { 0 },
        };
        let Stores { edges, pairs, normals, offsets } = &self.stores;
        edges.write(journal, mesh.first_edge, &adjacency.edges.iter().map(edge).collect::<Vec<_>>());
        pairs.write(journal, mesh.first_edge, &adjacency.edges.iter().map(pair).collect::<Vec<_>>());
        let mut planes = vec![LEFT_OUT; mesh.triangle_count as usize];
        let own = poses.planes(number, part, adjacency).unwrap_or(&adjacency.planes);
        own.iter().zip(&adjacency.numbers).for_each(|(plane, &t)| planes[t as usize] = *plane);
        let normal = |plane: &Vec4| plane.truncate().to_array();
        normals.write(journal, mesh.first_triangle, &planes.iter().map(normal).collect::<Vec<_>>());
        offsets.write(journal, mesh.first_triangle, &planes.iter().map(|plane| plane.w).collect::<Vec<_>>());
    }

    /// Finds the edges of a mesh and a place for them.
    fn add(&mut self, number: u32, meshes: &[MeshPart]) -> Result<(), Error> {
        let part = &meshes[number as usize];
        let adjacency = match part.source.and_then(|source| self.meshes.get(source as usize)) {
            Some(source) => source.adjacency.clone(),
            None => Arc::new(Adjacency::of(&without_copies(&part.mesh))),
        };
        let triangle_count = part.mesh.triangle_count() as u32;
        let mut take = |kind: usize, count: usize, what: &str| {
            let taken = u32::try_from(count).ok().and_then(|count| self.parts[kind].take(count));
            let size = u64::from(self.parts[kind].end()) + count as u64;
            taken.ok_or_else(|| Error::Size { what: format!("the number of {what}"), size, limit: i32::MAX as u64 })
        };
        let parts = [take(0, adjacency.edges.len(), EDGES)?, take(1, triangle_count as usize, PLANES)?];
        let [first_edge, first_triangle] = [parts[0].start, parts[1].start];
        self.meshes.resize_with(self.meshes.len().max(number as usize + 1), MeshEdges::default);
        self.meshes[number as usize] =
            MeshEdges { adjacency, first_edge, first_triangle, triangle_count, eye_tree: OnceLock::new(), parts };
        Ok(())
    }

    /// Forgets the edges of a mesh.
    pub(super) fn remove(&mut self, number: u32) {
        if let Some(mesh) = self.meshes.get_mut(number as usize) {
            let parts = std::mem::take(mesh).parts;
            self.parts.iter_mut().zip(parts).for_each(|(all, part)| all.give_back(part));
        }
    }

    /// Binds the buffers that there are now.
    ///
    /// # Errors
    /// [`Error::Size`] where shaders may not have all vertices.
    pub(super) fn bind(&mut self, gpu: &Gpu, of_vertices: [&wgpu::Buffer; 3]) -> Result<(), Error> {
        let of = self.stores.buffers(of_vertices);
        if !self.groups.are_of(&of) {
            self.groups = Groups::new(gpu, of)?;
        }
        Ok(())
    }

    /// What a shader reads of them, as group 1.
    pub fn group(&self, reads: Reads) -> &wgpu::BindGroup {
        self.groups.get(reads)
    }

    /// What remakes planes of posed meshes.
    pub(super) fn pose_group(&self) -> &wgpu::BindGroup {
        &self.groups.pose
    }

    /// Of a mesh, by its number.
    pub fn of_mesh(&self, mesh: u32) -> &MeshEdges {
        &self.meshes[mesh as usize]
    }

    /// GPU memory, once for all lights.
    pub fn bytes(&self) -> u64 {
        self.stores.bytes()
    }
}

/// The buffers: of edges and the triangles at them, and of planes.
struct Stores {
    edges: Store,
    pairs: Store,
    normals: Store,
    offsets: Store,
}

impl Stores {
    fn new(gpu: &Gpu, [edges, triangles]: [u64; 2]) -> Result<Self, Error> {
        let store = |what, stride, count| Store::new(gpu, what, stride, count).map_err(too_large);
        Ok(Self {
            edges: store(EDGES, size_of::<Edge>() as u64, edges)?,
            pairs: store(EDGES, size_of::<Pair>() as u64, edges)?,
            normals: store(PLANES, 12, triangles)?,
            offsets: store(PLANES, 4, triangles)?,
        })
    }

    /// Has room for so many edges and triangles.
    fn fit(&mut self, gpu: &Gpu, [edges, triangles]: [u64; 2], journal: &mut Journal) -> Result<(), Error> {
        let Self { edges: of_edges, pairs, normals, offsets } = self;
        for (store, count) in [(of_edges, edges), (pairs, edges), (normals, triangles), (offsets, triangles)] {
            store.fit(gpu, count, journal).map_err(too_large)?;
        }
        Ok(())
    }

    /// What [`Groups`] bind.
    fn buffers(&self, of_vertices: [&wgpu::Buffer; 3]) -> [wgpu::Buffer; 7] {
        let Self { edges, pairs, normals, offsets } = self;
        let [edges, pairs, normals, offsets] = [edges, pairs, normals, offsets].map(|store| store.buffer().clone());
        let [positions, indices, instances] = of_vertices.map(wgpu::Buffer::clone);
        [edges, pairs, positions, indices, instances, normals, offsets]
    }

    fn bytes(&self) -> u64 {
        [&self.edges, &self.pairs, &self.normals, &self.offsets].iter().map(|store| store.bytes()).sum()
    }
}

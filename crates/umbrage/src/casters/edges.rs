//! Edges and planes of the meshes on the GPU, for techniques that extrude silhouettes.

use super::eye_tree::EyeTree;
use super::geometry::MeshPart;
use super::journal::Journal;
use super::poses::{self, Poses};
use super::store::{Parts, Store};
use crate::fullscreen::{STORAGE, bind, layout};
use crate::{error::Error, gpu::Gpu, shader::Shared, shader::shader_struct};
use std::ops::Range;
use std::sync::{Arc, OnceLock};
use umbrage_core::adjacency::{self, Adjacency, NONE, without_copies};
use umbrage_core::{Mesh, glam::Vec4};

/// What the host has to agree on with `edges.wgsl`.
pub(super) const SHARED: Shared = Shared {
    module: "edges",
    layouts: &[Edge::LAYOUT],
    constants: &[("NO_TRIANGLE", NO_TRIANGLE as f64), ("SAME_DIRECTION", SAME_DIRECTION as f64)],
};

shader_struct! {
    /// An edge between two vertices and its triangles, see `edges.wgsl`.
    pub(crate) struct Edge {
        start: u32,
        end: u32,
        first: u32,
        second: u32,
    }
}

/// `Edge::second` where there is no second triangle.
const NO_TRIANGLE: u32 = 0x7fff_ffff;
/// Bit of `Edge::second`: both triangles run along the edge the same way.
const SAME_DIRECTION: u32 = 0x8000_0000;

const EDGES: &str = "edges";
const PLANES: &str = "planes";
const TOO_LARGE: &str = "a buffer of edges, planes or vertices (techniques with maps need none; the limit is the \
                         device's max_storage_buffer_binding_size)";

/// With the remedy.
fn too_large(error: Error) -> Error {
    match error {
        Error::Size { size, limit, .. } => Error::Size { what: TOO_LARGE.into(), size, limit },
        other => other,
    }
}

/// The plane of a triangle that no edge has, such as a copy of another one.
const LEFT_OUT: Vec4 = Vec4::new(0.0, 0.0, 0.0, -1.0);

/// Bindings of [`Groups::draw`] that compute reads. WebGPU promises eight storage buffers a stage,
/// and silhouettes and what is made of them take four.
const WITHOUT_INDICES: [u32; 4] = [0, 1, 2, 4];
const WITHOUT_EDGES: [u32; 4] = [1, 2, 3, 4];

/// Of all meshes, made when a technique first asks, kept up from then on, and shared by every
/// light.
pub(crate) struct Edges {
    edges: Store,
    planes: Store,
    parts: [Parts; 2],
    meshes: Vec<MeshEdges>,
    groups: Groups,
}

/// What binds them together with the vertices.
pub(crate) struct Groups {
    /// As `edges.wgsl` declares it, for compute.
    pub find: wgpu::BindGroup,
    /// As `silhouettes/extrude.wgsl` declares it, for drawing.
    pub draw: wgpu::BindGroup,
    /// The same for compute, without the indices of triangles.
    pub make_edges: wgpu::BindGroup,
    /// The same without the edges.
    pub make_triangles: wgpu::BindGroup,
    /// What remakes planes of posed meshes.
    pub(super) pose: wgpu::BindGroup,
    of: [wgpu::Buffer; 5],
}

impl Groups {
    fn new(gpu: &Gpu, of: [wgpu::Buffer; 5]) -> Result<Self, Error> {
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        if let Some(size) = of.iter().map(wgpu::Buffer::size).find(|size| *size > limit) {
            return Err(Error::Size { what: TOO_LARGE.into(), size, limit });
        }
        let all = of.each_ref().map(|b| b.as_entire_binding());
        Ok(Self {
            find: bind(gpu, "edges", &Edges::find_layout(gpu), &all[..2]),
            make_edges: part(gpu, WITHOUT_INDICES, &all),
            make_triangles: part(gpu, WITHOUT_EDGES, &all),
            draw: bind(gpu, "edges", &Edges::draw_layout(gpu), &all),
            pose: poses::planes_group(gpu, &of[3], &of[1]),
            of,
        })
    }
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
        let (edges, planes) = (Store::new(gpu, EDGES, 16, 0)?, Store::new(gpu, PLANES, 16, 0)?);
        let groups = Groups::new(gpu, buffers([&edges, &planes], of_vertices))?;
        let mut made = Self { edges, planes, parts: [Parts::new(), Parts::new()], meshes: Vec::new(), groups };
        let mut all = Vec::new();
        // Those of posed instances have the edges of the meshes that they are made of.
        for posed in [false, true] {
            let numbers = (0..).zip(meshes).filter(|(_, part)| part.version != 0 && part.source.is_some() == posed);
            for (number, _) in numbers {
                made.add(number, (meshes, poses), &mut all)?;
            }
        }
        let mut journal = Journal::default();
        made.edges = Store::new(gpu, EDGES, 16, u64::from(made.parts[0].end())).map_err(too_large)?;
        made.planes = Store::new(gpu, PLANES, 16, u64::from(made.parts[1].end())).map_err(too_large)?;
        all.iter().for_each(|new| made.write(&mut journal, new));
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
        of: (&[MeshPart], &Poses),
    ) -> Result<(), Error> {
        self.remove(number);
        let mut new = Vec::new();
        self.add(number, of, &mut new)?;
        self.edges.fit(gpu, u64::from(self.parts[0].end()), journal).map_err(too_large)?;
        self.planes.fit(gpu, u64::from(self.parts[1].end()), journal).map_err(too_large)?;
        new.iter().for_each(|new| self.write(journal, new));
        Ok(())
    }

    fn write(&self, journal: &mut Journal, (number, edges, planes): &New) {
        let mesh = &self.meshes[*number as usize];
        self.edges.write(journal, mesh.first_edge, edges);
        self.planes.write(journal, mesh.first_triangle, planes);
    }

    /// Finds the edges of a mesh and a place for them.
    fn add(&mut self, number: u32, (meshes, poses): (&[MeshPart], &Poses), new: &mut Vec<New>) -> Result<(), Error> {
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
        let triangle = |t: u32| if t == NONE { NO_TRIANGLE } else { first_triangle + adjacency.numbers[t as usize] };
        let edge = |e: &adjacency::Edge| Edge {
            start: part.base_vertex + e.vertices[0],
            end: part.base_vertex + e.vertices[1],
            first: triangle(e.triangles[0]),
            second: triangle(e.triangles[1]) | if e.same_direction { SAME_DIRECTION } else { 0 },
        };
        let edges: Vec<Edge> = adjacency.edges.iter().map(edge).collect();
        let mut planes = vec![LEFT_OUT; triangle_count as usize];
        let own = poses.planes(number, part, &adjacency).unwrap_or(&adjacency.planes);
        own.iter().zip(&adjacency.numbers).for_each(|(plane, &t)| planes[t as usize] = *plane);
        new.push((number, edges, planes));
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
        let of = buffers([&self.edges, &self.planes], of_vertices);
        if self.groups.of != of {
            self.groups = Groups::new(gpu, of)?;
        }
        Ok(())
    }

    /// What binds them.
    pub fn groups(&self) -> &Groups {
        &self.groups
    }

    pub fn find_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        layout(gpu, "edges", wgpu::ShaderStages::COMPUTE, &[STORAGE; 2])
    }

    pub fn draw_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        layout(gpu, "edges", wgpu::ShaderStages::VERTEX, &[STORAGE; 5])
    }

    /// Of [`Groups::make_edges`].
    pub fn make_edges_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        part_layout(gpu, WITHOUT_INDICES)
    }

    /// Of [`Groups::make_triangles`].
    pub fn make_triangles_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        part_layout(gpu, WITHOUT_EDGES)
    }

    /// Of a mesh, by its number.
    pub fn of_mesh(&self, mesh: u32) -> &MeshEdges {
        &self.meshes[mesh as usize]
    }

    /// GPU memory, once for all lights.
    pub fn bytes(&self) -> u64 {
        self.edges.bytes() + self.planes.bytes()
    }
}

/// Number of a mesh, its edges and its planes.
type New = (u32, Vec<Edge>, Vec<Vec4>);

/// What [`Groups`] bind.
fn buffers(own: [&Store; 2], of_vertices: [&wgpu::Buffer; 3]) -> [wgpu::Buffer; 5] {
    let [edges, planes] = own.map(|store| store.buffer().clone());
    let [positions, indices, instances] = of_vertices.map(wgpu::Buffer::clone);
    [edges, planes, positions, indices, instances]
}

fn part_layout(gpu: &Gpu, bindings: [u32; 4]) -> wgpu::BindGroupLayout {
    let entry = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: STORAGE,
        count: None,
    };
    let entries = bindings.map(entry);
    gpu.bind_group_layout("edges", &entries)
}

fn part(gpu: &Gpu, bindings: [u32; 4], all: &[wgpu::BindingResource<'_>]) -> wgpu::BindGroup {
    let entries = bindings.map(|binding| wgpu::BindGroupEntry { binding, resource: all[binding as usize].clone() });
    let layout = &part_layout(gpu, bindings);
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("edges"), layout, entries: &entries })
}

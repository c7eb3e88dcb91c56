//! Edges and planes of the meshes on the GPU, for techniques that extrude silhouettes.

use super::eye_tree::EyeTree;
use super::placed::Placed;
use super::poses::{self, Poses};
use super::vertices::MeshPart;
use crate::fullscreen::{STORAGE, bind, layout};
use crate::{error::Error, gpu::Gpu, shader::Shared, shader::shader_struct};
use std::sync::{Arc, OnceLock};
use umbrage_core::adjacency::{Adjacency, NONE, without_copies};
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

/// The plane of a triangle that no edge has, such as a copy of another one.
const LEFT_OUT: Vec4 = Vec4::new(0.0, 0.0, 0.0, -1.0);

/// Bindings of [`Edges::draw`] that compute reads. WebGPU promises eight storage buffers a stage,
/// and silhouettes and what is made of them take four.
const WITHOUT_INDICES: [u32; 4] = [0, 1, 2, 4];
const WITHOUT_EDGES: [u32; 4] = [1, 2, 3, 4];

/// Of all meshes of the scene, made once and shared by every light.
pub(crate) struct Edges {
    /// As `edges.wgsl` declares it, for compute.
    pub find: wgpu::BindGroup,
    /// As `silhouettes/extrude.wgsl` declares it, for drawing.
    pub draw: wgpu::BindGroup,
    /// The same for compute, without the indices of triangles.
    pub make_edges: wgpu::BindGroup,
    /// The same without the edges.
    pub make_triangles: wgpu::BindGroup,
    /// What remakes planes of posed meshes, where there are any.
    pub pose: Option<wgpu::BindGroup>,
    /// Most shadows that one point can be in, whichever casters are drawn.
    pub layers: u32,
    meshes: Vec<MeshEdges>,
    bytes: u64,
}

/// The edges of one mesh and where they lie in the shared buffers.
pub(crate) struct MeshEdges {
    pub adjacency: Arc<Adjacency>,
    pub first_edge: u32,
    /// Planes lie in the order of the mesh's own triangles.
    pub first_triangle: u32,
    pub triangle_count: u32,
    eye_tree: OnceLock<EyeTree>,
}

impl MeshEdges {
    /// Most shadows of the mesh that one point can be in: fronts and backs of a closed one, where
    /// both count.
    fn layers(&self) -> u32 {
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

/// What edges are made of.
pub(super) struct Source<'a> {
    pub meshes: &'a [MeshPart],
    pub poses: &'a Poses,
    pub placed: &'a [Placed],
    pub positions: &'a wgpu::Buffer,
    pub indices: &'a wgpu::Buffer,
    pub instances: &'a wgpu::Buffer,
}

impl Edges {
    pub(super) fn new(gpu: &Gpu, casters: &Source<'_>) -> Result<Self, Error> {
        let (mut edges, mut planes, mut meshes) = (Vec::<Edge>::new(), Vec::<Vec4>::new(), Vec::<MeshEdges>::new());
        for (number, part) in casters.meshes.iter().enumerate() {
            let adjacency = match casters.poses.source(number) {
                Some(source) => Arc::clone(&meshes[source].adjacency),
                None => Arc::new(Adjacency::of(&without_copies(&part.mesh))),
            };
            let (first_edge, first_triangle) = (edges.len() as u32, planes.len() as u32);
            let triangle =
                |t: u32| if t == NONE { NO_TRIANGLE } else { first_triangle + adjacency.numbers[t as usize] };
            edges.extend(adjacency.edges.iter().map(|e| Edge {
                start: part.base_vertex + e.vertices[0],
                end: part.base_vertex + e.vertices[1],
                first: triangle(e.triangles[0]),
                second: triangle(e.triangles[1]) | if e.same_direction { SAME_DIRECTION } else { 0 },
            }));
            let triangle_count = part.mesh.triangle_count() as u32;
            planes.resize((first_triangle + triangle_count) as usize, LEFT_OUT);
            let own = casters.poses.planes(number, &adjacency).unwrap_or(&adjacency.planes);
            for (plane, &t) in own.iter().zip(&adjacency.numbers) {
                planes[(first_triangle + t) as usize] = *plane;
            }
            meshes.push(MeshEdges { adjacency, first_edge, first_triangle, triangle_count, eye_tree: OnceLock::new() });
        }
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let sizes =
            [edges.len() as u64 * 16, planes.len() as u64 * 16, casters.positions.size(), casters.indices.size()];
        if let Some(&size) = sizes.iter().find(|size| **size > limit) {
            let what = "a buffer of edges, planes or vertices (techniques with maps need none; the limit is the \
                        device's max_storage_buffer_binding_size)";
            return Err(Error::Size { what: what.into(), size, limit });
        }
        let edges = gpu.buffer("edges", &edges, wgpu::BufferUsages::STORAGE);
        let planes = gpu.buffer("planes", &planes, wgpu::BufferUsages::STORAGE);
        let of_edges = [edges.as_entire_binding(), planes.as_entire_binding()];
        let of_vertices = [casters.positions, casters.indices, casters.instances].map(|b| b.as_entire_binding());
        let all = [&of_edges[..], &of_vertices].concat();
        let placed = casters.placed.iter().filter(|p| p.casts);
        let layers = placed.map(|p| meshes[p.mesh as usize].layers()).fold(0, u32::saturating_add);
        Ok(Self {
            layers,
            find: bind(gpu, "edges", &Self::find_layout(gpu), &of_edges),
            make_edges: part(gpu, WITHOUT_INDICES, &all),
            make_triangles: part(gpu, WITHOUT_EDGES, &all),
            draw: bind(gpu, "edges", &Self::draw_layout(gpu), &all),
            pose: (!casters.poses.is_empty()).then(|| poses::planes_group(gpu, casters.indices, &planes)),
            meshes,
            bytes: edges.size() + planes.size(),
        })
    }

    pub fn find_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        layout(gpu, "edges", wgpu::ShaderStages::COMPUTE, &[STORAGE; 2])
    }

    pub fn draw_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        layout(gpu, "edges", wgpu::ShaderStages::VERTEX, &[STORAGE; 5])
    }

    /// Of [`Edges::make_edges`].
    pub fn make_edges_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        part_layout(gpu, WITHOUT_INDICES)
    }

    /// Of [`Edges::make_triangles`].
    pub fn make_triangles_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        part_layout(gpu, WITHOUT_EDGES)
    }

    /// Of a mesh, by its number in the scene.
    pub fn of_mesh(&self, mesh: u32) -> &MeshEdges {
        &self.meshes[mesh as usize]
    }

    /// GPU memory, once for all lights.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
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

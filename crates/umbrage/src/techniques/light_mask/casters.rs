//! The casters of a frame as trees of boxes: one over all of them, and one over the triangles of
//! each mesh.

use super::grown::Grown;
use super::tree::{Boxed, TreeNode, append};
use crate::area_light::ROUNDING;
use crate::casters::Casters;
use crate::shader::shader_struct;
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View};
use std::ops::Range;
use umbrage_core::Mesh;
use umbrage_core::glam::{DAffine3, Vec3};

shader_struct! {
    /// A placed mesh, see `light_mask.wgsl`.
    pub(crate) struct Placed {
        mesh_from_eye: [[f32; 4]; 3],
        eye_from_mesh: [[f32; 4]; 3],
        first_node: u32,
        end_node: u32,
        tolerance: f32,
        pad: u32,
    }
}

/// Trees of a frame's casters. Keeps its memory.
pub(super) struct Trees {
    meshes: Meshes,
    top: Grown,
    placed: Grown,
    top_data: Vec<TreeNode>,
    placed_data: Vec<Placed>,
}

/// Trees of all meshes of some casters.
struct Meshes {
    nodes: Grown,
    triangles: Grown,
    node_data: Vec<TreeNode>,
    triangle_data: Vec<u32>,
    /// By number of the mesh.
    of: Vec<MeshTree>,
    is_new: bool,
}

/// The tree of one mesh.
#[derive(Default)]
struct MeshTree {
    /// The version of the mesh that it is the tree of; a posed one is made in
    /// every frame.
    version: u64,
    nodes: Vec<TreeNode>,
    /// Vertices of triangles in the order of the leaves.
    triangles: Vec<u32>,
    /// Where its nodes are among those of all.
    place: Range<u32>,
}

impl Trees {
    pub fn new(gpu: &Gpu) -> Self {
        Self {
            meshes: Meshes::new(gpu),
            top: Grown::new(gpu, "outer boxes"),
            placed: Grown::new(gpu, "places"),
            top_data: Vec::new(),
            placed_data: Vec::new(),
        }
    }

    /// Trees of the chosen casters; true where buffers were made anew.
    pub fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, chosen: &[u32]) -> Result<bool, Error> {
        view.casters.check_told(chosen.iter().copied())?;
        self.meshes.follow(view.casters);
        let eye = view.camera.eye;
        let (mut boxes, mut records) = (Vec::with_capacity(chosen.len()), Vec::with_capacity(chosen.len()));
        for place in chosen {
            let caster = &view.casters.placed()[*place as usize];
            let Some(sides) = &caster.sides else { continue };
            let bounds = caster.bounds.grown(ROUNDING * caster.bounds.largest_coordinate());
            boxes.push(Boxed((bounds.min - eye).as_vec3(), (bounds.max - eye).as_vec3()));
            records.push(Placed::of(&sides.mesh_from_world, view, self.meshes.of[caster.mesh as usize].place.clone()));
        }
        self.top_data.clear();
        let mut order = Vec::with_capacity(boxes.len());
        append(&boxes, &mut self.top_data, &mut order);
        // It ends the walk, which would continue among the casters of an earlier frame.
        self.top_data.push(TreeNode::default());
        self.placed_data.clear();
        self.placed_data.extend(order.iter().map(|i| records[*i as usize]));
        let top = self.top.fit(gpu, size_of_val(&self.top_data[..]))?;
        let placed = self.placed.fit(gpu, size_of_val(&self.placed_data[..]))?;
        Ok(self.meshes.fit(gpu)? || top || placed)
    }

    /// Has all uploaded again.
    pub fn forget(&mut self) {
        self.meshes.is_new = true;
    }

    /// Whether there is more to upload than every frame has.
    pub fn is_new(&self) -> bool {
        self.meshes.is_new
    }

    /// Nodes and triangles of meshes, then the tree of casters and these.
    pub fn buffers(&self) -> [&wgpu::Buffer; 4] {
        [&self.meshes.nodes.buffer, &self.meshes.triangles.buffer, &self.top.buffer, &self.placed.buffer]
    }

    pub fn upload(&mut self, passes: &mut Passes<'_>) {
        passes.upload(&self.top.buffer, bytemuck::cast_slice(&self.top_data));
        passes.upload(&self.placed.buffer, bytemuck::cast_slice(&self.placed_data));
        let meshes = &mut self.meshes;
        if std::mem::take(&mut meshes.is_new) {
            passes.upload(&meshes.nodes.buffer, bytemuck::cast_slice(&meshes.node_data));
            passes.upload(&meshes.triangles.buffer, bytemuck::cast_slice(&meshes.triangle_data));
        }
    }
}

impl Placed {
    fn of(mesh_from_world: &DAffine3, view: &View<'_>, nodes: Range<u32>) -> Self {
        let eye = view.camera.eye;
        let mesh_from_eye = *mesh_from_world * DAffine3::from_translation(eye);
        let m = mesh_from_eye.matrix3;
        let offset = mesh_from_eye.translation;
        let row = |i: usize| m.row(i).extend(offset[i]).as_vec4().to_array();
        let back = m.inverse();
        let column = |i: usize| back.col(i).extend(0.0).as_vec4().to_array();
        // What a depth buffer's rounding and single precision amount to.
        let coordinates = view.casters.all_bounds().largest_coordinate().max(eye.abs().max_element());
        let stretch = [m.x_axis, m.y_axis, m.z_axis].map(|c| c.length()).into_iter().fold(0.0, f64::max);
        Self {
            mesh_from_eye: [0, 1, 2].map(row),
            eye_from_mesh: [0, 1, 2].map(column),
            first_node: nodes.start,
            end_node: nodes.end,
            tolerance: (4.0 * ROUNDING * coordinates * stretch) as f32,
            pad: 0,
        }
    }
}

impl Meshes {
    fn new(gpu: &Gpu) -> Self {
        Self {
            nodes: Grown::new(gpu, "boxes"),
            triangles: Grown::new(gpu, "triangles"),
            node_data: Vec::new(),
            triangle_data: Vec::new(),
            of: Vec::new(),
            is_new: true,
        }
    }

    /// Builds the trees of meshes that are new, have changed or are posed.
    fn follow(&mut self, casters: &Casters) {
        self.of.resize_with(casters.meshes().len(), MeshTree::default);
        let mut is_new = false;
        for (number, (part, tree)) in casters.meshes().iter().zip(&mut self.of).enumerate() {
            let posed = casters.posed_mesh(number);
            if posed.is_some() || tree.version != part.version {
                *tree = MeshTree::of(posed.as_ref().unwrap_or(&part.mesh), part.base_vertex);
                tree.version = part.version;
                is_new = true;
            }
        }
        if is_new {
            self.gather();
        }
    }

    /// Puts all trees one after the other.
    fn gather(&mut self) {
        self.is_new = true;
        self.node_data.clear();
        self.triangle_data.clear();
        for tree in &mut self.of {
            let (first, triangle) = (self.node_data.len() as u32, self.triangle_data.len() as u32 / 3);
            self.node_data.extend(tree.nodes.iter().map(|node| node.moved(first, triangle)));
            self.triangle_data.extend(&tree.triangles);
            tree.place = first..self.node_data.len() as u32;
        }
    }

    fn fit(&mut self, gpu: &Gpu) -> Result<bool, Error> {
        let nodes = self.nodes.fit(gpu, size_of_val(&self.node_data[..]))?;
        let triangles = self.triangles.fit(gpu, size_of_val(&self.triangle_data[..]))?;
        self.is_new |= nodes || triangles;
        Ok(nodes || triangles)
    }
}

impl MeshTree {
    fn of(mesh: &Mesh, base_vertex: u32) -> Self {
        let is_whole = |t: &[u32; 3]| t.iter().all(|i| mesh.positions.get(*i as usize).is_some_and(|p| p.is_finite()));
        let whole: Vec<[u32; 3]> = mesh.triangles().filter(is_whole).collect();
        let boxes: Vec<Boxed> = whole.iter().map(|t| around(mesh.corners(*t))).collect();
        let (mut nodes, mut order) = (Vec::new(), Vec::new());
        append(&boxes, &mut nodes, &mut order);
        let triangles = order.iter().flat_map(|i| whole[*i as usize].map(|v| base_vertex + v)).collect();
        Self { nodes, triangles, ..Self::default() }
    }
}

fn around([a, b, c]: [Vec3; 3]) -> Boxed {
    Boxed(a.min(b).min(c), a.max(b).max(c))
}

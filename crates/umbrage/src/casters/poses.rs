//! Meshes that joints bend: every instance with a pose has vertices of its own in the shared
//! buffers, which a compute pass fills when the pose changes. All techniques, and hosts, draw them
//! like any others.

mod device;

use super::vertices::MeshPart;
use crate::{
    error::Error,
    gpu::Gpu,
    passes::{Kept, Passes},
    shader::Shared,
};
pub(crate) use device::SHADERS;
pub(super) use device::planes_group;
use device::{Device, GROUP, JointRows, PosedMesh};
use std::sync::{Arc, OnceLock};
use umbrage_core::adjacency::Adjacency;
use umbrage_core::glam::{DAffine3, DVec3, Vec4};
use umbrage_core::rig::JointBoxes;
use umbrage_core::{Bounds, Mesh, Scene};

/// What the host has to agree on with `poses.wgsl`.
pub(super) const SHARED: Shared = Shared { module: "poses", layouts: &[PosedMesh::LAYOUT], constants: &[] };

/// The instances that have a pose.
pub(super) struct Poses {
    /// Number of meshes of the scene; those of posed instances follow, one each.
    scene_meshes: usize,
    posed: Vec<Posed>,
    device: Option<Device>,
    /// The vertices on the GPU.
    kept: Kept,
    /// What changed, as it goes to the GPU. Keep their memory.
    work: Vec<PosedMesh>,
    joints: Vec<JointRows>,
}

/// One of them.
struct Posed {
    /// Its place in [`Scene::instances`].
    instance: usize,
    /// Index of the mesh as it was bound.
    source: usize,
    bound: Option<Arc<Mesh>>,
    boxes: Arc<JointBoxes>,
    joints: Vec<DAffine3>,
    changed: bool,
    /// Its numbers for the GPU, the planes apart.
    work: PosedMesh,
    /// Made when the CPU asks for them.
    planes: OnceLock<Vec<Vec4>>,
}

impl Poses {
    pub fn new(scene: &Scene) -> Self {
        let mut boxes: Vec<Option<Arc<JointBoxes>>> = vec![None; scene.meshes.len()];
        let mut posed = Vec::new();
        for (number, instance) in scene.instances.iter().enumerate() {
            let Some(joints) = scene.joints(instance) else { continue };
            let of_mesh = &mut boxes[instance.mesh];
            let made = of_mesh.get_or_insert_with(|| Arc::new(JointBoxes::of(&scene.meshes[instance.mesh])));
            posed.push(Posed {
                instance: number,
                source: instance.mesh,
                bound: None,
                boxes: made.clone(),
                joints,
                changed: false,
                work: PosedMesh::default(),
                planes: OnceLock::new(),
            });
        }
        Self {
            scene_meshes: scene.meshes.len(),
            posed,
            device: None,
            kept: Kept::default(),
            work: Vec::new(),
            joints: Vec::new(),
        }
    }

    /// For each of them the number of the mesh it is made of, and that mesh bent.
    pub fn meshes(&self, scene: &Scene) -> Vec<(usize, Mesh)> {
        self.posed.iter().map(|p| (p.source, scene.meshes[p.source].posed(&p.joints))).collect()
    }

    /// The number of an instance's own mesh, where it has a pose.
    pub fn mesh_of(&self, instance: usize) -> Option<usize> {
        self.posed.binary_search_by_key(&instance, |p| p.instance).ok().map(|i| self.scene_meshes + i)
    }

    /// True where no instance has one.
    pub fn is_empty(&self) -> bool {
        self.posed.is_empty()
    }

    /// Of a posed instance's own mesh, the mesh of the scene that it is made of.
    pub fn source(&self, mesh: usize) -> Option<usize> {
        self.get(mesh).map(|p| p.source)
    }

    fn get(&self, mesh: usize) -> Option<&Posed> {
        self.posed.get(mesh.checked_sub(self.scene_meshes)?)
    }

    /// A box that surely holds such a mesh as it is bent.
    pub fn bounds(&self, mesh: usize) -> Bounds {
        self.get(mesh).map_or(Bounds::EMPTY, |p| p.boxes.posed(&p.joints))
    }

    /// Changes a pose; false where it is the same, or none.
    pub fn set(&mut self, mesh: usize, joints: &[DAffine3]) -> bool {
        let Some(posed) = mesh.checked_sub(self.scene_meshes).and_then(|i| self.posed.get_mut(i)) else { return false };
        let new = || joints.iter().copied().chain(std::iter::repeat(DAffine3::IDENTITY));
        let is_same = posed.joints.iter().zip(new()).all(|(joint, new)| *joint == new);
        if is_same || joints.iter().any(|j| !j.is_finite()) {
            return false;
        }
        posed.joints.iter_mut().zip(new()).for_each(|(joint, new)| *joint = new);
        posed.changed = true;
        posed.planes = OnceLock::new();
        true
    }

    /// A mesh as it is bent, by the CPU; `None` for meshes of the scene.
    pub fn posed(&self, mesh: usize) -> Option<Mesh> {
        let posed = self.get(mesh)?;
        Some(posed.bound.as_ref()?.posed(&posed.joints))
    }

    /// Planes of a bent mesh, by the CPU; `None` for meshes of the scene.
    pub fn planes(&self, mesh: usize, adjacency: &Adjacency) -> Option<&[Vec4]> {
        let posed = self.get(mesh)?;
        let bound = posed.bound.as_ref()?;
        Some(posed.planes.get_or_init(|| adjacency.planes_in(&bound.posed(&posed.joints))))
    }

    /// Uploads what never changes. `meshes` are those of the scene and the posed ones; `vertices`
    /// their positions and attributes.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
        meshes: &[MeshPart],
        vertices: [&wgpu::Buffer; 2],
    ) -> Result<(), Error> {
        if self.posed.is_empty() {
            return Ok(());
        }
        let (weights, first_start) = weights(scene);
        for (posed, part) in self.posed.iter_mut().zip(&meshes[self.scene_meshes..]) {
            let source = &meshes[posed.source];
            posed.work = PosedMesh {
                bound_vertex: source.base_vertex,
                vertex: part.base_vertex,
                vertex_count: if source.mesh.weights.is_empty() { 0 } else { source.mesh.positions.len() as u32 },
                first_start: first_start[posed.source],
                first_index: source.first_index,
                ..PosedMesh::default()
            };
            posed.bound = Some(source.mesh.clone());
        }
        let joints: usize = self.posed.iter().map(|p| p.joints.len()).sum();
        self.check(gpu, vertices, joints, weights.len())?;
        self.device = Some(Device::new(gpu, self.posed.len(), joints, &weights, vertices));
        Ok(())
    }

    /// Whether all fits the adapter, and what a dispatch can do.
    fn check(&self, gpu: &Gpu, vertices: [&wgpu::Buffer; 2], joints: usize, weights: usize) -> Result<(), Error> {
        let limits = gpu.device.limits();
        let groups = u64::from(limits.max_compute_workgroups_per_dimension);
        let largest = self.posed.iter().map(|p| p.work.vertex_count).max().unwrap_or(0);
        let triangles = self.posed.iter().filter_map(|p| p.bound.as_ref()).map(|m| m.triangle_count() as u64).max();
        let binding = limits.max_storage_buffer_binding_size;
        for (what, size, limit) in [
            ("instances that have a pose", self.posed.len() as u64, groups),
            ("the vertices of a mesh with joints", u64::from(largest), groups * u64::from(GROUP)),
            ("the triangles of a mesh with joints", triangles.unwrap_or(0), groups * u64::from(GROUP)),
            ("the joints of all poses", joints as u64 * size_of::<JointRows>() as u64, binding),
            ("the weights of all meshes with joints", weights as u64 * 4, binding),
            ("the vertices of a scene with poses", vertices[0].size().max(vertices[1].size()), binding),
        ] {
            if size > limit {
                return Err(Error::Size { what: what.into(), size, limit });
            }
        }
        Ok(())
    }

    /// Where vertices are not as they were recorded, has all bent again; the numbers of their
    /// instances then.
    pub fn heal(&mut self) -> impl Iterator<Item = usize> + '_ {
        let is_lost = !self.kept.holds();
        self.posed.iter_mut().filter(move |_| is_lost).map(|posed| {
            posed.changed = true;
            posed.instance
        })
    }

    /// Bends what has changed, and remakes its planes where there are any: `group` is that of
    /// [`planes_group`], `planes_of` tells where those of a mesh lie.
    pub fn record(
        &mut self,
        passes: &mut Passes<'_>,
        group: Option<&wgpu::BindGroup>,
        planes_of: impl Fn(u32) -> Option<Planes>,
    ) {
        let Some(device) = self.device.as_ref().filter(|_| self.posed.iter().any(|p| p.changed)) else { return };
        self.kept.note(passes);
        self.work.clear();
        self.joints.clear();
        let (mut most_vertices, mut most_triangles) = (0, 0);
        for (posed, mesh) in self.posed.iter_mut().zip(self.scene_meshes as u32..).filter(|(p, _)| p.changed) {
            posed.changed = false;
            let mut work = PosedMesh { first_joint: self.joints.len() as u32, ..posed.work };
            if let Some(Planes { first_triangle, triangle_count, center }) = planes_of(mesh) {
                work = PosedMesh { first_triangle, triangle_count, center, ..work };
            }
            most_vertices = most_vertices.max(work.vertex_count);
            most_triangles = most_triangles.max(work.triangle_count);
            self.joints.extend(posed.joints.iter().map(rows));
            self.work.push(work);
        }
        passes.upload(&device.work, bytemuck::cast_slice(&self.work));
        passes.upload(&device.joints, bytemuck::cast_slice(&self.joints));
        let mut pass = passes.compute("poses");
        let meshes = self.work.len() as u32;
        if most_vertices > 0 {
            pass.set_bind_group(1, &device.of_joints, &[]);
            for (group, pipeline) in [(&device.of_normals, &device.normals), (&device.of_positions, &device.vertices)] {
                pass.set_bind_group(0, group, &[]);
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(most_vertices.div_ceil(GROUP), meshes, 1);
            }
        }
        if let Some(planes) = group.filter(|_| most_triangles > 0) {
            pass.set_bind_group(0, &device.of_positions, &[]);
            pass.set_bind_group(1, planes, &[]);
            pass.set_pipeline(&device.planes);
            pass.dispatch_workgroups(most_triangles.div_ceil(GROUP), meshes, 1);
        }
    }

    /// GPU memory.
    pub fn bytes(&self) -> u64 {
        self.device.as_ref().map_or(0, |d| d.bytes)
    }
}

/// Who holds the vertices of all meshes with joints, as `pose_vertices.wgsl` has it: where the
/// joints of each vertex start in the list itself, then pairs of a joint and its weight. And of
/// each mesh the place of its first start.
fn weights(scene: &Scene) -> (Vec<u32>, Vec<u32>) {
    let (mut ends, mut pairs) = (vec![0], Vec::new());
    let mut first_start = vec![0; scene.meshes.len()];
    for (mesh, first) in scene.meshes.iter().zip(&mut first_start).filter(|(m, _)| !m.weights.is_empty()) {
        let base = pairs.len() as u32 / 2;
        *first = ends.len() as u32 - 1;
        pairs.extend(mesh.weights.influences().iter().flat_map(|i| [i.joint, i.weight.to_bits()]));
        ends.extend((0..mesh.positions.len()).scan(0, |end, vertex| {
            *end = mesh.weights.ends().get(vertex).copied().unwrap_or(*end);
            Some(base + *end)
        }));
    }
    let of_starts = ends.len() as u32;
    (ends.into_iter().map(|end| of_starts + 2 * end).chain(pairs).collect(), first_start)
}

/// The planes of a mesh among those of all.
pub(super) struct Planes {
    pub first_triangle: u32,
    pub triangle_count: u32,
    /// What planes are relative to, in mesh space.
    pub center: [f32; 3],
}

fn rows(joint: &DAffine3) -> JointRows {
    let m = joint.matrix3.transpose();
    let t = joint.translation;
    let row = |axis: DVec3, t: f64| axis.extend(t).as_vec4().to_array();
    JointRows { row0: row(m.x_axis, t.x), row1: row(m.y_axis, t.y), row2: row(m.z_axis, t.z) }
}

#[cfg(test)]
mod tests;

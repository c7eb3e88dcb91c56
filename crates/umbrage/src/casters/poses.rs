//! Meshes that joints bend: every instance with a pose has vertices of its own in the shared
//! buffers, which a compute pass fills when the pose changes. All techniques, and hosts, draw them
//! like any others.

mod device;

use super::geometry::{Geometry, MeshPart};
use crate::{error::Error, gpu::Gpu, passes::Passes, shader::Shared};
pub(crate) use device::SHADERS;
pub(super) use device::planes_group;
use device::{Device, GROUP, JointRows, PosedMesh};
use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, OnceLock};
use umbrage_core::adjacency::Adjacency;
use umbrage_core::glam::{DAffine3, DVec3, Vec4};
use umbrage_core::rig::JointBoxes;
use umbrage_core::{Bounds, Mesh};

/// What the host has to agree on with `poses.wgsl`.
pub(super) const SHARED: Shared = Shared { module: "poses", layouts: &[PosedMesh::LAYOUT], constants: &[] };

/// The instances that have a pose.
#[derive(Default)]
pub(super) struct Poses {
    /// By the number of the instance's own mesh.
    posed: BTreeMap<u32, Posed>,
    /// By the number of the mesh as it was bound, and its version.
    boxes: HashMap<u32, (u64, Arc<JointBoxes>)>,
    device: Option<Device>,
    /// What changed, as it goes to the GPU. Keep their memory.
    work: Vec<PosedMesh>,
    rows: Vec<JointRows>,
}

/// One of them.
struct Posed {
    boxes: Arc<JointBoxes>,
    joints: Vec<DAffine3>,
    changed: bool,
    /// Made when the CPU asks for them.
    planes: OnceLock<Vec<Vec4>>,
}

impl Poses {
    /// A box that surely holds a mesh that joints bend.
    pub fn bounds_of(&mut self, number: u32, bound: &MeshPart, joints: &[DAffine3]) -> Bounds {
        self.boxes_of(number, bound).posed(joints)
    }

    fn boxes_of(&mut self, number: u32, bound: &MeshPart) -> Arc<JointBoxes> {
        let known = self.boxes.get(&number).filter(|(version, _)| *version == bound.version);
        if let Some((_, boxes)) = known {
            return boxes.clone();
        }
        let boxes = Arc::new(JointBoxes::of(&bound.mesh));
        self.boxes.insert(number, (bound.version, boxes.clone()));
        boxes
    }

    /// Whether such a mesh can be bent, beside those that are.
    pub fn check(&self, gpu: &Gpu, bound: &MeshPart, joints: usize) -> Result<(), Error> {
        let limits = gpu.device.limits();
        let groups = u64::from(limits.max_compute_workgroups_per_dimension);
        let rows = joints + self.posed.values().map(|p| p.joints.len()).sum::<usize>();
        let (vertices, triangles) = (bound.mesh.positions.len() as u64, bound.mesh.triangle_count() as u64);
        let binding = limits.max_storage_buffer_binding_size;
        for (what, size, limit) in [
            ("instances that have a pose", self.posed.len() as u64 + 1, groups),
            ("the vertices of a mesh with joints", vertices, groups * u64::from(GROUP)),
            ("the triangles of a mesh with joints", triangles, groups * u64::from(GROUP)),
            ("the joints of all poses", rows as u64 * size_of::<JointRows>() as u64, binding),
        ] {
            if size > limit {
                return Err(Error::Size { what: what.into(), size, limit });
            }
        }
        Ok(())
    }

    /// Has `own`, a mesh made of the mesh `source`, follow joints.
    pub fn add(&mut self, own: u32, (source, bound): (u32, &MeshPart), joints: Vec<DAffine3>) {
        let boxes = self.boxes_of(source, bound);
        self.posed.insert(own, Posed { boxes, joints, changed: true, planes: OnceLock::new() });
    }

    pub fn remove(&mut self, own: u32) -> Option<Vec<DAffine3>> {
        self.posed.remove(&own).map(|posed| posed.joints)
    }

    /// A box that surely holds such a mesh as it is bent.
    pub fn bounds(&self, own: u32) -> Bounds {
        self.posed.get(&own).map_or(Bounds::EMPTY, |p| p.boxes.posed(&p.joints))
    }

    /// Changes a pose; false where it is the same, or none.
    ///
    /// # Errors
    /// [`Error::Scene`] for a matrix that is not finite.
    pub fn set(&mut self, own: u32, joints: &[DAffine3]) -> Result<bool, Error> {
        finite(joints)?;
        let Some(posed) = self.posed.get_mut(&own) else { return Ok(false) };
        let new = || joints.iter().copied().chain(std::iter::repeat(DAffine3::IDENTITY));
        if posed.joints.iter().zip(new()).all(|(joint, new)| *joint == new) {
            return Ok(false);
        }
        posed.joints.iter_mut().zip(new()).for_each(|(joint, new)| *joint = new);
        posed.changed = true;
        posed.planes = OnceLock::new();
        Ok(true)
    }

    /// Bends all anew: what was recorded for them never was submitted.
    pub fn mark_all(&mut self) {
        self.posed.values_mut().for_each(|posed| posed.changed = true);
    }

    /// True where a pose changed since it was recorded.
    pub fn have_changed(&self) -> bool {
        self.posed.values().any(|posed| posed.changed)
    }

    /// A mesh as it is bent, by the CPU; `None` for meshes without a pose. `part` is the posed
    /// instance's own.
    pub fn posed(&self, own: u32, part: &MeshPart) -> Option<Mesh> {
        Some(part.mesh.posed(&self.posed.get(&own)?.joints))
    }

    /// Planes of a bent mesh, by the CPU; `None` for meshes without a pose.
    pub fn planes(&self, own: u32, part: &MeshPart, adjacency: &Adjacency) -> Option<&[Vec4]> {
        let posed = self.posed.get(&own)?;
        Some(posed.planes.get_or_init(|| adjacency.planes_in(&part.mesh.posed(&posed.joints))))
    }

    /// Bends what has changed, and remakes its planes where there are any, and those of meshes that
    /// have `moved`: `group` is that of [`planes_group`], `planes_of` tells where those of a mesh
    /// lie.
    ///
    /// # Errors
    /// [`Error::Size`] where the vertices of all meshes are more than a shader may write.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        passes: &mut Passes<'_>,
        geometry: &Geometry,
        (group, moved): (Option<&wgpu::BindGroup>, &[u32]),
        planes_of: impl Fn(u32) -> Option<Planes>,
    ) -> Result<(), Error> {
        if !self.have_changed() && moved.is_empty() {
            return Ok(());
        }
        self.work.clear();
        self.rows.clear();
        let (mut most_vertices, mut most_triangles) = (0, 0);
        for (number, posed) in self.posed.iter().filter(|(_, p)| p.changed) {
            let mut work = PosedMesh { first_joint: self.rows.len() as u32, ..numbers(geometry, *number) };
            if let Some(Planes { first_triangle, triangle_count, center }) = planes_of(*number) {
                work = PosedMesh { first_triangle, triangle_count, center, ..work };
            }
            most_vertices = most_vertices.max(work.vertex_count);
            most_triangles = most_triangles.max(work.triangle_count);
            self.rows.extend(posed.joints.iter().map(rows));
            self.work.push(work);
        }
        for number in moved {
            let Some(Planes { first_triangle, triangle_count, center }) = planes_of(*number) else { continue };
            most_triangles = most_triangles.max(triangle_count);
            let part = &geometry.meshes[*number as usize];
            let (vertex, first_index) = (part.base_vertex, part.first_index);
            let planes = PosedMesh { first_triangle, triangle_count, center, ..PosedMesh::default() };
            self.work.push(PosedMesh { vertex, first_index, ..planes });
        }
        if self.work.is_empty() {
            return Ok(());
        }
        let device = self.device.get_or_insert_with(|| Device::new(gpu));
        device.fit(gpu, geometry, [self.work.len(), self.rows.len()])?;
        let Some(bound) = device.bound() else { return Ok(()) };
        passes.upload(&bound.work, bytemuck::cast_slice(&self.work));
        passes.upload(&bound.joints, bytemuck::cast_slice(&self.rows));
        let mut pass = passes.compute("poses");
        let meshes = self.work.len() as u32;
        if most_vertices > 0 {
            pass.set_bind_group(1, &bound.of_joints, &[]);
            for (group, pipeline) in [(&bound.of_normals, &device.normals), (&bound.of_positions, &device.vertices)] {
                pass.set_bind_group(0, group, &[]);
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(most_vertices.div_ceil(GROUP), meshes, 1);
            }
        }
        if let Some(planes) = group.filter(|_| most_triangles > 0) {
            pass.set_bind_group(0, &bound.of_positions, &[]);
            pass.set_bind_group(1, planes, &[]);
            pass.set_pipeline(device.planes(gpu));
            pass.dispatch_workgroups(most_triangles.div_ceil(GROUP), meshes, 1);
        }
        self.posed.values_mut().for_each(|posed| posed.changed = false);
        Ok(())
    }

    /// GPU memory.
    pub fn bytes(&self) -> u64 {
        self.device.as_ref().map_or(0, Device::bytes)
    }
}

/// Where a posed mesh lies, the planes apart.
fn numbers(geometry: &Geometry, own: u32) -> PosedMesh {
    let part = &geometry.meshes[own as usize];
    let Some(source) = part.source.map(|source| &geometry.meshes[source as usize]) else {
        return PosedMesh::default();
    };
    PosedMesh {
        bound_vertex: source.base_vertex,
        vertex: part.base_vertex,
        vertex_count: if source.mesh.weights.is_empty() { 0 } else { source.mesh.positions.len() as u32 },
        first_start: source.weights.start,
        first_index: source.first_index,
        ..PosedMesh::default()
    }
}

/// # Errors
/// [`Error::Scene`] for a matrix that is not finite.
pub(super) fn finite(joints: &[DAffine3]) -> Result<(), Error> {
    match joints.iter().position(|joint| !joint.is_finite()) {
        Some(i) => Err(Error::Scene(format!("the matrix of joint {i} is not finite; give the joint's last one"))),
        None => Ok(()),
    }
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

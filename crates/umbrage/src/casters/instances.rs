//! Instances that come, go and change.

use super::check::transform;
use super::ids::{InstanceId, MaterialId, MeshId};
use super::lent::Many;
use super::placed::{Placed, Wanted};
use super::poses;
use super::world::Casters;
use crate::error::Error;
use std::sync::Arc;
use umbrage_core::glam::DAffine3;

/// A mesh to be placed in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// What is placed.
    pub mesh: MeshId,
    /// How it looks; an alpha mask is part of that.
    pub material: MaterialId,
    /// Places it. Mirrored and squeezed flat is fine.
    pub world_from_mesh: DAffine3,
    /// False: it casts no shadow.
    pub casts: bool,
    /// False: no shadow falls on it.
    pub receives: bool,
    /// What joints do to a mesh that has weights, as in [`Casters::set_pose`]; `None` for a mesh as
    /// it is.
    pub joints: Option<Vec<DAffine3>>,
    /// A number of the host's own, which shaders find with the instance.
    pub model: u32,
}

impl Placement {
    /// Casts and receives, without joints.
    pub fn new(mesh: MeshId, material: MaterialId, world_from_mesh: DAffine3) -> Self {
        Self { mesh, material, world_from_mesh, casts: true, receives: true, joints: None, model: 0 }
    }
}

/// The same with numbers for handles.
pub(super) struct Numbered {
    pub mesh: u32,
    pub material: u32,
    pub world_from_mesh: DAffine3,
    pub wanted: Wanted,
    pub joints: Option<Vec<DAffine3>>,
    pub many: Option<Arc<Many>>,
    pub model: u32,
}

impl Casters {
    /// Places a mesh in the world. Costs what the tree over all instances takes for one, however
    /// many there are.
    ///
    /// # Errors
    /// [`Error::Handle`] for a mesh or a material that is not there; [`Error::Scene`] for a
    /// transform or joints that are not finite, and for fewer joints than the mesh needs;
    /// [`Error::Size`] beyond the adapter's limits. Nothing has changed then.
    pub fn insert(&mut self, new: &Placement) -> Result<InstanceId, Error> {
        let mesh = self.geometry.slots.find(new.mesh.0)?;
        let material = self.appearance.slots.find(new.material.0)?;
        transform(&new.world_from_mesh)?;
        let place = self.place(Numbered {
            mesh,
            material,
            world_from_mesh: new.world_from_mesh,
            wanted: Wanted { casts: new.casts, receives: new.receives },
            joints: new.joints.clone(),
            many: None,
            model: new.model,
        })?;
        self.id_at(place).map(InstanceId).ok_or(Error::Handle { what: "instance" })
    }

    pub(super) fn place(&mut self, new: Numbered) -> Result<u32, Error> {
        self.instances.check(self.placed.len() as u64 + 1)?;
        let is_bent = !self.geometry.meshes[new.mesh as usize].mesh.weights.is_empty();
        let own = match new.joints.filter(|_| is_bent) {
            Some(joints) => Some(self.bend(new.mesh, joints)?),
            None => None,
        };
        let (place, _) = self.slots.insert();
        self.came += 1;
        self.live += 1;
        self.in_order &= place as usize == self.placed.len();
        if place as usize == self.placed.len() {
            self.placed.push(Placed::nothing());
        }
        self.solid.make_room(place);
        self.placed[place as usize] = Placed {
            mesh: own.unwrap_or(new.mesh),
            has_own_mesh: own.is_some(),
            many: new.many,
            world_from_mesh: new.world_from_mesh,
            material: new.material,
            wanted: new.wanted,
            shown: true,
            model: new.model,
            order: self.came,
            ..Placed::nothing()
        };
        self.join_mesh(place);
        self.join_material(place);
        self.shape(place);
        Ok(place)
    }

    /// Vertices of its own for an instance with joints.
    fn bend(&mut self, source: u32, mut joints: Vec<DAffine3>) -> Result<u32, Error> {
        poses::finite(&joints)?;
        let Self { gpu, geometry, journal, poses, .. } = self;
        let bound = &geometry.meshes[source as usize];
        let needed = bound.mesh.weights.influences().iter().map(|i| i.joint as usize + 1).max().unwrap_or(0);
        if joints.len() < needed {
            let given = joints.len();
            return Err(Error::Scene(format!("{given} joints were given where the mesh has {needed}")));
        }
        joints.shrink_to_fit();
        poses.check(gpu, bound, joints.len())?;
        let bounds = poses.bounds_of(source, bound, &joints);
        let posed = bound.mesh.posed(&joints);
        let own = geometry.add_posed(gpu, journal, source, (&posed, bounds))?;
        poses.add(own, (source, &geometry.meshes[source as usize]), joints);
        self.make_edges(own);
        Ok(own)
    }

    /// Takes an instance away. What is kept of others stays; its handle names nothing from now on.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there.
    pub fn remove(&mut self, instance: InstanceId) -> Result<(), Error> {
        let place = self.slots.find(instance.0)?;
        self.placed[place as usize].shown = false;
        self.track(place);
        self.leave_mesh(place);
        self.leave_material(place);
        let Placed { mesh, has_own_mesh, batch, .. } = self.placed[place as usize];
        self.batches.leave(batch);
        if has_own_mesh {
            self.unbend(mesh);
        }
        self.placed[place as usize] = Placed::nothing();
        self.slots.remove(place);
        self.live -= 1;
        Ok(())
    }

    pub(super) fn unbend(&mut self, own: u32) -> Option<Vec<DAffine3>> {
        self.geometry.remove(own);
        if let Some(edges) = self.edges.get_mut() {
            edges.remove(own);
        }
        self.poses.remove(own)
    }

    /// Moves an instance. A place that it has already changes nothing: whoever has not moved lately
    /// is at rest, and maps of those at rest are kept.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there; [`Error::Scene`] for a transform that is not
    /// finite. Nothing has changed then.
    pub fn move_instance(&mut self, instance: InstanceId, world_from_mesh: &DAffine3) -> Result<(), Error> {
        let place = self.slots.find(instance.0)?;
        transform(world_from_mesh)?;
        let placed = &mut self.placed[place as usize];
        if placed.world_from_mesh != *world_from_mesh {
            placed.world_from_mesh = *world_from_mesh;
            self.shape(place);
        }
        Ok(())
    }

    /// Bends an instance that was placed with joints: `joints` are what each of them does to the
    /// mesh as it was bound, see [`umbrage_core::Rig::joints_at`]; a missing one does nothing.
    /// Costs a box a joint; vertices follow on the GPU, see [`Casters::record`]. Instances
    /// without joints do not bend, and a pose that it has already changes nothing.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there; [`Error::Scene`] for a matrix that is not
    /// finite. Nothing has changed then.
    pub fn set_pose(&mut self, instance: InstanceId, joints: &[DAffine3]) -> Result<(), Error> {
        let place = self.slots.find(instance.0)?;
        let mesh = self.placed[place as usize].mesh;
        if self.poses.set(mesh, joints)? {
            self.geometry.meshes[mesh as usize].bounds = self.poses.bounds(mesh);
            self.shape(place);
        }
        Ok(())
    }

    /// Hides an instance, or shows it again. One that is hidden is as good as removed, but comes
    /// back as it was.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there.
    pub fn show(&mut self, instance: InstanceId, shown: bool) -> Result<(), Error> {
        let place = self.slots.find(instance.0)?;
        if self.placed[place as usize].shown != shown {
            self.placed[place as usize].shown = shown;
            self.track(place);
        }
        Ok(())
    }

    /// Says whether an instance casts shadows, and whether shadows fall on it.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there.
    pub fn set_flags(&mut self, instance: InstanceId, casts: bool, receives: bool) -> Result<(), Error> {
        let place = self.slots.find(instance.0)?;
        let wanted = Wanted { casts, receives };
        if self.placed[place as usize].wanted != wanted {
            self.placed[place as usize].wanted = wanted;
            self.track(place);
        }
        Ok(())
    }

    /// Gives an instance another material.
    ///
    /// # Errors
    /// [`Error::Handle`] for an instance or a material that is not there.
    pub fn set_material(&mut self, instance: InstanceId, material: MaterialId) -> Result<(), Error> {
        let place = self.slots.find(instance.0)?;
        let material = self.appearance.slots.find(material.0)?;
        if self.placed[place as usize].material != material {
            self.leave_material(place);
            self.placed[place as usize].material = material;
            let was_masked = self.placed[place as usize].masked;
            self.join_material(place);
            self.look_otherwise(place, was_masked);
        }
        Ok(())
    }

    /// True where there is such an instance.
    pub fn has(&self, instance: InstanceId) -> bool {
        self.slots.find(instance.0).is_ok()
    }
}

//! Geometry that a host lends, and geometry that a host may read.

use super::check::transform;
use super::geometry::Vertices;
use super::ids::{InstanceId, MeshId};
use super::instances::Numbered;
use super::lent::{LentInstances, LentMesh, Many, check_bounds, check_instances, check_mesh};
use super::placed::{Placed, Wanted};
use super::world::Casters;
use crate::error::Error;
use std::sync::Arc;
use umbrage_core::Bounds;

impl Casters {
    /// Adds a mesh that is drawn from a host's own buffers, where they are, to be placed by
    /// [`Casters::insert`] or [`Casters::insert_lent`]. [`crate::SeenCasters`] leaves it to the
    /// host to draw. Nothing is copied but what [`crate::LentShape`] tells, which takes 36 bytes a
    /// vertex and 8 an index for techniques with edges.
    ///
    /// # Errors
    /// [`Error::Lent`] for buffers that are too small, were made without a usage that is needed,
    /// are of another device, or have steps or formats that vertices can't be fetched by;
    /// [`Error::Scene`] for a box that is empty or not finite and for a shape with an index beyond
    /// its vertices; [`Error::Size`] beyond the device's limits. Nothing has changed then.
    pub fn lend_mesh(&mut self, mesh: &LentMesh<'_>) -> Result<MeshId, Error> {
        check_mesh(&self.gpu, mesh)?;
        let number = self.geometry.lend(&self.gpu, &mut self.journal, mesh)?;
        self.follow_lent(number);
        self.make_edges(number);
        self.geometry.slots.at(number).map(MeshId).ok_or(Error::Handle { what: "mesh" })
    }

    /// Puts a mesh that is lent in the place of any mesh, such as the same one in larger buffers:
    /// its instances become instances of that.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there; [`Error::Scene`] while joints bend one of its
    /// instances; as [`Casters::lend_mesh`]. The mesh stays as it is then.
    pub fn lend_mesh_again(&mut self, mesh: MeshId, by: &LentMesh<'_>) -> Result<(), Error> {
        let number = self.geometry.slots.find(mesh.0)?;
        self.check_unbent(number)?;
        check_mesh(&self.gpu, by)?;
        self.geometry.lend_again(&self.gpu, &mut self.journal, number, by)?;
        self.follow_lent(number);
        self.follow_mesh(number);
        Ok(())
    }

    /// Says that a host has written to the vertices of a mesh that it lends, and where they are
    /// now: a box in mesh space. What is kept of its instances, such as maps, is made anew. What
    /// the host writes has to come before [`Casters::record`], in the same encoder or an earlier
    /// one.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there; [`Error::Lent`] for one that is not lent, and
    /// for one of [`crate::LentShape::Rigid`]; [`Error::Scene`] for a box that is empty or not
    /// finite. Nothing has changed then.
    pub fn touch_mesh(&mut self, mesh: MeshId, bounds: &Bounds) -> Result<(), Error> {
        let number = self.geometry.slots.find(mesh.0)?;
        let part = &self.geometry.meshes[number as usize];
        if part.lent.is_none() {
            return Err(Error::Lent("this mesh is not lent; call `deform_mesh` or `replace_mesh`".into()));
        }
        if !part.is_moving() && !part.is_unknown() {
            let what = "this mesh is lent as one that stays as it is; lend it again as `LentShape::Moving`, or as \
                        `LentShape::Unknown` where maps of depth are all that is drawn";
            return Err(Error::Lent(what.into()));
        }
        check_bounds(bounds)?;
        self.geometry.touch(number, *bounds);
        self.following.mark(number);
        let members = self.geometry.meshes[number as usize].members.clone();
        members.into_iter().for_each(|place| self.shape(place));
        Ok(())
    }

    /// Places a mesh by matrices in a buffer of the host's own, which are read where they are: one
    /// caster with many instances, for which the host tells one box. [`Casters::move_instance`]
    /// moves all of them, and [`Casters::remove`], [`Casters::show`] and others do what they do to
    /// any instance. Techniques that need more than depth refuse them.
    ///
    /// # Errors
    /// [`Error::Handle`] for a mesh or a material that is not there; [`Error::Lent`] as in
    /// [`Casters::lend_mesh`]; [`Error::Scene`] for a transform or a box that is not finite;
    /// [`Error::Size`] beyond the device's limits. Nothing has changed then.
    pub fn insert_lent(&mut self, new: &LentInstances) -> Result<InstanceId, Error> {
        let mesh = self.geometry.slots.find(new.mesh.0)?;
        let material = self.appearance.slots.find(new.material.0)?;
        transform(&new.world_from_group)?;
        check_instances(&self.gpu, new)?;
        let place = self.place(Numbered {
            mesh,
            material,
            world_from_mesh: new.world_from_group,
            wanted: Wanted { casts: new.casts, receives: new.receives },
            joints: None,
            many: Some(Arc::new(Many::of(new))),
            model: 0,
        })?;
        self.id_at(place).map(InstanceId).ok_or(Error::Handle { what: "instance" })
    }

    /// Says that a host has written to the matrices that it lends: how many there are now, no more
    /// than before, and a box around all instances, in group space. What is kept of them is made
    /// anew.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there; [`Error::Lent`] for one that is not placed by
    /// lent matrices, and for more matrices than were lent; [`Error::Scene`] for a box that is
    /// empty or not finite. Nothing has changed then.
    pub fn touch_instances(&mut self, instance: InstanceId, count: u32, bounds: &Bounds) -> Result<(), Error> {
        let place = self.slots.find(instance.0)?;
        let Some(many) = &mut self.placed[place as usize].many else {
            return Err(Error::Lent("this instance has no lent matrices; call `move_instance`".into()));
        };
        let changed = many.touched(count, *bounds)?;
        *many = Arc::new(changed);
        self.shape(place);
        Ok(())
    }

    /// Where an instance's vertices lie once [`Casters::record`] is executed, so that a host draws
    /// what joints have bent without doing that a second time. Its buffers have the usages `VERTEX`
    /// and `STORAGE`, and `INDEX`.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there; [`Error::Lent`] for one of a mesh that the host
    /// lends.
    pub fn vertices(&self, instance: InstanceId) -> Result<Vertices<'_>, Error> {
        let placed = &self.placed[self.slots.find(instance.0)? as usize];
        let part = &self.geometry.meshes[placed.mesh as usize];
        if part.lent.is_some() {
            return Err(Error::Lent("the vertices of a mesh that is lent are where the host has them".into()));
        }
        Ok(self.geometry.vertices(part))
    }

    /// # Errors
    /// [`Error::Unsupported`] where casters are lent in such a way that nobody knows their edges.
    pub(crate) fn check_known(&self) -> Result<(), Error> {
        if self.blind == 0 {
            return Ok(());
        }
        unsupported(
            "lent casters whose triangles are not known; lend meshes with `LentShape::Rigid` or `Moving` and place \
             them by `insert`, or choose a technique with depth maps",
        )
    }

    /// # Errors
    /// [`Error::Unsupported`] where a host moves vertices of some of these casters, which the CPU
    /// can't follow as it does joints.
    pub(crate) fn check_told(&self, mut places: impl Iterator<Item = u32>) -> Result<(), Error> {
        let is_told = |placed: &Placed| placed.has_own_mesh || !placed.posed;
        if places.all(|place| is_told(&self.placed[place as usize])) {
            return Ok(());
        }
        unsupported(
            "lent meshes whose vertices the host moves, since it has to know on the CPU where they are; give them by \
             `deform_mesh`, or choose another technique",
        )
    }

    /// Has the library's copy of vertices follow those that the host moves.
    fn follow_lent(&mut self, number: u32) {
        self.following.remove(number);
        self.edges_do_not_fit = false;
        let part = &self.geometry.meshes[number as usize];
        if let Some(lent) = part.lent.as_ref().filter(|lent| lent.is_moving) {
            let vertices = (part.base_vertex, part.mesh.positions.len() as u32);
            self.following.set(&self.gpu, number, lent, vertices);
        }
    }
}

fn unsupported(what: &str) -> Result<(), Error> {
    Err(Error::Unsupported { technique: "this technique".into(), what: what.into() })
}

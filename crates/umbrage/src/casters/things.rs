//! Meshes, materials and textures that come, go and change; and what a scene brings.

use super::check::check;
use super::ids::{InstanceId, MaterialId, MeshId, TextureId};
use super::instances::Numbered;
use super::material::Look;
use super::placed::Wanted;
use super::world::{Casters, next_version};
use crate::{error::Error, gpu::Gpu};
use umbrage_core::{Material, Mesh, Scene, Texture};

impl Casters {
    /// Uploads a scene's meshes, instances, materials and textures.
    /// [`Casters::instance`] and its kin tell the handles of what is in the scene.
    ///
    /// # Errors
    /// [`Error::Size`] beyond the adapter's limits; [`Error::Scene`] for an index that leads
    /// nowhere, and a transform that is not finite.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self, Error> {
        gpu.check_loss()?;
        check(scene)?;
        let mut casters = Self::with_room(gpu, scene)?;
        casters.fill(scene)?;
        Ok(casters)
    }

    /// None yet.
    ///
    /// # Errors
    /// [`Error::Size`] on an adapter that allows hardly anything.
    pub fn empty(gpu: &Gpu) -> Result<Self, Error> {
        Self::new(gpu, &Scene::default())
    }

    /// All of a scene, in its order, and on the GPU at once.
    pub(super) fn fill(&mut self, scene: &Scene) -> Result<(), Error> {
        for texture in &scene.textures {
            self.appearance.add_texture(&self.gpu, texture)?;
        }
        for material in &scene.materials {
            let texture = material.texture.map(|texture| texture as u32);
            self.appearance.add(&self.gpu, &mut self.journal, material, texture)?;
        }
        for mesh in &scene.meshes {
            self.geometry.add(&self.gpu, &mut self.journal, mesh)?;
        }
        for instance in &scene.instances {
            self.place(Numbered {
                mesh: instance.mesh as u32,
                material: instance.material as u32,
                world_from_mesh: instance.world_from_mesh,
                wanted: Wanted { casts: instance.casts, receives: instance.receives },
                joints: scene.joints(instance),
                many: None,
                model: instance.model as u32,
            })?;
        }
        self.in_scene = [scene.instances.len(), scene.meshes.len(), scene.materials.len(), scene.textures.len()];
        self.settle();
        self.write_instances()?;
        let gpu = self.gpu.clone();
        self.journal.finish(&gpu);
        self.bind();
        Ok(())
    }

    /// The handle of an instance, by its place in [`Scene::instances`] of the scene that these
    /// casters were made of; `None` beyond it.
    pub fn instance(&self, number: usize) -> Option<InstanceId> {
        self.slots.first_at(number).filter(|_| number < self.in_scene[0]).map(InstanceId)
    }

    /// The same for [`Scene::meshes`].
    pub fn mesh(&self, number: usize) -> Option<MeshId> {
        self.geometry.slots.first_at(number).filter(|_| number < self.in_scene[1]).map(MeshId)
    }

    /// The same for [`Scene::materials`].
    pub fn material(&self, number: usize) -> Option<MaterialId> {
        self.appearance.slots.first_at(number).filter(|_| number < self.in_scene[2]).map(MaterialId)
    }

    /// The same for [`Scene::textures`].
    pub fn texture(&self, number: usize) -> Option<TextureId> {
        self.appearance.texture_slots.first_at(number).filter(|_| number < self.in_scene[3]).map(TextureId)
    }

    /// Adds a mesh, to be placed by [`Casters::insert`].
    ///
    /// # Errors
    /// [`Error::Scene`] for an index beyond its vertices; [`Error::Size`] beyond the adapter's
    /// limits. Nothing has changed then.
    pub fn add_mesh(&mut self, mesh: &Mesh) -> Result<MeshId, Error> {
        let number = self.geometry.add(&self.gpu, &mut self.journal, mesh)?;
        self.make_edges(number);
        self.geometry.slots.at(number).map(MeshId).ok_or(Error::Handle { what: "mesh" })
    }

    /// Puts another mesh in the place of one: its instances become instances of that.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there; as [`Casters::add_mesh`]; [`Error::Scene`]
    /// while joints bend one of its instances. The mesh stays as it is then.
    pub fn replace_mesh(&mut self, mesh: MeshId, by: &Mesh) -> Result<(), Error> {
        let number = self.geometry.slots.find(mesh.0)?;
        self.check_unbent(number)?;
        self.geometry.replace(&self.gpu, &mut self.journal, number, by)?;
        self.following.remove(number);
        self.follow_mesh(number);
        Ok(())
    }

    /// # Errors
    /// [`Error::Scene`] while joints bend an instance of a mesh.
    pub(super) fn check_unbent(&self, number: u32) -> Result<(), Error> {
        let is_posed = |place: &u32| self.placed[*place as usize].has_own_mesh;
        if self.geometry.meshes[number as usize].members.iter().any(is_posed) {
            let what = "a mesh that joints bend is replaced as a new one: remove its instances, add the mesh, insert \
                        them again";
            return Err(Error::Scene(what.into()));
        }
        Ok(())
    }

    /// Moves the vertices of a mesh. `to` has the same triangles, and as many vertices; this is
    /// cheaper than [`Casters::replace_mesh`], since nothing moves in memory.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there; [`Error::Scene`] for other triangles or another
    /// number of vertices, and for a mesh that joints bend. The mesh stays as it is then.
    pub fn deform_mesh(&mut self, mesh: MeshId, to: &Mesh) -> Result<(), Error> {
        let number = self.geometry.slots.find(mesh.0)?;
        let part = &self.geometry.meshes[number as usize];
        if part.lent.is_some() {
            return Err(Error::Lent("a mesh that is lent is written to by the host; then call `touch_mesh`".into()));
        }
        let known = &part.mesh;
        if known.positions.len() != to.positions.len() || known.indices != to.indices {
            let what = "a mesh is deformed with the same triangles and number of vertices; use `replace_mesh`";
            return Err(Error::Scene(what.into()));
        }
        if !known.weights.is_empty() || !to.weights.is_empty() {
            return Err(Error::Scene("a mesh with joints is bent, not deformed; use `set_pose`".into()));
        }
        self.geometry.deform(&mut self.journal, number, to);
        self.follow_mesh(number);
        Ok(())
    }

    /// Takes a mesh away that has no instances.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there; [`Error::Scene`] while it has instances.
    pub fn remove_mesh(&mut self, mesh: MeshId) -> Result<(), Error> {
        let number = self.geometry.slots.find(mesh.0)?;
        let users = self.geometry.meshes[number as usize].members.len();
        if users > 0 {
            return Err(Error::Scene(format!("{users} instances have this mesh; remove them first")));
        }
        self.geometry.remove(number);
        self.following.remove(number);
        self.edges_do_not_fit = false;
        if let Some(edges) = self.edges.get_mut() {
            edges.remove(number);
        }
        if let Some(planes) = self.receiver_planes.get_mut() {
            planes.forget_mesh(number);
        }
        Ok(())
    }

    /// Adds a material, with the texture that goes with it; [`Material::texture`] is not read.
    ///
    /// # Errors
    /// [`Error::Handle`] for a texture that is not there; [`Error::Size`] beyond the adapter's
    /// limits.
    pub fn add_material(&mut self, material: &Material, texture: Option<TextureId>) -> Result<MaterialId, Error> {
        let texture = self.texture_number(texture)?;
        let number = self.appearance.add(&self.gpu, &mut self.journal, material, texture)?;
        self.appearance.slots.at(number).map(MaterialId).ok_or(Error::Handle { what: "material" })
    }

    /// Changes a material, and with it all instances that have it.
    ///
    /// # Errors
    /// [`Error::Handle`] for a material or a texture that is not there.
    pub fn replace_material(
        &mut self,
        material: MaterialId,
        by: &Material,
        texture: Option<TextureId>,
    ) -> Result<(), Error> {
        let number = self.appearance.slots.find(material.0)?;
        let texture = self.texture_number(texture)?;
        self.appearance.set(&mut self.journal, number, by, texture);
        self.follow_material(number);
        Ok(())
    }

    /// Takes a material away that no instance has.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there; [`Error::Scene`] while instances have it.
    pub fn remove_material(&mut self, material: MaterialId) -> Result<(), Error> {
        let number = self.appearance.slots.find(material.0)?;
        self.appearance.remove(number)
    }

    /// Adds a texture. It goes to the GPU at once, since no frame in flight can have it.
    ///
    /// # Errors
    /// [`Error::Size`] beyond the adapter's limits; [`Error::Scene`] for one that has not width ×
    /// height pixels.
    pub fn add_texture(&mut self, texture: &Texture) -> Result<TextureId, Error> {
        let number = self.appearance.add_texture(&self.gpu, texture)?;
        self.appearance.texture_slots.at(number).map(TextureId).ok_or(Error::Handle { what: "texture" })
    }

    /// Puts another texture in the place of one, of any size.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there; as [`Casters::add_texture`].
    pub fn replace_texture(&mut self, texture: TextureId, by: &Texture) -> Result<(), Error> {
        let number = self.appearance.texture_slots.find(texture.0)?;
        self.appearance.replace_texture(&self.gpu, number, by)?;
        // What is opaque casts the same, whatever its picture.
        let is_masked = |look: &Look| look.masked && look.texture == Some(number);
        let looks = (0..).zip(&self.appearance.looks).filter(|(_, look)| is_masked(look));
        let materials: Vec<u32> = looks.map(|(material, _)| material).collect();
        materials.into_iter().for_each(|material| self.follow_material(material));
        Ok(())
    }

    /// Takes a texture away that no material has.
    ///
    /// # Errors
    /// [`Error::Handle`] for one that is not there; [`Error::Scene`] while materials have it.
    pub fn remove_texture(&mut self, texture: TextureId) -> Result<(), Error> {
        let number = self.appearance.texture_slots.find(texture.0)?;
        self.appearance.remove_texture(number)
    }

    fn texture_number(&self, texture: Option<TextureId>) -> Result<Option<u32>, Error> {
        texture.map(|texture| self.appearance.texture_slots.find(texture.0)).transpose()
    }

    /// After a material has changed.
    fn follow_material(&mut self, number: u32) {
        let members = self.appearance.looks[number as usize].members.clone();
        members.into_iter().for_each(|place| {
            let was_masked = self.placed[place as usize].masked;
            self.look_otherwise(place, was_masked);
        });
    }

    /// After a mesh has changed.
    pub(super) fn follow_mesh(&mut self, number: u32) {
        self.make_edges(number);
        if let Some(planes) = self.receiver_planes.get_mut() {
            planes.forget_mesh(number);
        }
        let members = self.geometry.meshes[number as usize].members.clone();
        members.into_iter().for_each(|place| self.shape(place));
    }

    /// Makes edges of a mesh that is new or has changed, where there are edges of all meshes. Where
    /// they do not fit, there are none any more, and techniques that ask for them say why.
    pub(super) fn make_edges(&mut self, number: u32) {
        let Some(edges) = self.edges.get_mut() else { return };
        let of = (&*self.geometry.meshes, &self.poses);
        if edges.set(&self.gpu, &mut self.journal, number, of).is_err() {
            self.edges.take();
            self.version = next_version();
        }
    }
}

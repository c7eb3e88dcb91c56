//! The casters of the world on the GPU.

use crate::extract::{Changes, Cutout, MaterialAsset, MeshAsset, Placed};
use bevy::ecs::entity::EntityHashMap;
use bevy::prelude::Entity;
use std::collections::HashMap;
use umbrage::core::Material;
use umbrage::core::glam::DAffine3;
use umbrage::{Casters, Error, Gpu, InstanceId, MaterialId, MeshId, Passes, Placement, TextureId};

/// Casters, and which of them is whose.
pub struct Mirror {
    casters: Casters,
    /// Of what has no material that cuts anything out.
    plain: MaterialId,
    meshes: HashMap<MeshAsset, MeshId>,
    materials: HashMap<MaterialAsset, (MaterialId, Option<TextureId>)>,
    placed: EntityHashMap<(InstanceId, Placed)>,
}

impl Mirror {
    /// Of an empty world.
    ///
    /// # Errors
    /// As [`Casters::empty`].
    pub fn new(gpu: &Gpu) -> Result<Self, Error> {
        let mut casters = Casters::empty(gpu)?;
        let plain = casters.add_material(&Material::default(), None)?;
        let (meshes, materials, placed) = Default::default();
        Ok(Self { casters, plain, meshes, materials, placed })
    }

    /// Takes over what has changed. What can't be is left as it was; its reason comes back.
    pub fn follow(&mut self, changes: Changes) -> Vec<Error> {
        let mut results = Vec::new();
        results.extend(changes.removed.iter().map(|entity| self.remove(*entity)));
        results.extend(changes.materials.into_iter().map(|(id, cutout)| self.material(id, &cutout)));
        for (id, mesh) in changes.meshes {
            results.push(self.mesh(id, &mesh));
        }
        results.extend(changes.placed.into_iter().map(|(entity, placed)| self.place(entity, placed)));
        results.extend(changes.moved.into_iter().map(|(entity, to)| self.move_to(entity, to)));
        results.extend(changes.bent.into_iter().map(|(entity, joints)| self.bend(entity, joints)));
        results.extend(changes.dropped_meshes.iter().map(|id| self.drop_mesh(*id)));
        results.extend(changes.dropped_materials.iter().map(|id| self.drop_material(*id)));
        results.into_iter().filter_map(Result::err).collect()
    }

    fn mesh(&mut self, id: MeshAsset, mesh: &umbrage::core::Mesh) -> Result<(), Error> {
        let Some(known) = self.meshes.get(&id).copied() else {
            self.meshes.insert(id, self.casters.add_mesh(mesh)?);
            return Ok(());
        };
        let bent = self.placed.iter().filter(|(_, (_, placed))| placed.mesh == id && placed.joints.is_some());
        let bent: Vec<(Entity, Placed)> = bent.map(|(entity, (_, placed))| (*entity, placed.clone())).collect();
        // What bends is made of the mesh that it was placed with.
        bent.iter().try_for_each(|(entity, _)| self.remove(*entity))?;
        self.casters.replace_mesh(known, mesh)?;
        bent.into_iter().try_for_each(|(entity, placed)| self.place(entity, placed))
    }

    fn material(&mut self, id: MaterialAsset, Cutout { material, texture }: &Cutout) -> Result<(), Error> {
        let known = self.materials.get(&id).copied();
        let old = known.and_then(|(_, picture)| picture);
        let picture = match (old, texture) {
            (Some(old), Some(texture)) => {
                self.casters.replace_texture(old, texture)?;
                Some(old)
            }
            (None, Some(texture)) => Some(self.casters.add_texture(texture)?),
            (_, None) => None,
        };
        let number = match known {
            Some((known, _)) => {
                self.casters.replace_material(known, material, picture)?;
                known
            }
            None => self.casters.add_material(material, picture)?,
        };
        self.materials.insert(id, (number, picture));
        match old.filter(|_| picture.is_none()) {
            Some(unused) => self.casters.remove_texture(unused),
            None => Ok(()),
        }
    }

    fn place(&mut self, entity: Entity, placed: Placed) -> Result<(), Error> {
        let material = placed.material.and_then(|id| self.materials.get(&id)).map_or(self.plain, |known| known.0);
        let Some(mesh) = self.meshes.get(&placed.mesh).copied() else { return Ok(()) };
        let Placed { world_from_mesh, casts, receives, .. } = placed;
        let same = |(_, old): &&(InstanceId, Placed)| {
            old.mesh == placed.mesh && old.joints.is_none() && placed.joints.is_none()
        };
        if let Some((instance, _)) = self.placed.get(&entity).filter(same) {
            let instance = *instance;
            self.casters.set_material(instance, material)?;
            self.casters.set_flags(instance, casts, receives)?;
            self.casters.move_instance(instance, &world_from_mesh)?;
            self.placed.insert(entity, (instance, placed));
            return Ok(());
        }
        self.remove(entity)?;
        let joints = placed.joints.clone();
        let new = Placement { casts, receives, joints, ..Placement::new(mesh, material, world_from_mesh) };
        let instance = self.casters.insert(&new)?;
        self.placed.insert(entity, (instance, placed));
        Ok(())
    }

    fn remove(&mut self, entity: Entity) -> Result<(), Error> {
        self.placed.remove(&entity).map_or(Ok(()), |(instance, _)| self.casters.remove(instance))
    }

    fn move_to(&mut self, entity: Entity, to: DAffine3) -> Result<(), Error> {
        let Some((instance, placed)) = self.placed.get_mut(&entity) else { return Ok(()) };
        self.casters.move_instance(*instance, &to)?;
        placed.world_from_mesh = to;
        Ok(())
    }

    fn bend(&mut self, entity: Entity, joints: Vec<DAffine3>) -> Result<(), Error> {
        let Some((instance, placed)) = self.placed.get_mut(&entity) else { return Ok(()) };
        if placed.joints.is_none() {
            // Its bind poses were loaded after it was placed.
            let placed = Placed { joints: Some(joints), ..placed.clone() };
            return self.place(entity, placed);
        }
        self.casters.set_pose(*instance, &joints)?;
        placed.joints = Some(joints);
        Ok(())
    }

    fn drop_mesh(&mut self, id: MeshAsset) -> Result<(), Error> {
        self.meshes.remove(&id).map_or(Ok(()), |mesh| self.casters.remove_mesh(mesh))
    }

    fn drop_material(&mut self, id: MaterialAsset) -> Result<(), Error> {
        let Some((material, picture)) = self.materials.remove(&id) else { return Ok(()) };
        self.casters.remove_material(material)?;
        picture.map_or(Ok(()), |picture| self.casters.remove_texture(picture))
    }

    /// Has the GPU know, before techniques are prepared.
    ///
    /// # Errors
    /// As [`Casters::record`].
    pub fn record(&mut self, passes: &mut Passes<'_>) -> Result<(), Error> {
        self.casters.record(passes)
    }

    pub fn casters(&self) -> &Casters {
        &self.casters
    }
}

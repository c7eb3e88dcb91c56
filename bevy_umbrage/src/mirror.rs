//! The casters of the world on the GPU.

use crate::extract::{Changes, Cutout, MaterialAsset, MeshAsset, Placed};
use bevy::ecs::entity::EntityHashMap;
use bevy::prelude::Entity;
use std::collections::HashMap;
use umbrage::core::glam::DAffine3;
use umbrage::core::rig::{Joint, Local, Node, Skin};
use umbrage::core::{self, Instance, Material, Pose, Rig, Scene};
use umbrage::{Casters, Error, Gpu, Passes};

/// Everything that was sent, and what was made of it.
#[derive(Default)]
pub struct Mirror {
    meshes: HashMap<MeshAsset, core::Mesh>,
    materials: HashMap<MaterialAsset, Cutout>,
    placed: EntityHashMap<Placed>,
    numbers: EntityHashMap<usize>,
    casters: Option<Casters>,
}

impl Mirror {
    /// Brings the casters up to date.
    ///
    /// # Errors
    /// As [`Casters::new`].
    pub fn follow(&mut self, gpu: &Gpu, changes: Changes) -> Result<(), Error> {
        let Changes { removed, meshes, materials, placed, moved, bent, dropped_meshes, dropped_materials, .. } =
            changes;
        let mut is_new = !(removed.is_empty() && meshes.is_empty() && materials.is_empty() && placed.is_empty());
        removed.iter().for_each(|entity| drop(self.placed.remove(entity)));
        self.meshes.extend(meshes);
        self.materials.extend(materials);
        self.placed.extend(placed);
        for (entity, place) in moved {
            self.move_to(gpu, entity, place);
        }
        for (entity, joints) in bent {
            is_new |= self.bend(entity, joints);
        }
        dropped_meshes.iter().for_each(|id| drop(self.meshes.remove(id)));
        dropped_materials.iter().for_each(|id| drop(self.materials.remove(id)));
        if is_new {
            self.make(gpu)?;
        }
        Ok(())
    }

    fn move_to(&mut self, gpu: &Gpu, entity: Entity, place: DAffine3) {
        let Some(placed) = self.placed.get_mut(&entity) else { return };
        placed.world_from_mesh = place;
        if let (Some(casters), Some(number)) = (&mut self.casters, self.numbers.get(&entity)) {
            casters.move_instance(gpu, *number, &place);
        }
    }

    /// True where it had no joints before.
    fn bend(&mut self, entity: Entity, joints: Vec<DAffine3>) -> bool {
        let Some(placed) = self.placed.get_mut(&entity) else { return false };
        if let (Some(casters), Some(number)) = (&mut self.casters, self.numbers.get(&entity)) {
            casters.set_pose(*number, &joints);
        }
        placed.joints.replace(joints).is_none()
    }

    fn make(&mut self, gpu: &Gpu) -> Result<(), Error> {
        self.casters = None;
        let mut scene = Scene { materials: vec![Material::default()], ..Default::default() };
        let mut materials = HashMap::new();
        for (id, Cutout { material, texture }) in &self.materials {
            materials.insert(*id, scene.materials.len());
            let number = scene.textures.len();
            scene.textures.extend(texture.clone());
            scene.materials.push(Material { texture: texture.as_ref().map(|_| number), ..material.clone() });
        }
        let mut meshes = HashMap::new();
        for (id, mesh) in &self.meshes {
            meshes.insert(*id, scene.meshes.len());
            scene.meshes.push(mesh.clone());
        }
        self.numbers.clear();
        for (entity, placed) in &self.placed {
            let Some(&mesh) = meshes.get(&placed.mesh) else { continue };
            let material = placed.material.and_then(|id| materials.get(&id).copied()).unwrap_or(0);
            let pose = placed.joints.as_ref().map(|joints| {
                scene.rigs.push(still(joints));
                Pose { rig: scene.rigs.len() - 1, skin: 0, moment: None }
            });
            let model = scene.instances.len();
            let Placed { world_from_mesh, casts, receives, .. } = *placed;
            scene.instances.push(Instance { mesh, material, model, world_from_mesh, pose, casts, receives });
            self.numbers.insert(*entity, model);
        }
        self.casters = Some(Casters::new(gpu, &scene)?);
        Ok(())
    }

    /// What moves vertices, before techniques are recorded.
    pub fn record(&mut self, passes: &mut Passes<'_>) {
        if let Some(casters) = &mut self.casters {
            casters.record_poses(passes);
        }
    }

    /// `None` in a world without any, and where they could not be made.
    pub fn casters(&self) -> Option<&Casters> {
        self.casters.as_ref()
    }
}

/// A rig whose joints stand as they do.
fn still(joints: &[DAffine3]) -> Rig {
    let node = |joint: &DAffine3| Node { parent: None, local: Local::Matrix(*joint) };
    let joint = |node| Joint { node, node_from_mesh: DAffine3::IDENTITY };
    Rig {
        nodes: joints.iter().map(node).collect(),
        skins: vec![Skin { joints: (0..joints.len()).map(joint).collect() }],
        animations: Vec::new(),
    }
}

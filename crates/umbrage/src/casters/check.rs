//! What a scene has to be for the GPU to hold it.

use super::geometry;
use crate::error::Error;
use umbrage_core::Scene;
use umbrage_core::glam::DAffine3;

/// Indices that lead somewhere, and transforms that lead somewhere as well.
pub(super) fn check(scene: &Scene) -> Result<(), Error> {
    for (i, instance) in scene.instances.iter().enumerate() {
        if instance.mesh >= scene.meshes.len() || instance.material >= scene.materials.len() {
            return Err(Error::Scene(format!("instance {i} refers to a mesh or material that is not in the scene")));
        }
        transform(&instance.world_from_mesh).map_err(|e| Error::Scene(format!("instance {i}: {e}")))?;
        let held_by = scene.meshes[instance.mesh].weights.influences().iter().map(|i| i.joint as usize + 1).max();
        let joints = scene.joints(instance);
        if instance.pose.is_some() && joints.is_none_or(|j| j.len() < held_by.unwrap_or(0)) {
            return Err(Error::Scene(format!("instance {i} has a pose without the joints that its mesh needs")));
        }
    }
    for material in &scene.materials {
        if material.texture.is_some_and(|t| t >= scene.textures.len()) {
            return Err(Error::Scene("a material refers to a texture that is not in the scene".into()));
        }
    }
    scene.meshes.iter().try_for_each(geometry::check)
}

/// A finite one.
pub(super) fn transform(world_from_mesh: &DAffine3) -> Result<(), Error> {
    match world_from_mesh.is_finite() {
        true => Ok(()),
        false => Err(Error::Scene("a transform that is not finite; keep the last one, or remove the instance".into())),
    }
}

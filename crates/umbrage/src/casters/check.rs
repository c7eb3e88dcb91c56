//! What a scene has to be for the GPU to hold it.

use super::placed::Instance;
use crate::{error::Error, gpu::Gpu};
use umbrage_core::Scene;

/// Indices that lead somewhere and buffers that fit.
pub(super) fn check(gpu: &Gpu, scene: &Scene) -> Result<(), Error> {
    gpu.check_loss()?;
    for (i, instance) in scene.instances.iter().enumerate() {
        if instance.mesh >= scene.meshes.len() || instance.material >= scene.materials.len() {
            return Err(Error::Scene(format!("instance {i} refers to a mesh or material that is not in the scene")));
        }
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
    for mesh in &scene.meshes {
        if mesh.indices.iter().any(|&i| i as usize >= mesh.positions.len()) {
            return Err(Error::Scene(format!("mesh `{}` has an index beyond its vertices", mesh.name)));
        }
    }
    let limits = gpu.device.limits();
    let posed = scene.instances.iter().filter(|i| i.pose.is_some()).map(|i| &scene.meshes[i.mesh]);
    let vertices: u64 = scene.meshes.iter().chain(posed).map(|m| m.positions.len() as u64).sum();
    let indices: u64 = scene.meshes.iter().map(|m| m.indices.len() as u64).sum();
    let instances = scene.instances.len() as u64;
    for (what, size, limit) in [
        ("a vertex buffer", vertices * 20, limits.max_buffer_size),
        ("an index buffer", indices * 4, limits.max_buffer_size),
        ("an instance buffer", instances * size_of::<Instance>() as u64, limits.max_storage_buffer_binding_size),
    ] {
        if size > limit {
            return Err(Error::Size { what: what.into(), size, limit });
        }
    }
    Ok(())
}

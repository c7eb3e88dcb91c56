//! What surfaces reflect where rays meet them.

use glam::{Vec2, Vec3};
use umbrage_core::{Material, Mesh, Scene};

/// Linear RGB reflectance of an instance at texture coordinates between a triangle's corners.
pub(crate) fn albedo(scene: &Scene, instance: usize, corners: [u32; 3], shares: [f64; 3]) -> Vec3 {
    let plain = Material::default();
    let material = scene.materials.get(scene.instances[instance].material).unwrap_or(&plain);
    let color = material.base_color.truncate();
    let Some(texture) = material.texture.and_then(|t| scene.textures.get(t)) else { return color };
    color * texture.color(uv(&scene.meshes[instance], corners, shares))
}

fn uv(mesh: &Mesh, corners: [u32; 3], shares: [f64; 3]) -> Vec2 {
    let at = |i: u32| mesh.uvs.get(i as usize).copied().unwrap_or(Vec2::ZERO);
    corners.iter().zip(shares).map(|(&i, share)| at(i) * share as f32).sum()
}

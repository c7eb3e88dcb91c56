//! What both examples bake: a round body with folds and two ears on a floor, 35,000 vertices of
//! about the shape of the Stanford bunny, which is not in this repository.

use glam::{DAffine3, DVec3, Vec3};
use umbrage_core::{Material, Mesh, Scene, primitive};

/// Body and floor; the body is the first instance.
pub fn scene() -> Scene {
    let mut scene = Scene::default();
    let wide = DAffine3::from_scale(DVec3::new(6.0, 1.0, 6.0));
    for (mesh, place) in [(body(), DAffine3::from_translation(DVec3::Y * 0.95)), (primitive::plane(), wide)] {
        let base_color = Vec3::new(0.7, 0.6, 0.5).extend(1.0);
        let mesh = scene.add_mesh(mesh);
        let material = scene.add_material(Material { base_color, ..Material::default() });
        scene.place(mesh, material, place);
    }
    scene
}

/// 265 × 132 vertices.
fn body() -> Mesh {
    let mut mesh = primitive::sphere(264, 131);
    for position in &mut mesh.positions {
        let d = position.normalize();
        let ear = |axis: Vec3| (60.0 * (d.dot(axis.normalize()) - 1.0)).exp();
        let ears = ear(Vec3::new(0.35, 0.9, 0.2)) + ear(Vec3::new(-0.35, 0.9, 0.2));
        let folds = 0.06 * (7.0 * d.x + 3.0 * d.y).sin() * (5.0 * d.z).cos() + 0.015 * (31.0 * d.y).sin();
        *position = d * (0.8 + 0.7 * ears + folds);
    }
    mesh.normals.clear();
    mesh.generate_normals_if_absent();
    mesh
}

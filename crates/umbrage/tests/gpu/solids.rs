//! Solid casters are drawn without their back faces, and nobody may see that.

use crate::common::{against_truth, gpu};
use umbrage::core::glam::{DAffine3, DMat3, DVec3};
use umbrage::core::{Camera, Light, LightShape, Material, Scene, primitive};

/// Boxes as they are, mirrored, squeezed flat, sheared, open at the bottom and wound inwards; one
/// of them is around the second light, and one so near to it that its front is within the near
/// plane.
fn boxes(lamp: DVec3) -> Scene {
    let mut scene = Scene::default();
    let [floor, cube] = [primitive::plane(), primitive::cube()].map(|mesh| scene.add_mesh(mesh));
    let mut open = primitive::cube();
    open.indices.truncate(30);
    let mut inwards = primitive::cube();
    inwards.indices.reverse();
    let [open, inwards] = [open, inwards].map(|mesh| scene.add_mesh(mesh));
    let material = scene.add_material(Material::default());
    scene.place(floor, material, DAffine3::from_scale(DVec3::splat(30.0)));
    let at = |x: f64, z: f64, matrix3: DMat3| DAffine3 { matrix3, translation: DVec3::new(x, 1.0, z) };
    let scaled = |x: f64, y: f64, z: f64| DMat3::from_diagonal(DVec3::new(x, y, z));
    scene.place(cube, material, at(-4.0, -3.0, DMat3::from_rotation_y(0.4)));
    scene.place(cube, material, at(0.0, -3.0, scaled(-1.0, 1.2, 0.8)));
    scene.place(cube, material, at(4.0, -3.0, scaled(1.0, 0.0, 1.0)));
    scene.place(cube, material, at(-4.0, 2.0, DMat3::from_cols(DVec3::X, DVec3::new(0.9, 0.6, 0.0), DVec3::Z)));
    scene.place(open, material, at(4.0, 2.0, DMat3::from_rotation_z(0.5)));
    scene.place(inwards, material, at(2.0, 5.0, DMat3::IDENTITY));
    // A box around the lamp keeps all but what it lets out: nothing. One beside it is nearer than
    // its near plane.
    let beside = lamp + DVec3::new(0.5 + 1e-5, 0.0, 0.0);
    scene.place(cube, material, DAffine3 { matrix3: scaled(1.0, 0.3, 0.3), translation: beside });
    scene.camera = Camera { eye: DVec3::new(0.0, 9.0, 12.0), near: 0.1, ..Camera::default() };
    let direction = DVec3::new(0.4, -1.0, 0.3).normalize();
    scene.lights.push(Light::new(LightShape::Directional { direction, angle_deg: 0.0 }));
    scene.lights.push(Light::new(LightShape::Point { position: lamp }));
    scene
}

#[test]
fn boxes_of_all_kinds_shadow_as_they_should() {
    let gpu = gpu();
    let lamp = DVec3::new(-0.7, 5.0, 0.6);
    let mut enclosed = boxes(lamp);
    let cube = enclosed.add_mesh(primitive::cube());
    enclosed.place(cube, 0, DAffine3 { matrix3: DMat3::IDENTITY * 0.5, translation: lamp });
    for (scene, light, what) in
        [(boxes(lamp), 0, "the sun"), (boxes(lamp), 1, "a lamp"), (enclosed, 1, "a lamp in a box that is shut")]
    {
        for set in ["size=1024", "size=1024,focus=light", "size=1024,depth=linear"] {
            let scores = against_truth(&gpu, &scene, light, "shadow-map", set, (256, 192), 1);
            let interior = scores.interior_pct.unwrap_or(0.0);
            assert!(interior > 99.9 && scores.mae < 0.02, "{what}, {set}: interior {interior} %, mae {}", scores.mae);
        }
    }
}

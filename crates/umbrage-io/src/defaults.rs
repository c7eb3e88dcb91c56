//! A camera and a light for scenes that have none, made from the bounds.

use glam::{DVec3, Vec3};
use umbrage_core::{Camera, Light, LightShape, Scene};

/// The scene is seen from its front, its right and above.
const TO_CAMERA: DVec3 = DVec3::new(0.55, 0.45, 0.8);
/// The light comes from above and from the left of the camera, so that shadows fall to the right,
/// in sight.
const TO_LIGHT: DVec3 = DVec3::new(-0.5, 1.0, 0.55);
/// Linear RGB: what lies in shadow is still to be made out.
const AMBIENT: Vec3 = Vec3::splat(0.06);
/// Degrees.
const FOV_Y: f64 = 40.0;

/// Gives the scene a three-quarter view in which all of it is seen in any picture at least as wide
/// as high.
pub(crate) fn add_camera(scene: &mut Scene, notes: &mut Vec<String>) {
    let bounds = scene.bounds();
    let radius = radius_of(scene);
    let distance = 1.05 * radius / (FOV_Y.to_radians() * 0.5).sin();
    scene.camera = Camera {
        eye: bounds.center() + TO_CAMERA.normalize() * distance,
        target: bounds.center(),
        up: DVec3::Y,
        fov_y_deg: FOV_Y,
        near: distance * 0.01,
        ..Camera::default()
    };
    notes.push("no camera in the file: made a three-quarter view from the bounds".to_owned());
}

/// Adds a soft key light: a sphere outside the bounds whose penumbras are about a tenth as wide as
/// their distance.
pub(crate) fn add_light(scene: &mut Scene, notes: &mut Vec<String>) {
    let distance = 3.0 * radius_of(scene);
    let (position, radius) = (scene.bounds().center() + TO_LIGHT.normalize() * distance, distance * 0.05);
    scene.lights.push(Light::new(LightShape::Sphere { position, radius }));
    if scene.ambient == Vec3::ZERO {
        scene.ambient = AMBIENT;
    }
    notes.push(format!(
        "no light in the file: made a soft key light with a little ambient (sphere, radius {radius:.3} m, at {:.3}, {:.3}, {:.3})",
        position.x, position.y, position.z
    ));
}

/// The radius of the scene, or something to work with where all of it is one point.
fn radius_of(scene: &Scene) -> f64 {
    let bounds = scene.bounds();
    bounds.radius().max(1e-6 * bounds.largest_coordinate()).max(1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;
    use umbrage_core::{Frustum, Material, primitive};

    #[test]
    fn the_whole_scene_is_in_view_and_the_light_outside() {
        for size in [1e-3, 1.0, 1e4] {
            let mut scene = Scene::default();
            let (mesh, material) = (scene.add_mesh(primitive::cube()), scene.add_material(Material::default()));
            let stretch = DVec3::new(3.0, 1.0, 0.2) * size;
            scene.place(mesh, material, DAffine3::from_scale(stretch) * DAffine3::from_translation(DVec3::ONE));
            let mut notes = Vec::new();
            add_camera(&mut scene, &mut notes);
            add_light(&mut scene, &mut notes);
            let frustum = Frustum::of(&scene.camera.view(300, 300).clip_from_world());
            assert!(frustum.holds(&scene.bounds()), "size {size}: {:?}", scene.camera);
            let light = &scene.lights[0].shape;
            let away = light.center().truncate().distance(scene.bounds().center());
            assert!(away - light.radius() > scene.bounds().radius(), "size {size}: {light:?}");
            assert_eq!(notes.len(), 2);
        }
    }
}

//! What single precision cannot tell apart in a scene.
//!
//! GPUs get positions in single precision, relative to the middle of the scene. A scene may be too
//! large for what is looked at, and a light too far away; then shadows are wrong, and no technique
//! can help it.

use crate::Scene;

/// Half of the distance between neighbouring numbers, relative to a number.
const ROUNDING: f64 = 1.0 / (1u64 << 24) as f64;

/// The share of the distance from the camera to what it looks at by which positions may be rounded
/// until that shows: a pixel, about.
const SEEN: f64 = 1e-3;

/// Beyond it products of four coordinates leave the range of single precision, metres.
const FARTHEST: f64 = 1e10;

/// What is too large or too far away, with what to do about it; empty for almost every scene.
#[must_use]
pub fn notes(scene: &Scene) -> Vec<String> {
    let bounds = scene.bounds();
    if bounds.is_empty() {
        return Vec::new();
    }
    let reach = (bounds.size() * 0.5).max_element();
    let seen = scene.camera.eye.distance(scene.camera.target);
    let rounded = |reach: f64| Some(reach * ROUNDING).filter(|rounding| *rounding > SEEN * seen);
    let mut notes = Vec::new();
    if reach > FARTHEST {
        notes.push(format!(
            "the scene reaches {reach:.1e} m from its middle, and beyond {FARTHEST:.0e} m techniques do not hold what they promise; \
             scale it down"
        ));
    }
    if let Some(rounding) = rounded(reach) {
        notes.push(format!(
            "the scene reaches {reach:.1e} m from its middle, so positions are rounded by {rounding:.1e} m, and the camera looks at \
             what is {seen:.1e} m away; leave out what is so far away, or bring it closer"
        ));
    }
    for (number, light) in scene.lights.iter().enumerate() {
        let place = light.shape.center();
        if place.w == 0.0 {
            continue;
        }
        let place = place.truncate();
        let away = place.distance(place.clamp(bounds.min, bounds.max));
        if let Some(rounding) = rounded(away) {
            notes.push(format!(
                "light {number} is {away:.1e} m away from the scene, so maps round its distance by {rounding:.1e} m, and the camera \
                 looks at what is {seen:.1e} m away; bring it closer, or make it directional"
            ));
        }
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, Light, LightShape, Material, primitive};
    use glam::{DAffine3, DVec3};

    fn scene(far: f64, lamp: f64) -> Scene {
        let shape = LightShape::Point { position: DVec3::new(0.0, lamp, 0.0) };
        let camera = Camera { eye: DVec3::new(0.0, 3.0, 7.0), target: DVec3::ZERO, ..Camera::default() };
        let mut scene = Scene { lights: vec![Light::new(shape)], camera, ..Scene::default() };
        let (cube, material) = (scene.add_mesh(primitive::cube()), scene.add_material(Material::default()));
        for x in [0.0, far] {
            scene.place(cube, material, DAffine3::from_translation(DVec3::X * x));
        }
        scene
    }

    #[test]
    fn what_is_too_far_away_is_named() {
        assert!(notes(&scene(10.0, 5.0)).is_empty());
        assert!(notes(&scene(100_000.0, 5000.0)).is_empty());
        let far = notes(&scene(1e6, 5.0));
        assert!(far.len() == 1 && far[0].contains("leave out"), "{far:?}");
        let lamp = notes(&scene(10.0, 5e6));
        assert!(lamp.len() == 1 && lamp[0].contains("light 0"), "{lamp:?}");
        let huge = notes(&scene(1e11, 5.0));
        assert!(huge.len() == 2 && huge[0].contains("scale it down"), "{huge:?}");
    }

    #[test]
    fn an_empty_scene_has_no_notes() {
        assert!(notes(&Scene::default()).is_empty());
    }
}

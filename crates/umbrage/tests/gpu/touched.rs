//! Lights that receivers and casters cut or touch.

use crate::common::{against_truth, gpu};
use umbrage::core::glam::{DAffine3, DQuat, DVec3};
use umbrage::core::{Camera, Light, LightShape, Material, Scene, primitive};

/// A floor, a wall at its end, and a pillar in front of that.
fn room(shape: LightShape) -> Scene {
    let mut scene = Scene { lights: vec![Light::new(shape)], ..Scene::default() };
    let (floor, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let material = scene.add_material(Material::default());
    scene.place(floor, material, DAffine3::from_scale(DVec3::splat(12.0)));
    for (size, middle) in [([12.0, 4.0, 0.2], [0.0, 2.0, -3.1]), ([0.4, 1.2, 0.4], [0.0, 0.6, 0.3])] {
        let place = DAffine3::from_scale_rotation_translation(size.into(), DQuat::IDENTITY, middle.into());
        scene.place(cube, material, place);
    }
    let (eye, target) = (DVec3::new(0.0, 2.2, 6.0), DVec3::Y);
    scene.camera = Camera { eye, target, fov_y_deg: 55.0, ..Camera::default() };
    scene
}

fn rect(position: DVec3, direction: DVec3, size: [f64; 2]) -> LightShape {
    let direction = direction.normalize();
    let up = (DVec3::Y - direction * direction.y).normalize();
    LightShape::Rect { position, direction, up, size: size.into(), texture: None }
}

/// Lights of every kind, with what they touch.
fn lights() -> Vec<(&'static str, LightShape)> {
    let low = DVec3::new(0.1, 0.1, -1.0);
    let slanting = DVec3::new(0.0, 0.2, -1.0);
    vec![
        ("the floor", LightShape::Sphere { position: low, radius: 0.3 }),
        ("the floor with its middle", LightShape::Sphere { position: DVec3::new(0.5, 0.0, -1.0), radius: 0.3 }),
        (
            "the floor",
            LightShape::Ellipsoid { position: low, radii: [0.3, 0.5, 0.2].into(), rotation: Default::default() },
        ),
        ("the floor", LightShape::Disc { position: low, direction: slanting.normalize(), radius: 0.4 }),
        ("the floor", rect(low, slanting, [0.8, 0.6])),
        ("the floor", LightShape::Line { from: DVec3::new(0.5, -0.3, -1.0), to: DVec3::new(0.8, 0.7, -1.1) }),
        ("the pillar from within", rect(DVec3::new(0.1, 0.6, 0.3), DVec3::new(0.3, 0.0, 1.0), [1.4, 0.6])),
        ("an edge of the pillar", LightShape::Sphere { position: DVec3::new(0.0, 1.1, 0.1), radius: 0.3 }),
        ("the wall, nearly", rect(DVec3::new(0.0, 1.5, -2.999), DVec3::Z, [1.2, 0.8])),
    ]
}

#[test]
fn what_a_light_touches_hides_what_is_behind_it() {
    let gpu = gpu();
    for (what, shape) in lights() {
        let scene = room(shape);
        let kind = scene.lights[0].shape.kind().name();
        let mae = |id| against_truth(&gpu, &scene, 0, id, "", (64, 48), 64).mae;
        let (hard, wedges, mask) = (mae("volume"), mae("wedges"), mae("light-mask"));
        println!("{kind} touches {what}: hard {hard:.4}, wedges {wedges:.4}, light-mask {mask:.4}");
        assert!(hard > 0.025, "{kind} touches {what}: the hard shadow is right within {hard:.4}");
        assert!(mask < 0.02, "{kind} touches {what}: light-mask errs by {mask:.4}");
        // Where the pillar's shadow is, too, the floor's share counts twice.
        assert!(wedges < 0.025, "{kind} touches {what}: wedges err by {wedges:.4}");
    }
}

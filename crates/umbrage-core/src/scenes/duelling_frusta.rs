//! The camera looks towards the light.

use super::{DETAIL, SceneEntry, kit::*};
use crate::{Camera, LightShape, Scene, primitive};
use glam::{DVec3, Vec3};

pub const ENTRY: SceneEntry = SceneEntry {
    id: "duelling-frusta",
    title: "An avenue against the sun",
    about: "The view runs against the light, the case that perspective warping of shadow maps cannot help: near \
            receivers are far from the light's near end. Detail scales the number of pillars. Lights: 0 a low sun \
            without its angle, 1 the sun with 0.53 degrees.",
    build,
};

fn build(detail: f32) -> Scene {
    let pairs = Detail::within(detail, DETAIL).count(16).max(1);
    let mut scene = Scene {
        name: ENTRY.title.into(),
        camera: Camera {
            eye: DVec3::new(0.5, 2.1, 10.5),
            target: DVec3::new(-0.25, 1.55, 0.0),
            fov_y_deg: 55.0,
            ..Camera::default()
        },
        ambient: Vec3::new(0.16, 0.15, 0.2),
        ..Scene::default()
    };
    let plane = scene.add_mesh(primitive::plane());
    let cube = scene.add_mesh(primitive::cube());
    let sand = scene.add_material(matte(0.74, 0.62, 0.46));
    let paving = scene.add_material(matte(0.6, 0.56, 0.52));
    let stone = scene.add_material(matte(0.6, 0.5, 0.44));
    let rust = scene.add_material(matte(0.62, 0.27, 0.14));
    scene.place(plane, sand, sized(DVec3::new(0.0, 0.0, -30.0), DVec3::new(160.0, 1.0, 160.0), 0.0));
    scene.place(cube, paving, standing(DVec3::new(0.0, 0.0, -30.0), DVec3::new(4.0, 0.04, 90.0), 0.0));

    let mut rng = Rng::new(7);
    for i in 0..pairs {
        let z = 5.0 - 4.5 * f64::from(i);
        for x in [-3.6, 3.6] {
            let (height, turn_deg) = (rng.range(2.6, 4.2), rng.range(-6.0, 6.0));
            let foot = DVec3::new(x, 0.0, z);
            scene.place(cube, stone, standing(foot, DVec3::new(1.0, 0.3, 1.0), turn_deg));
            scene.place(cube, stone, standing(foot + DVec3::Y * 0.3, DVec3::new(0.6, height, 0.6), turn_deg));
            scene.place(cube, rust, standing(foot + DVec3::Y * (height + 0.3), DVec3::new(0.85, 0.16, 0.85), turn_deg));
        }
    }
    let direction = sunlight(163.0, 21.0);
    scene.lights = [0.0, SUN_ANGLE_DEG]
        .map(|angle_deg| light(LightShape::Directional { direction, angle_deg }, [1.0, 0.82, 0.6], 0.6))
        .to_vec();
    scene
}

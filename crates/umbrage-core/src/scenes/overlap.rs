//! Casters above each other.

use super::{DETAIL, SceneEntry, kit::*};
use crate::{Camera, LightShape, Scene, primitive};
use glam::{DVec3, Vec3};

pub const ENTRY: SceneEntry = SceneEntry {
    id: "overlap",
    title: "Plates above each other",
    about: "Penumbras of two casters on the same place: what adds up their coverage, or knows only one of them, is \
            wrong there. On the left two plates, on the right a ring around a sphere. Lights: 0 point, 1 sphere at the same place.",
    build,
};

fn build(detail: f32) -> Scene {
    let detail = Detail::within(detail, DETAIL);
    let mut scene = Scene {
        name: ENTRY.title.into(),
        camera: Camera {
            eye: DVec3::new(-2.2, 4.6, 6.0),
            target: DVec3::new(-0.05, 0.65, -0.1),
            fov_y_deg: 38.0,
            ..Camera::default()
        },
        ambient: Vec3::new(0.08, 0.09, 0.12),
        ..Scene::default()
    };
    let (columns, rows) = (detail.segments(64, 12), detail.segments(32, 6));
    let plane = scene.add_mesh(primitive::plane());
    let cube = scene.add_mesh(primitive::cube());
    let rod = scene.add_mesh(primitive::cylinder(detail.segments(24, 6), 1));
    let sphere = scene.add_mesh(primitive::sphere(columns, rows));
    let ring = scene.add_mesh(primitive::torus(1.0, 0.09, columns, rows));
    let floor = scene.add_material(matte(0.76, 0.74, 0.7));
    let orange = scene.add_material(matte(0.85, 0.42, 0.15));
    let blue = scene.add_material(matte(0.16, 0.36, 0.62));
    let steel = scene.add_material(glossy(0.4, 0.42, 0.46));
    scene.place(plane, floor, sized(DVec3::ZERO, DVec3::new(12.0, 1.0, 12.0), 0.0));

    // Two plates on a rod. From the light their edges nearly coincide, so that most of a penumbra
    // is that of both.
    let foot = DVec3::new(-1.38, 0.0, -0.62);
    scene.place(rod, steel, standing(foot, DVec3::new(0.025, 1.95, 0.025), 0.0));
    scene.place(cube, orange, sized(DVec3::new(-1.2, 0.95, -0.3), DVec3::new(1.5, 0.05, 1.5), 0.0));
    scene.place(cube, blue, sized(DVec3::new(-0.82, 1.75, -0.06), DVec3::new(1.2, 0.05, 1.2), 12.0));

    // A ring that lies tilted around a sphere on a rod.
    let ball = DVec3::new(1.35, 1.15, 0.15);
    scene.place(rod, steel, standing(DVec3::new(ball.x, 0.0, ball.z), DVec3::new(0.025, 0.9, 0.025), 0.0));
    scene.place(sphere, blue, sized(ball, DVec3::splat(0.4), 0.0));
    let tilt = glam::DAffine3::from_rotation_z(0.35) * glam::DAffine3::from_scale(DVec3::splat(0.75));
    scene.place(ring, orange, glam::DAffine3::from_translation(ball) * tilt);

    let position = DVec3::new(0.7, 4.9, 0.9);
    let warm = [1.0, 0.95, 0.88];
    scene.lights = vec![
        light(LightShape::Point { position }, warm, 0.45),
        light(LightShape::Sphere { position, radius: 0.55 }, warm, 0.45),
    ];
    scene
}

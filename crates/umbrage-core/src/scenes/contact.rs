//! Thin things that stand on the floor.

use super::{DETAIL, SceneEntry, kit::*, shapes};
use crate::{Camera, LightShape, Scene, primitive};
use glam::{DVec2, DVec3, Vec3};

pub const ENTRY: SceneEntry = SceneEntry {
    id: "contact",
    title: "An obelisk on the floor",
    about: "Where caster and receiver meet the penumbra starts at nothing and grows along the shadow: a fixed blur and \
            a bias show at once. Lights: 0 point, 1 sphere at the same place, both low.",
    build,
};

fn build(detail: f32) -> Scene {
    let detail = Detail::within(detail, DETAIL);
    let mut scene = Scene {
        name: ENTRY.title.into(),
        camera: Camera {
            eye: DVec3::new(-0.7, 3.3, 6.3),
            target: DVec3::new(0.55, 0.75, -0.2),
            fov_y_deg: 40.0,
            ..Camera::default()
        },
        ambient: Vec3::new(0.07, 0.08, 0.12),
        ..Scene::default()
    };
    let plane = scene.add_mesh(primitive::plane());
    let cube = scene.add_mesh(primitive::cube());
    let sphere = scene.add_mesh(primitive::sphere(detail.segments(48, 8), detail.segments(24, 4)));
    let rod = scene.add_mesh(primitive::cylinder(detail.segments(24, 6), 1));
    let obelisk = scene.add_mesh(obelisk());
    let floor = scene.add_material(matte(0.74, 0.7, 0.64));
    let stone = scene.add_material(glossy(0.62, 0.3, 0.22));
    let steel = scene.add_material(glossy(0.42, 0.46, 0.52));
    let white = scene.add_material(matte(0.82, 0.8, 0.76));
    scene.place(plane, floor, sized(DVec3::ZERO, DVec3::new(18.0, 1.0, 18.0), 0.0));
    scene.place(obelisk, stone, sized(DVec3::new(-1.3, 0.0, -0.2), DVec3::ONE, 22.0));
    scene.place(rod, steel, standing(DVec3::new(-0.35, 0.0, 1.35), DVec3::new(0.018, 1.3, 0.018), 0.0));
    scene.place(cube, white, standing(DVec3::new(0.3, 0.0, -1.3), DVec3::new(1.0, 1.15, 0.012), 64.0));
    scene.place(sphere, steel, sized(DVec3::new(0.95, 0.36, 0.55), DVec3::splat(0.36), 0.0));
    let position = DVec3::new(-6.2, 2.7, 1.3);
    let warm = [1.0, 0.9, 0.76];
    scene.lights = vec![
        light(LightShape::Point { position }, warm, 0.8),
        light(LightShape::Sphere { position, radius: 0.6 }, warm, 0.8),
    ];
    scene
}

/// 3 m tall and 0.34 m wide at its foot, which stands right on the floor.
fn obelisk() -> crate::Mesh {
    let half_diagonal = [(0.0, 3.0), (0.15, 2.72), (0.24, 0.0), (0.0, 0.0)].map(|(r, h)| DVec2::new(r, h));
    shapes::lathe("obelisk", 4, &half_diagonal)
}

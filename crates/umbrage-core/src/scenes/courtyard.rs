//! Coloured walls under a soft sky.

use super::{DETAIL, SceneEntry, kit::*, shapes};
use crate::{Camera, Environment, LightShape, Mesh, Scene, primitive};
use glam::{DVec2, DVec3, Vec3};

pub const ENTRY: SceneEntry = SceneEntry {
    id: "courtyard",
    title: "A courtyard with coloured walls",
    about: "A red and a blue wall colour what stands between them once light bounces. Lights: 0 directional, 1 the same with \
            an angle; the sky is a soft one with a broad sun.",
    build,
};

fn build(detail: f32) -> Scene {
    let detail = Detail::within(detail, DETAIL);
    let mut scene = Scene {
        name: ENTRY.title.into(),
        camera: Camera {
            eye: DVec3::new(0.4, 2.5, 7.2),
            target: DVec3::new(0.0, 1.05, -0.3),
            fov_y_deg: 40.0,
            ..Camera::default()
        },
        ambient: Vec3::new(0.07, 0.08, 0.12),
        ..Scene::default()
    };
    let plane = scene.add_mesh(primitive::plane());
    let cube = scene.add_mesh(primitive::cube());
    let sphere = scene.add_mesh(primitive::sphere(detail.segments(48, 12), detail.segments(24, 6)));
    let urn = scene.add_mesh(urn(detail));
    let floor = scene.add_material(matte(0.72, 0.68, 0.62));
    let red = scene.add_material(matte(0.78, 0.13, 0.09));
    let blue = scene.add_material(matte(0.1, 0.28, 0.75));
    let plaster = scene.add_material(matte(0.8, 0.78, 0.74));
    let stone = scene.add_material(matte(0.55, 0.52, 0.48));
    scene.place(plane, floor, sized(DVec3::ZERO, DVec3::new(16.0, 1.0, 16.0), 0.0));
    scene.place(cube, red, standing(DVec3::new(-2.6, 0.0, 0.0), DVec3::new(0.2, 2.4, 5.0), 0.0));
    scene.place(cube, blue, standing(DVec3::new(2.6, 0.0, 0.0), DVec3::new(0.2, 2.4, 5.0), 0.0));
    scene.place(cube, plaster, standing(DVec3::new(0.0, 0.0, -2.6), DVec3::new(5.4, 2.4, 0.2), 0.0));
    scene.place(cube, plaster, standing(DVec3::new(-1.15, 0.0, -0.9), DVec3::new(1.3, 0.55, 0.9), 18.0));
    scene.place(sphere, plaster, sized(DVec3::new(-1.15, 1.07, -0.9), DVec3::splat(0.52), 0.0));
    scene.place(urn, stone, sized(DVec3::new(1.2, 0.0, -0.8), DVec3::ONE, 0.0));
    scene.place(sphere, plaster, sized(DVec3::new(0.35, 0.3, 0.9), DVec3::splat(0.3), 0.0));
    let (sun, warm) = (sunlight(55.0, 48.0), [1.0, 0.94, 0.84]);
    scene.lights = vec![
        light(LightShape::Directional { direction: sun, angle_deg: 0.0 }, warm, 0.85),
        light(LightShape::Directional { direction: sun, angle_deg: 4.0 }, warm, 0.85),
    ];
    scene.environment = Some(Environment::new(soft_sky(-sun, Vec3::new(9.0, 7.6, 5.6))));
    scene
}

/// 1.5 m tall, closed.
fn urn(detail: Detail) -> Mesh {
    let profile = [
        (0.0, 1.3),
        (0.3, 1.32),
        (0.42, 1.5),
        (0.46, 1.46),
        (0.36, 1.25),
        (0.44, 1.05),
        (0.5, 0.85),
        (0.45, 0.6),
        (0.28, 0.34),
        (0.18, 0.22),
        (0.2, 0.14),
        (0.38, 0.08),
        (0.4, 0.0),
        (0.0, 0.0),
    ];
    shapes::lathe("urn", detail.segments(40, 8), &profile.map(|(r, h)| DVec2::new(r, h)))
}

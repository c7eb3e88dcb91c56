//! Every primitive once, on a plane.

use super::{DETAIL, SceneEntry, kit::*};
use crate::{Camera, LightShape, Scene, primitive};
use glam::{DVec3, Vec3};

pub const ENTRY: SceneEntry = SceneEntry {
    id: "primitives",
    title: "Primitives on a plane",
    about: "The small scene for a first look and for quick tests: about 1,300 triangles, flat and curved casters, \
            contact, and shadows that fall on other casters. Lights: 0 point, 1 sphere at the same place.",
    build,
};

fn build(detail: f32) -> Scene {
    let detail = Detail::within(detail, DETAIL);
    let mut scene = Scene {
        name: ENTRY.title.into(),
        camera: Camera {
            eye: DVec3::new(-1.2, 3.4, 6.4),
            target: DVec3::new(0.0, 0.55, -0.1),
            fov_y_deg: 36.0,
            ..Camera::default()
        },
        ambient: Vec3::new(0.09, 0.1, 0.13),
        ..Scene::default()
    };
    let columns = detail.segments(24, 6);
    let rows = detail.segments(12, 4);
    let plane = scene.add_mesh(primitive::plane());
    let cube = scene.add_mesh(primitive::cube());
    let sphere = scene.add_mesh(primitive::sphere(columns, rows));
    let cone = scene.add_mesh(primitive::cone(columns, 1));
    let cylinder = scene.add_mesh(primitive::cylinder(columns, 1));
    let torus = scene.add_mesh(primitive::torus(1.0, 0.3, columns, rows));

    let white = scene.add_material(matte(0.78, 0.76, 0.72));
    let coral = scene.add_material(glossy(0.85, 0.32, 0.22));
    let teal = scene.add_material(glossy(0.1, 0.5, 0.52));
    let gold = scene.add_material(glossy(0.9, 0.62, 0.16));
    let plum = scene.add_material(glossy(0.45, 0.2, 0.42));
    let slate = scene.add_material(matte(0.3, 0.36, 0.44));

    let on = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    scene.place(plane, white, sized(DVec3::ZERO, DVec3::new(14.0, 1.0, 14.0), 0.0));
    scene.place(cube, slate, standing(on(-1.9, -1.5), DVec3::new(0.9, 2.0, 0.9), 24.0));
    scene.place(cube, coral, standing(on(-1.3, 0.75), DVec3::new(0.7, 0.7, 0.7), -18.0));
    scene.place(cube, teal, standing(on(0.35, 1.55), DVec3::new(1.5, 0.16, 0.5), 12.0));
    scene.place(cube, gold, standing(on(2.45, 0.75), DVec3::new(0.4, 1.1, 0.4), 40.0));
    scene.place(sphere, teal, sized(DVec3::new(0.15, 0.62, -0.1), DVec3::splat(0.62), 0.0));
    scene.place(cone, gold, standing(on(-0.5, -2.3), DVec3::new(0.7, 1.6, 0.7), 0.0));
    scene.place(cylinder, plum, standing(on(1.6, -1.9), DVec3::new(0.42, 1.5, 0.42), 0.0));
    scene.place(torus, coral, sized(DVec3::new(1.45, 0.165, 0.55), DVec3::splat(0.55), 0.0));

    let position = DVec3::new(2.9, 4.6, 2.7);
    let warm = [1.0, 0.96, 0.9];
    scene.lights = vec![
        light(LightShape::Point { position }, warm, 0.45),
        light(LightShape::Sphere { position, radius: 0.5 }, warm, 0.45),
    ];
    scene
}

//! Polished things under a clear sky.

use super::{DETAIL, SceneEntry, kit::*};
use crate::environment::Daylight;
use crate::{Camera, Environment, LightShape, Material, Scene, Sky, primitive};
use glam::{DMat3, DVec3, Vec3};

pub const ENTRY: SceneEntry = SceneEntry {
    id: "plinths",
    title: "Polished stones on plinths",
    about: "A sphere, a ring and an egg with highlights, in the open: a clear sky with a small, strong sun. Lights: 0 \
            directional, 1 the same with the sun's angle; the sky is Preetham's.",
    build,
};

/// How hazy the air is.
const TURBIDITY: f64 = 2.6;

fn build(detail: f32) -> Scene {
    let detail = Detail::within(detail, DETAIL);
    let mut scene = Scene {
        name: ENTRY.title.into(),
        camera: Camera {
            eye: DVec3::new(-2.4, 2.3, 6.6),
            target: DVec3::new(0.1, 0.85, 0.0),
            fov_y_deg: 36.0,
            ..Camera::default()
        },
        ambient: Vec3::new(0.07, 0.08, 0.12),
        ..Scene::default()
    };
    let plane = scene.add_mesh(primitive::plane());
    let cube = scene.add_mesh(primitive::cube());
    let (columns, rows) = (detail.segments(64, 12), detail.segments(32, 6));
    let sphere = scene.add_mesh(primitive::sphere(columns, rows));
    let ring = scene.add_mesh(primitive::torus(0.42, 0.16, columns, rows));
    let ground = scene.add_material(matte(0.52, 0.48, 0.4));
    let plinth = scene.add_material(matte(0.74, 0.73, 0.7));
    let polished = |r, g, b| Material { specular: 0.6, shininess: 90.0, ..matte(r, g, b) };
    let [jade, garnet, amber] = [(0.12, 0.45, 0.3), (0.5, 0.08, 0.1), (0.75, 0.42, 0.08)]
        .map(|(r, g, b)| scene.add_material(polished(r, g, b)));
    scene.place(plane, ground, sized(DVec3::ZERO, DVec3::new(24.0, 1.0, 24.0), 0.0));
    for (x, z, height) in [(-1.5, 0.5, 0.55), (0.0, -0.6, 0.95), (1.5, 0.3, 0.35)] {
        scene.place(cube, plinth, standing(DVec3::new(x, 0.0, z), DVec3::new(0.85, height, 0.85), 12.0 * x));
    }
    scene.place(sphere, jade, sized(DVec3::new(-1.5, 1.0, 0.5), DVec3::splat(0.45), 0.0));
    let upright = DMat3::from_rotation_y(0.4) * DMat3::from_rotation_x(1.45);
    scene.place(ring, garnet, glam::DAffine3::from_mat3_translation(upright, DVec3::new(0.0, 1.53, -0.6)));
    scene.place(sphere, amber, sized(DVec3::new(1.5, 0.95, 0.3), DVec3::new(0.42, 0.6, 0.42), 0.0));
    let (sun, warm) = (sunlight(-40.0, 38.0), [1.0, 0.95, 0.86]);
    scene.lights = vec![
        light(LightShape::Directional { direction: sun, angle_deg: 0.0 }, warm, 0.9),
        light(LightShape::Directional { direction: sun, angle_deg: SUN_ANGLE_DEG }, warm, 0.9),
    ];
    // The numbers are within the model's range; were they not, the sky would be grey.
    let clear = Daylight::new(-sun, TURBIDITY, Vec3::new(0.52, 0.48, 0.4), SUN_ANGLE_DEG);
    let sky = clear.map_or(Sky::Constant(Vec3::splat(15.0)), Sky::Daylight);
    scene.environment = Some(Environment { intensity: 0.045, ..Environment::new(sky) });
    scene
}

//! A picket fence before a house wall.

use super::{DETAIL, SceneEntry, kit::*, shapes};
use crate::{Camera, LightShape, Scene, primitive};
use glam::{DVec2, DVec3, Vec3};

pub const ENTRY: SceneEntry = SceneEntry {
    id: "picket-fence",
    title: "A picket fence before a wall",
    about: "Thin casters, narrower than the light: what takes only the nearest caster into account, or one texel, \
            fails here. Detail scales the number of pickets. Lights: 0 point, 1 sphere at the same place.",
    build,
};

/// Length of the fence, metres.
const LENGTH: f64 = 6.4;
/// Where the fence stands.
const FENCE_Z: f64 = 0.6;

fn build(detail: f32) -> Scene {
    let detail = Detail::within(detail, DETAIL);
    let mut scene = Scene {
        name: ENTRY.title.into(),
        camera: Camera {
            eye: DVec3::new(-2.9, 2.15, 4.7),
            target: DVec3::new(-0.15, 0.55, -0.35),
            fov_y_deg: 42.0,
            ..Camera::default()
        },
        ambient: Vec3::new(0.08, 0.09, 0.12),
        ..Scene::default()
    };
    place_surroundings(&mut scene);
    place_fence(&mut scene, detail.count(32).max(2));
    let position = DVec3::new(2.6, 1.3, 4.4);
    let warm = [1.0, 0.92, 0.8];
    scene.lights = vec![
        light(LightShape::Point { position }, warm, 0.6),
        light(LightShape::Sphere { position, radius: 0.16 }, warm, 0.6),
    ];
    scene
}

/// A lawn, a path along the fence, and a wall of overlapping boards.
fn place_surroundings(scene: &mut Scene) {
    let plane = scene.add_mesh(primitive::plane());
    let cube = scene.add_mesh(primitive::cube());
    let lawn = scene.add_material(matte(0.32, 0.42, 0.2));
    let path = scene.add_material(matte(0.66, 0.6, 0.52));
    let boards = scene.add_material(matte(0.42, 0.55, 0.6));
    let plinth = scene.add_material(matte(0.5, 0.47, 0.44));
    scene.place(plane, lawn, sized(DVec3::ZERO, DVec3::new(16.0, 1.0, 16.0), 0.0));
    scene.place(cube, path, standing(DVec3::new(0.0, 0.0, -0.45), DVec3::new(16.0, 0.03, 1.3), 0.0));
    scene.place(cube, plinth, standing(DVec3::new(0.0, 0.0, -1.9), DVec3::new(9.0, 0.3, 0.34), 0.0));
    let board = scene.add_mesh(shapes::prism("board", &board_section(), 1.0));
    for i in 0..16 {
        let height = DVec3::new(0.0, 0.28 + 0.2 * f64::from(i), -1.8);
        // The section lies in the XY plane: turned, it runs along x.
        scene.place(board, boards, sized(height, DVec3::new(1.0, 1.0, 9.0), -90.0));
    }
}

/// Section of a clapboard: thick at its lower edge. X is the way out of the wall.
fn board_section() -> [DVec2; 4] {
    [(-0.1, 0.0), (0.05, 0.0), (0.022, 0.22), (-0.1, 0.22)].map(|(x, y)| DVec2::new(x, y))
}

fn place_fence(scene: &mut Scene, pickets: u32) {
    let cube = scene.add_mesh(primitive::cube());
    let paint = scene.add_material(matte(0.86, 0.85, 0.82));
    let spacing = LENGTH / f64::from(pickets);
    let half = 0.5 * spacing.min(0.2) * 0.5;
    let outline = [(-half, 0.0), (half, 0.0), (half, 1.02), (0.0, 1.02 + 1.1 * half), (-half, 1.02)];
    let picket = scene.add_mesh(shapes::prism("picket", &outline.map(|(x, y)| DVec2::new(x, y)), 0.022));
    for i in 0..pickets {
        let x = (f64::from(i) + 0.5) * spacing - LENGTH * 0.5;
        scene.place(picket, paint, at(x, 0.05, FENCE_Z));
    }
    for height in [0.26, 0.82] {
        let center = DVec3::new(0.0, height, FENCE_Z - 0.03);
        scene.place(cube, paint, sized(center, DVec3::new(LENGTH, 0.08, 0.035), 0.0));
    }
    let ball = scene.add_mesh(primitive::sphere(20, 10));
    for i in 0..4 {
        let x = (f64::from(i) / 3.0 - 0.5) * LENGTH;
        scene.place(cube, paint, standing(DVec3::new(x, 0.0, FENCE_Z - 0.1), DVec3::new(0.11, 1.2, 0.11), 0.0));
        scene.place(ball, paint, sized(DVec3::new(x, 1.25, FENCE_Z - 0.1), DVec3::splat(0.075), 0.0));
    }
}

//! A light inside a box with holes.

use super::{DETAIL, SceneEntry, kit::*, shapes};
use crate::{Camera, LightShape, Scene, primitive};
use glam::{DAffine3, DMat3, DVec2, DVec3, Vec3};

pub const ENTRY: SceneEntry = SceneEntry {
    id: "lantern",
    title: "A pierced lantern in a room",
    about: "The light sits inside a closed caster with holes, so shadows go everywhere: all six faces of a cube map, \
            seams between them, and light leaks, which show at once. Lights: 0 point, 1 a small sphere at the same place.",
    build,
};

/// Half the width of the lantern's body, and its height, metres.
const HALF: f64 = 0.3;
const HEIGHT: f64 = 0.86;
/// What the lantern stands on.
const TABLE: DVec3 = DVec3::new(0.0, 0.74, 0.0);

fn build(detail: f32) -> Scene {
    let detail = Detail::within(detail, DETAIL);
    let mut scene = Scene {
        name: ENTRY.title.into(),
        camera: Camera {
            eye: DVec3::new(1.7, 2.15, 3.3),
            target: DVec3::new(-0.2, 1.05, -0.3),
            fov_y_deg: 58.0,
            ..Camera::default()
        },
        ambient: Vec3::new(0.03, 0.035, 0.05),
        ..Scene::default()
    };
    place_room(&mut scene);
    place_table(&mut scene, detail);
    place_lantern(&mut scene, detail);
    let position = TABLE + DVec3::Y * (HEIGHT * 0.5);
    let candle = [1.0, 0.72, 0.42];
    scene.lights = vec![
        light(LightShape::Point { position }, candle, 0.7),
        light(LightShape::Sphere { position, radius: 0.04 }, candle, 0.7),
    ];
    scene
}

/// 6 × 3 × 8 metres; walls and ceiling are boxes, so that nothing is open.
fn place_room(scene: &mut Scene) {
    let cube = scene.add_mesh(primitive::cube());
    let floor = scene.add_material(matte(0.5, 0.36, 0.26));
    let wall = scene.add_material(matte(0.74, 0.7, 0.64));
    let mut slab = |material, center: [f64; 3], size: [f64; 3]| {
        scene.place(cube, material, sized(DVec3::from(center), DVec3::from(size), 0.0));
    };
    slab(floor, [0.0, -0.1, 0.5], [6.4, 0.2, 8.4]);
    slab(wall, [0.0, 3.1, 0.5], [6.4, 0.2, 8.4]);
    slab(wall, [0.0, 1.5, -2.6], [6.0, 3.0, 0.2]);
    slab(wall, [0.0, 1.5, 4.6], [6.0, 3.0, 0.2]);
    slab(wall, [-3.1, 1.5, 1.0], [0.2, 3.0, 7.4]);
    slab(wall, [3.1, 1.5, 1.0], [0.2, 3.0, 7.4]);
}

/// A table with a jug and two books on it, and a stool beside it.
fn place_table(scene: &mut Scene, detail: Detail) {
    let cube = scene.add_mesh(primitive::cube());
    let columns = detail.segments(48, 10);
    let leg = scene.add_mesh(primitive::cylinder(detail.segments(16, 6), 1));
    let jug = scene.add_mesh(shapes::lathe("jug", columns, &jug_profile(detail.segments(10, 3))));
    let seat = scene.add_mesh(primitive::cylinder(columns, 1));
    let wood = scene.add_material(glossy(0.42, 0.24, 0.13));
    let clay = scene.add_material(glossy(0.2, 0.42, 0.5));
    let red = scene.add_material(matte(0.6, 0.14, 0.1));
    let cream = scene.add_material(matte(0.8, 0.74, 0.6));
    scene.place(cube, wood, sized(TABLE - DVec3::Y * 0.025, DVec3::new(1.9, 0.05, 1.1), 0.0));
    for (x, z) in [(-0.85, -0.45), (0.85, -0.45), (-0.85, 0.45), (0.85, 0.45)] {
        scene.place(leg, wood, standing(DVec3::new(x, 0.0, z), DVec3::new(0.035, 0.7, 0.035), 0.0));
    }
    scene.place(jug, clay, at(0.62, TABLE.y, -0.18));
    scene.place(cube, red, standing(TABLE + DVec3::new(-0.6, 0.0, 0.2), DVec3::new(0.34, 0.05, 0.24), 25.0));
    scene.place(cube, cream, standing(TABLE + DVec3::new(-0.6, 0.05, 0.2), DVec3::new(0.28, 0.04, 0.2), 8.0));
    let stool = DVec3::new(-1.6, 0.0, 0.9);
    scene.place(seat, wood, sized(stool + DVec3::Y * 0.47, DVec3::new(0.22, 0.05, 0.22), 0.0));
    for k in 0..3 {
        let (sin, cos) = (f64::from(k) * 120.0f64).to_radians().sin_cos();
        let foot = stool + DVec3::new(0.15 * cos, 0.0, 0.15 * sin);
        scene.place(leg, wood, standing(foot, DVec3::new(0.025, 0.46, 0.025), 0.0));
    }
}

fn jug_profile(segments: u32) -> Vec<DVec2> {
    let mut profile = vec![DVec2::new(0.0, 0.3), DVec2::new(0.065, 0.3), DVec2::new(0.05, 0.24)];
    profile.extend(shapes::arc(DVec2::new(0.03, 0.12), 0.1, 70.0, -70.0, segments));
    profile.extend([DVec2::new(0.06, 0.0), DVec2::ZERO]);
    profile
}

/// Four pierced panels between posts, a floor, and a roof with a ring on top.
fn place_lantern(scene: &mut Scene, detail: Detail) {
    let cube = scene.add_mesh(primitive::cube());
    let panel = scene.add_mesh(shapes::perforated_panel(13, 19, is_pierced));
    let roof =
        scene.add_mesh(shapes::lathe("roof", 4, &[(0.0, 0.2), (0.1, 0.14), (0.5, 0.0), (0.0, 0.0)].map(DVec2::from)));
    let ring = scene.add_mesh(primitive::torus(1.0, 0.14, detail.segments(40, 8), detail.segments(16, 5)));
    let brass = scene.add_material(glossy(0.5, 0.36, 0.16));
    for side in 0..4 {
        let turn = DAffine3::from_rotation_y(f64::from(side) * std::f64::consts::FRAC_PI_2);
        let center = DVec3::new(0.0, HEIGHT * 0.5, HALF);
        let size = DVec3::new(2.0 * HALF, HEIGHT, 0.012);
        scene.place(panel, brass, DAffine3::from_translation(TABLE) * turn * sized(center, size, 0.0));
        let post = DVec3::new(HALF, 0.0, HALF);
        let size = DVec3::new(0.04, HEIGHT, 0.04);
        scene.place(cube, brass, DAffine3::from_translation(TABLE) * turn * standing(post, size, 0.0));
    }
    let width = 2.0 * HALF + 0.08;
    scene.place(cube, brass, standing(TABLE, DVec3::new(width, 0.02, width), 0.0));
    scene.place(cube, brass, standing(TABLE + DVec3::Y * HEIGHT, DVec3::new(width, 0.02, width), 0.0));
    scene.place(roof, brass, sized(TABLE + DVec3::Y * (HEIGHT + 0.02), DVec3::ONE, 45.0));
    let upright = DMat3::from_rotation_x(std::f64::consts::FRAC_PI_2) * 0.06;
    let top = TABLE + DVec3::Y * (HEIGHT + 0.27);
    scene.place(ring, brass, DAffine3::from_mat3_translation(upright, top));
}

/// Slits in three rows, and square holes between them.
fn is_pierced(i: u32, j: u32) -> bool {
    let column = i % 2 == 1 && i < 12;
    column && matches!(j, 2..=4 | 6 | 8..=10 | 12 | 14..=16)
}

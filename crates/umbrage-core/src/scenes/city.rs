//! A city of boxes: a large world of many small draws.

use super::{SceneEntry, kit::*};
use crate::{Camera, LightShape, Scene, primitive};
use glam::{DVec3, Vec3};

pub const ENTRY: SceneEntry = SceneEntry {
    id: "city",
    title: "A city under the sun",
    about: "A large environment seen from the street: resolution near and far, and many instances of one mesh. \
            1,600 buildings over 500 m; detail, here up to 64, scales their number (6.25: 10,000). \
            Lights: 0 the sun without its angle, 1 the sun with 0.53 degrees.",
    build,
};

/// Buildings along one side of a block.
const PER_BLOCK: u32 = 4;
/// Distance of neighbouring buildings within a block, metres.
const LOT: f64 = 9.5;
/// Width of a street with its pavements, metres.
const STREET: f64 = 12.0;
/// From block to block, metres.
const BLOCK: f64 = PER_BLOCK as f64 * LOT + STREET;

fn build(detail: f32) -> Scene {
    let buildings = Detail::within(detail, 0.05..=64.0).count(1600);
    let side = f64::from(buildings).sqrt().ceil() as u32;
    let blocks = side.div_ceil(PER_BLOCK);
    let extent = f64::from(blocks) * BLOCK;
    // A crossing near the middle; all streets run along x or z.
    let crossing = |steps: i32| (f64::from(blocks / 2) + f64::from(steps)) * BLOCK - extent * 0.5 - STREET * 0.5;
    let street = crossing(0);
    let mut scene = Scene {
        name: ENTRY.title.into(),
        camera: Camera {
            eye: DVec3::new(street + 2.2, 1.75, street + 31.0),
            target: DVec3::new(street - 0.6, 4.3, street),
            fov_y_deg: 62.0,
            near: 0.1,
            ..Camera::default()
        },
        ambient: Vec3::new(0.13, 0.16, 0.22),
        ..Scene::default()
    };
    place_ground(&mut scene, blocks, extent);
    place_buildings(&mut scene, buildings, side, extent);
    let direction = sunlight(24.0, 44.0);
    scene.lights = [0.0, SUN_ANGLE_DEG]
        .map(|angle_deg| light(LightShape::Directional { direction, angle_deg }, [1.0, 0.93, 0.8], 0.5))
        .to_vec();
    scene
}

/// Asphalt, and a raised pavement under every block.
fn place_ground(scene: &mut Scene, blocks: u32, extent: f64) {
    let plane = scene.add_mesh(primitive::plane());
    let cube = scene.add_mesh(primitive::cube());
    let asphalt = scene.add_material(matte(0.2, 0.2, 0.21));
    let pavement = scene.add_material(matte(0.5, 0.49, 0.46));
    scene.place(plane, asphalt, sized(DVec3::ZERO, DVec3::new(extent + 60.0, 1.0, extent + 60.0), 0.0));
    let size = DVec3::new(BLOCK - STREET * 0.6, 0.15, BLOCK - STREET * 0.6);
    for i in 0..blocks * blocks {
        let center = |k: u32| (f64::from(k) + 0.5) * BLOCK - extent * 0.5 - STREET * 0.5;
        let ground = DVec3::new(center(i % blocks), 0.0, center(i / blocks));
        scene.place(cube, pavement, standing(ground, size, 0.0));
    }
}

fn place_buildings(scene: &mut Scene, buildings: u32, side: u32, extent: f64) {
    let cube = scene.add_mesh(primitive::cube());
    let facades = [
        [0.72, 0.6, 0.48],
        [0.62, 0.36, 0.27],
        [0.78, 0.73, 0.65],
        [0.45, 0.5, 0.55],
        [0.66, 0.52, 0.35],
        [0.56, 0.6, 0.58],
        [0.8, 0.66, 0.52],
        [0.36, 0.4, 0.47],
    ]
    .map(|[r, g, b]| scene.add_material(matte(r, g, b)));
    let mut rng = Rng::new(0x1600);
    for i in 0..buildings {
        let place = |k: u32| {
            let (block, lot) = (k / PER_BLOCK, k % PER_BLOCK);
            f64::from(block) * BLOCK + (f64::from(lot) + 0.5) * LOT - extent * 0.5
        };
        let (x, z) = (place(i % side), place(i / side));
        // Towers stand in the middle, and one here and there.
        let downtown = (-(x * x + z * z) / (120.0 * 120.0)).exp();
        let tower = if rng.range(0.0, 1.0) < 0.04 + 0.16 * downtown { rng.range(14.0, 42.0) } else { 0.0 };
        let height = rng.range(5.5, 13.0) + 7.0 * downtown + tower;
        let size = DVec3::new(rng.range(5.6, 8.6), height, rng.range(5.6, 8.6));
        let ground = DVec3::new(x + rng.range(-0.3, 0.3), 0.15, z + rng.range(-0.3, 0.3));
        let turn_deg = rng.range(-2.5, 2.5);
        let facade = facades[rng.below(facades.len())];
        scene.place(cube, facade, standing(ground, size, turn_deg));
    }
}

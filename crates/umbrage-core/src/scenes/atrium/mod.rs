//! A court with a two-storey colonnade.

mod parts;

use super::{DETAIL, SceneEntry, kit::*};
use crate::{Camera, LightShape, Material, Scene, primitive};
use glam::{DAffine3, DVec3, Vec2, Vec3};
use parts::Cut;

pub const ENTRY: SceneEntry = SceneEntry {
    id: "atrium",
    title: "A court with two storeys of arches",
    about: "Architecture: hundreds of thousands of triangles, curved and fine casters near and far, sunlit court and \
            deep galleries. Lights: 0 the sun without its angle, 1 a sphere lamp on the fountain.",
    build,
};

/// Width of an arch from column to column, metres.
const BAY: f64 = 4.0;
/// Arches along x and along z.
const BAYS: [u32; 2] = [5, 7];
/// From the arcade to the back wall.
const GALLERY: f64 = 4.2;
/// Thickness of the arcade's walls.
const WALL: f64 = 0.6;
/// Height of the gallery's floor over the court.
const STEP: f64 = 0.2;
/// Balusters in a bay; fewer at low detail.
const BALUSTERS: u32 = 9;

/// Heights in metres over the court.
struct Storey {
    floor: f64,
    /// What the columns stand on, over the floor.
    pedestal: f64,
    column: f64,
    column_radius: f64,
    arch_radius: f64,
    /// Where the cornice starts.
    top: f64,
}

impl Storey {
    fn springing(&self) -> f64 {
        self.floor + self.pedestal + self.column
    }
}

const STOREYS: [Storey; 2] = [
    Storey { floor: STEP, pedestal: 0.0, column: 3.9, column_radius: 0.3, arch_radius: 1.5, top: 6.1 },
    Storey { floor: 6.7, pedestal: 1.0, column: 2.7, column_radius: 0.22, arch_radius: 1.55, top: 12.3 },
];
/// Height of a cornice.
const CORNICE: f64 = 0.6;

/// Meshes and materials that are placed many times.
struct Stock {
    cube: usize,
    columns: [usize; 2],
    arches: [usize; 2],
    baluster: usize,
    balusters_in_bay: u32,
    door: usize,
    stone: usize,
    pale: usize,
    plaster: usize,
    wood: usize,
}

/// One side of the court: x runs along it from its middle, the court lies towards +z, the arcade at
/// z = 0.
struct Side {
    world_from_side: DAffine3,
    bays: u32,
    /// Sides along x reach around the corners behind the arcade, the others end there.
    covers_corners: bool,
}

impl Side {
    fn length(&self) -> f64 {
        f64::from(self.bays) * BAY
    }

    /// The middle of every bay.
    fn middles(&self) -> impl Iterator<Item = f64> {
        let start = -0.5 * self.length();
        (0..self.bays).map(move |i| start + (f64::from(i) + 0.5) * BAY)
    }

    /// Between neighbouring bays.
    fn columns(&self) -> impl Iterator<Item = f64> {
        let start = -0.5 * self.length();
        (1..self.bays).map(move |i| start + f64::from(i) * BAY)
    }
}

fn build(detail: f32) -> Scene {
    let detail = Detail::within(detail, DETAIL);
    let mut scene = Scene {
        name: ENTRY.title.into(),
        camera: Camera {
            eye: DVec3::new(-8.3, 3.1, 12.7),
            target: DVec3::new(1.9, 4.3, -4.0),
            fov_y_deg: 62.0,
            ..Camera::default()
        },
        ambient: Vec3::new(0.12, 0.14, 0.18),
        ..Scene::default()
    };
    let stock = stock(&mut scene, detail);
    for k in 0..4u32 {
        let along_x = k % 2 == 0;
        let across = f64::from(BAYS[usize::from(along_x)]) * BAY * 0.5;
        let turn = DAffine3::from_rotation_y(f64::from(k) * std::f64::consts::FRAC_PI_2);
        let world_from_side = turn * at(0.0, 0.0, -across);
        let side = Side { world_from_side, bays: BAYS[usize::from(!along_x)], covers_corners: along_x };
        place_walls(&mut scene, &stock, &side);
        for k in 0..2 {
            place_arcade(&mut scene, &stock, &side, k);
        }
        place_balustrade(&mut scene, &stock, &side);
    }
    place_court(&mut scene, detail);
    scene.lights = vec![
        light(LightShape::Directional { direction: sunlight(128.0, 54.0), angle_deg: 0.0 }, [1.0, 0.93, 0.82], 0.72),
        light(LightShape::Sphere { position: LAMP, radius: LAMP_RADIUS }, [1.0, 0.78, 0.5], 0.35),
    ];
    scene
}

fn stock(scene: &mut Scene, detail: Detail) -> Stock {
    let cut = Cut { around: detail.segments(30, 6), arc: detail.segments(5, 2) };
    let fine = Cut { around: detail.segments(14, 4), arc: detail.segments(5, 1) };
    let arc = detail.segments(48, 8);
    Stock {
        cube: scene.add_mesh(primitive::cube()),
        columns: STOREYS.each_ref().map(|s| scene.add_mesh(parts::column(s.column, s.column_radius, cut))),
        arches: STOREYS
            .each_ref()
            .map(|s| scene.add_mesh(parts::arch(BAY, s.top - s.springing(), s.arch_radius, WALL, arc))),
        baluster: scene.add_mesh(parts::baluster(fine)),
        balusters_in_bay: detail.segments(BALUSTERS, 4).min(BALUSTERS),
        door: scene.add_mesh(parts::door(detail.segments(24, 6))),
        stone: scene.add_material(matte(0.78, 0.7, 0.58)),
        pale: scene.add_material(glossy(0.82, 0.78, 0.7)),
        plaster: scene.add_material(matte(0.72, 0.5, 0.36)),
        wood: scene.add_material(glossy(0.26, 0.15, 0.09)),
    }
}

/// A box of a side: its extent along x, y and z.
fn place_box(scene: &mut Scene, stock: &Stock, side: &Side, material: usize, [x, y, z]: [[f64; 2]; 3]) {
    let (low, high) = (DVec3::new(x[0], y[0], z[0]), DVec3::new(x[1], y[1], z[1]));
    scene.place(stock.cube, material, side.world_from_side * sized((low + high) * 0.5, high - low, 0.0));
}

/// Back wall with doors and pilasters, floors, roof and beams.
fn place_walls(scene: &mut Scene, stock: &Stock, side: &Side) {
    let half = side.length() * 0.5 + if side.covers_corners { GALLERY } else { 0.0 };
    let roof = STOREYS[1].top + CORNICE;
    let wall_half = side.length() * 0.5 + GALLERY + if side.covers_corners { 0.3 } else { 0.0 };
    let wall = [-GALLERY - 0.3, -GALLERY];
    place_box(scene, stock, side, stock.plaster, [[-wall_half, wall_half], [0.0, roof], wall]);
    let along = [-half, half];
    // The step up from the court reaches past the arcade; where two sides meet it is left to one of
    // them.
    let step = side.length() * 0.5 - if side.covers_corners { 0.0 } else { 0.7 };
    place_box(scene, stock, side, stock.pale, [[-step, step], [0.0, STEP], [-WALL * 0.5, 0.7]]);
    place_box(scene, stock, side, stock.stone, [along, [0.0, STEP], [-GALLERY, -WALL * 0.5]]);
    for storey in &STOREYS {
        let slab = [storey.top + CORNICE - 0.3, storey.top + CORNICE];
        place_box(scene, stock, side, stock.plaster, [along, slab, [-GALLERY, -WALL * 0.5]]);
        for x in side.columns() {
            let beam = [slab[0] - 0.4, slab[0]];
            place_box(scene, stock, side, stock.wood, [[x - 0.14, x + 0.14], beam, [-GALLERY, -WALL * 0.5]]);
            let pilaster = [storey.floor, beam[0]];
            place_box(scene, stock, side, stock.stone, [[x - 0.3, x + 0.3], pilaster, [-GALLERY, -GALLERY + 0.16]]);
        }
        for x in side.middles() {
            let leaf = sized(DVec3::new(x, storey.floor, -GALLERY), DVec3::new(1.3, 1.3, 0.1), 0.0);
            scene.place(stock.door, stock.wood, side.world_from_side * leaf);
        }
    }
}

/// Columns, arches and the cornice of storey `k`, and the pier at the corner where x begins.
fn place_arcade(scene: &mut Scene, stock: &Stock, side: &Side, k: usize) {
    let storey = &STOREYS[k];
    for x in side.middles() {
        scene.place(stock.arches[k], stock.stone, side.world_from_side * at(x, storey.springing(), 0.0));
    }
    for x in side.columns() {
        let foot = at(x, storey.floor + storey.pedestal, 0.0);
        scene.place(stock.columns[k], stock.pale, side.world_from_side * foot);
    }
    let half = side.length() * 0.5;
    let pier = [-0.46, 0.46];
    place_box(scene, stock, side, stock.stone, [pier.map(|p| p - half), [storey.floor, storey.top], pier]);
    for (low, high, depth) in [(0.0, 0.22, 0.4), (0.22, 0.44, 0.52), (0.44, CORNICE, 0.7)] {
        // Opposite sides reach around the corners; the others end where those begin.
        let reach = half + if side.covers_corners { WALL * 0.5 } else { -depth };
        let heights = [storey.top + low, storey.top + high];
        place_box(scene, stock, side, stock.pale, [[-reach, reach], heights, [-WALL * 0.5, depth]]);
    }
}

/// Balustrade of the upper storey: pedestals under the columns, rails and balusters between.
fn place_balustrade(scene: &mut Scene, stock: &Stock, side: &Side) {
    let Storey { floor, pedestal, .. } = STOREYS[1];
    for x in side.columns() {
        let width = [-0.33, 0.33];
        place_box(scene, stock, side, stock.stone, [width.map(|w| x + w), [floor, floor + pedestal], width]);
    }
    for x in side.middles() {
        let along = [x - BAY * 0.5 + 0.33, x + BAY * 0.5 - 0.33];
        let bottom = [floor, floor + 0.12];
        let top = [floor + pedestal - 0.13, floor + pedestal];
        place_box(scene, stock, side, stock.pale, [along, bottom, [-0.17, 0.17]]);
        place_box(scene, stock, side, stock.pale, [along, top, [-0.2, 0.2]]);
        for i in 0..stock.balusters_in_bay {
            let t = (f64::from(i) + 0.5) / f64::from(stock.balusters_in_bay);
            let foot = DVec3::new(along[0] + t * (along[1] - along[0]), bottom[1], 0.0);
            let size = DVec3::new(0.75, top[0] - bottom[1], 0.75);
            scene.place(stock.baluster, stock.pale, side.world_from_side * sized(foot, size, 0.0));
        }
    }
}

/// Middle of the lamp that crowns the fountain.
const LAMP: DVec3 = DVec3::new(0.0, 2.62, 0.0);
const LAMP_RADIUS: f64 = 0.3;

/// The court's floor, the fountain with its lamp, and cypresses in pots.
fn place_court(scene: &mut Scene, detail: Detail) {
    let cut = Cut { around: detail.segments(64, 8), arc: detail.segments(8, 2) };
    let size = DVec3::new(f64::from(BAYS[0]) * BAY, 1.0, f64::from(BAYS[1]) * BAY);
    let floor = scene.add_mesh(parts::floor(Vec2::new(size.x as f32, size.z as f32) * 0.5));
    scene.textures.push(parts::tiles());
    let texture = Some(scene.textures.len() - 1);
    let tiles = scene.add_material(Material { texture, ..matte(1.0, 1.0, 1.0) });
    scene.place(floor, tiles, sized(DVec3::ZERO, size, 0.0));

    let fountain = scene.add_mesh(parts::fountain(cut));
    let marble = scene.add_material(glossy(0.7, 0.7, 0.68));
    scene.place(fountain, marble, DAffine3::IDENTITY);
    let globe = scene.add_mesh(primitive::sphere(detail.segments(32, 8), detail.segments(16, 4)));
    let glow = scene.add_material(glowing(1.0, 0.82, 0.58));
    // The globe is what shines: it must not shade its own light.
    let lamp = scene.place(globe, glow, sized(LAMP, DVec3::splat(LAMP_RADIUS), 0.0));
    (lamp.casts, lamp.receives) = (false, false);

    let cut = Cut { around: detail.segments(28, 6), arc: detail.segments(8, 2) };
    let pot = scene.add_mesh(parts::pot(cut));
    let cypress = scene.add_mesh(parts::cypress(cut));
    let clay = scene.add_material(matte(0.58, 0.28, 0.18));
    let green = scene.add_material(matte(0.12, 0.24, 0.11));
    for (x, z) in [(-6.8, -4.0), (6.8, -4.0), (-6.8, 4.0), (6.8, 4.0)] {
        scene.place(pot, clay, at(x, 0.0, z));
        scene.place(cypress, green, at(x, 0.58, z));
    }
}

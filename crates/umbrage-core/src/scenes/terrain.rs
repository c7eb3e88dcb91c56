//! Hills with trees.

use super::{DETAIL, SceneEntry, kit::*, tree};
use crate::material::{Sampling, Texture};
use crate::{Camera, LightShape, Material, Mesh, Scene};
use glam::{DVec2, DVec3, Vec2, Vec3};

pub const ENTRY: SceneEntry = SceneEntry {
    id: "terrain",
    title: "Hills with trees",
    about: "Open country over 200 m: ground that shades itself at grazing light, trees as alpha-masked cards (their \
            shadows must be those of the leaves, not of the squares) and as meshes. Lights: 0 the sun without its angle, \
            1 the sun with 0.53 degrees.",
    build,
};

/// Edge of the square of land, metres.
const EXTENT: f64 = 220.0;
/// Where the camera stands and which place on the ground it looks over.
const EYE: DVec2 = DVec2::new(6.0, 62.0);
const TARGET: DVec2 = DVec2::new(-6.0, 20.0);

fn build(detail: f32) -> Scene {
    let detail = Detail::within(detail, DETAIL);
    let hills = Hills::new(detail.segments(160, 24));
    let eye = hills.on(EYE) + DVec3::Y * 2.4;
    let mut scene = Scene {
        name: ENTRY.title.into(),
        camera: Camera {
            eye,
            target: DVec3::new(TARGET.x, eye.y - 2.6, TARGET.y),
            fov_y_deg: 52.0,
            near: 0.1,
            ..Camera::default()
        },
        ambient: Vec3::new(0.15, 0.18, 0.24),
        ..Scene::default()
    };
    let mesh = scene.add_mesh(hills.mesh());
    scene.textures.push(ground_texture());
    let ground = scene.add_material(Material { texture: Some(0), ..matte(1.0, 1.0, 1.0) });
    scene.place(mesh, ground, at(0.0, 0.0, 0.0));
    plant(&mut scene, &hills, detail);
    let direction = sunlight(118.0, 33.0);
    scene.lights = [0.0, SUN_ANGLE_DEG]
        .map(|angle_deg| light(LightShape::Directional { direction, angle_deg }, [1.0, 0.92, 0.76], 0.75))
        .to_vec();
    scene
}

/// Sets trees of four kinds, in groves, out of the camera's way.
fn plant(scene: &mut Scene, hills: &Hills, detail: Detail) {
    let bark = scene.add_material(matte(0.2, 0.13, 0.09));
    let greens =
        [[0.13, 0.25, 0.1], [0.2, 0.32, 0.1], [0.34, 0.34, 0.1]].map(|[r, g, b]| scene.add_material(matte(r, g, b)));
    scene.textures.push(tree::leaf_texture());
    let texture = Some(scene.textures.len() - 1);
    let card_material = scene.add_material(Material { texture, alpha_cutoff: Some(0.5), ..matte(1.0, 1.0, 1.0) });
    let cards = scene.add_mesh(tree::cards());
    let mut rng = Rng::new(0x7ee5);
    let columns = detail.segments(14, 5);
    let trees = [tree::fir(columns), tree::broadleaf(columns, &mut rng), tree::broadleaf(columns, &mut rng)]
        .map(|t| (scene.add_mesh(t.wood), scene.add_mesh(t.leaves)));

    for place in places(&mut rng, detail.count(170).max(12)) {
        // A little into the ground, which slopes.
        let foot = hills.on(place) - DVec3::Y * 0.12;
        let turn_deg = rng.range(0.0, 360.0);
        let kind = rng.below(6);
        if kind < 3 {
            let height = rng.range(4.5, 7.5);
            scene.place(cards, card_material, sized(foot, DVec3::new(height * 0.95, height, height * 0.95), turn_deg));
        } else {
            let (wood, leaves) = trees[kind - 3];
            let height = if kind == 3 { rng.range(6.0, 11.0) } else { rng.range(5.0, 8.0) };
            let size = sized(foot, DVec3::splat(height), turn_deg);
            let green = if kind == 3 { greens[0] } else { greens[1 + rng.below(2)] };
            scene.place(wood, bark, size);
            scene.place(leaves, green, size);
        }
    }
}

/// Where trees stand: four in the middle of the view, the others by chance where a slow noise wants
/// groves, with room between them and a clearing before the camera.
fn places(rng: &mut Rng, count: u32) -> Vec<DVec2> {
    let mut places = vec![DVec2::new(12.5, 47.0), DVec2::new(-6.5, 43.0), DVec2::new(2.5, 38.0), DVec2::new(9.5, 33.0)];
    // Bounded: at high counts the groves are full before all have found room.
    for _ in 0..60 * count {
        if places.len() >= count as usize {
            break;
        }
        let place = DVec2::new(rng.range(-0.47, 0.47), rng.range(-0.47, 0.47)) * EXTENT;
        let grove = noise(place / 38.0 + 7.0) > 0.48;
        let toward = (TARGET - EYE).normalize();
        let along = (place - EYE).dot(toward);
        let clearing =
            place.distance(EYE) < 16.0 || (0.0..52.0).contains(&along) && (place - EYE).perp_dot(toward).abs() < 9.0;
        let room = places.iter().all(|other| other.distance(place) > 2.4);
        if grove && !clearing && room {
            places.push(place);
        }
    }
    places
}

/// The ground as a grid of heights.
struct Hills {
    cells: u32,
    heights: Vec<f64>,
}

impl Hills {
    fn new(cells: u32) -> Self {
        let side = cells + 1;
        let point = |i: u32| DVec2::new(f64::from(i % side), f64::from(i / side)) / f64::from(cells) - 0.5;
        Self { cells, heights: (0..side * side).map(|i| height(point(i) * EXTENT)).collect() }
    }

    /// The point of the mesh over or under `place` (x, z), which is brought into the land.
    fn on(&self, place: DVec2) -> DVec3 {
        let cells = f64::from(self.cells);
        let grid = ((place / EXTENT + 0.5) * cells).clamp(DVec2::ZERO, DVec2::splat(cells));
        let cell = grid.floor().min(DVec2::splat(cells - 1.0));
        let (f, i) = (grid - cell, cell.x as u32 + cell.y as u32 * (self.cells + 1));
        let h = |dx: u32, dy: u32| self.heights[(i + dx + dy * (self.cells + 1)) as usize];
        // The two triangles of a cell meet along its diagonal from (0, 0) to (1, 1).
        let y = if f.y > f.x {
            h(0, 0) + f.y * (h(0, 1) - h(0, 0)) + f.x * (h(1, 1) - h(0, 1))
        } else {
            h(0, 0) + f.x * (h(1, 0) - h(0, 0)) + f.y * (h(1, 1) - h(1, 0))
        };
        DVec3::new(place.x, y, place.y)
    }

    fn mesh(&self) -> Mesh {
        let side = self.cells + 1;
        let mut mesh = Mesh { name: "hills".into(), ..Mesh::default() };
        for (i, height) in (0..).zip(&self.heights) {
            let uv = Vec2::new((i % side) as f32, (i / side) as f32) / self.cells as f32;
            let place = (uv - 0.5) * EXTENT as f32;
            mesh.positions.push(Vec3::new(place.x, *height as f32, place.y));
            mesh.uvs.push(uv);
        }
        for j in 0..self.cells {
            for i in 0..self.cells {
                let (a, b) = (j * side + i, (j + 1) * side + i);
                mesh.indices.extend([a, b, b + 1, a, b + 1, a + 1]);
            }
        }
        mesh.generate_normals_if_absent();
        mesh
    }
}

/// Height of the land, metres: rolling hills with smaller ones on them, higher far from the camera.
fn height(place: DVec2) -> f64 {
    let rise = ((EYE.y - place.y) / EXTENT).max(0.0);
    let octaves = [(52.0, 7.0), (23.0, 2.2), (9.0, 0.5), (3.4, 0.12)];
    let hills: f64 = octaves.iter().map(|(wave, tall)| tall * (2.0 * noise(place / *wave + *wave) - 1.0)).sum();
    hills * (0.45 + 1.5 * rise) + 9.0 * rise * rise
}

/// Smooth value noise in [0, 1]: random numbers at whole places, blended between.
fn noise(place: DVec2) -> f64 {
    let cell = place.floor();
    let f = place - cell;
    let blend = f * f * (3.0 - 2.0 * f);
    let at = |dx: f64, dy: f64| {
        let (x, y) = ((cell.x + dx) as i64, (cell.y + dy) as i64);
        Rng::new((x.wrapping_mul(0x1f12_3bb5) ^ y.wrapping_mul(0x5f35_6495)) as u64).range(0.0, 1.0)
    };
    let top = at(0.0, 0.0) + blend.x * (at(1.0, 0.0) - at(0.0, 0.0));
    let bottom = at(0.0, 1.0) + blend.x * (at(1.0, 1.0) - at(0.0, 1.0));
    top + blend.y * (bottom - top)
}

/// Grass of changing colour over the whole land.
fn ground_texture() -> Texture {
    const SIZE: u32 = 512;
    let mut rng = Rng::new(0x9a55);
    let mut texel = |i: u32| {
        let place = DVec2::new(f64::from(i % SIZE), f64::from(i / SIZE)) / f64::from(SIZE) * EXTENT;
        let dry = 0.6 * noise(place / 17.0) + 0.4 * noise(place / 4.1);
        let grass = DVec3::new(92.0, 116.0, 58.0).lerp(DVec3::new(164.0, 148.0, 92.0), dry);
        let [r, g, b] = (grass + rng.range(-10.0, 10.0)).to_array().map(|c| c as u8);
        [r, g, b, 255]
    };
    let rgba = (0..SIZE * SIZE).map(&mut texel).collect();
    Texture { name: "grass".into(), width: SIZE, height: SIZE, rgba, sampling: Sampling::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_on_the_hills_lies_on_their_mesh() {
        let hills = Hills::new(24);
        let mesh = hills.mesh();
        for triangle in mesh.triangles().step_by(7) {
            let [a, b, c] = mesh.corners(triangle).map(|p| p.as_dvec3());
            for p in [a, (a + b) * 0.5, (a + b + c) / 3.0, a * 0.2 + b * 0.1 + c * 0.7] {
                let on = hills.on(DVec2::new(p.x, p.z));
                assert!((on.y - p.y).abs() < 1e-4, "{on} is not on the mesh at {p}");
            }
        }
    }

    #[test]
    fn hills_face_up() {
        let mesh = Hills::new(24).mesh();
        assert!(mesh.normals.iter().all(|n| n.y > 0.5), "a slope of over 60 degrees, or a turned triangle");
    }
}

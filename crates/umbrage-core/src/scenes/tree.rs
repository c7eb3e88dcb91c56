//! Trees as meshes, and as crossed cards with a leaf texture.

use super::kit::Rng;
use super::shapes;
use crate::material::{Sampling, Texture};
use crate::{Mesh, primitive};
use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2, Vec3};
use std::f64::consts::PI;

/// A tree of height 1: its wood and its leaves.
pub struct Tree {
    /// Trunk and, where they show, branches.
    pub wood: Mesh,
    /// Everything green.
    pub leaves: Mesh,
}

/// A fir: a stack of cones. `columns` around.
pub fn fir(columns: u32) -> Tree {
    const TIERS: u32 = 6;
    let mut profile = vec![DVec2::new(0.0, 1.0)];
    for tier in 1..=TIERS {
        let t = f64::from(tier) / f64::from(TIERS);
        let (height, radius) = (1.0 - 0.86 * t, 0.05 + 0.2 * t);
        profile.extend([DVec2::new(radius, height), DVec2::new(0.55 * radius, height + 0.02)]);
    }
    profile.push(DVec2::new(0.0, 0.16));
    Tree { wood: trunk(columns, 0.3, 0.03), leaves: shapes::lathe("fir", columns, &profile) }
}

/// A broad-leaved tree: a crown of lumpy spheres on a trunk. `columns` around each sphere.
pub fn broadleaf(columns: u32, rng: &mut Rng) -> Tree {
    let mut leaves = Mesh { name: "crown".into(), ..Mesh::default() };
    for i in 0..7 {
        let around = f64::from(i) * 2.4;
        let (reach, height) = if i == 0 { (0.0, 0.8) } else { (rng.range(0.14, 0.22), rng.range(0.46, 0.74)) };
        let center = DVec3::new(reach * around.cos(), height, reach * around.sin());
        let radius = rng.range(0.15, 0.21);
        leaves.append(&lump(columns, rng).transformed(&DAffine3::from_mat3_translation(
            DMat3::from_diagonal(DVec3::new(radius, radius * 0.85, radius)),
            center,
        )));
    }
    leaves.uvs.clear();
    Tree { wood: trunk(columns, 0.6, 0.035), leaves }
}

fn trunk(columns: u32, height: f64, radius: f64) -> Mesh {
    let profile = [(0.0, height), (0.5, height), (0.75, 0.1), (1.25, 0.0), (0.0, 0.0)];
    let profile = profile.map(|(r, h)| DVec2::new(r * radius, h));
    shapes::lathe("trunk", columns.min(12), &profile)
}

/// A sphere of radius about 1 with bumps.
fn lump(columns: u32, rng: &mut Rng) -> Mesh {
    let waves: Vec<(Vec3, f32)> = (0..5)
        .map(|_| {
            let mut number = |range: f64| rng.range(-range, range) as f32;
            (Vec3::new(number(6.0), number(6.0), number(6.0)), number(3.0))
        })
        .collect();
    let mut mesh = primitive::sphere(columns, columns / 2);
    for p in &mut mesh.positions {
        let bump: f32 = waves.iter().map(|(wave, phase)| (wave.dot(*p) + phase).sin()).sum();
        *p *= 1.0 + 0.06 * bump;
    }
    let welded = welded(&mesh);
    welded.with_creases(70.0)
}

/// The mesh with vertices at the same place made one, so that its normals run smoothly over texture
/// seams.
fn welded(mesh: &Mesh) -> Mesh {
    let mut first = std::collections::HashMap::new();
    let mut positions = Vec::new();
    let index = mesh.positions.iter().map(|p| {
        *first.entry(p.to_array().map(f32::to_bits)).or_insert_with(|| {
            positions.push(*p);
            positions.len() as u32 - 1
        })
    });
    let index: Vec<u32> = index.collect();
    let indices = mesh.indices.iter().map(|&i| index[i as usize]).collect();
    Mesh { name: mesh.name.clone(), positions, indices, ..Mesh::default() }
}

/// Three upright squares of side 1 that cross in the Y axis and stand on y = 0, with the texture of
/// [`leaf_texture`].
pub fn cards() -> Mesh {
    let mut mesh = Mesh { name: "tree cards".into(), ..Mesh::default() };
    for k in 0..3 {
        let (sin, cos) = (PI * f64::from(k) / 3.0).sin_cos();
        let side = Vec3::new(cos as f32, 0.0, sin as f32);
        let base = mesh.positions.len() as u32;
        for (x, y) in [(-0.5f32, 0.0f32), (0.5, 0.0), (0.5, 1.0), (-0.5, 1.0)] {
            mesh.positions.push(side * x + Vec3::Y * y);
            mesh.normals.push(side.cross(Vec3::Y));
            // A little inside the picture, so that repetition does not bring the trunk in over the
            // crown.
            mesh.uvs.push(Vec2::new(x + 0.5, 1.0 - y) * 0.99 + 0.005);
        }
        mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|i| base + i));
    }
    mesh
}

/// A picture of a tree, its crown of single leaves, cut out by alpha.
pub fn leaf_texture() -> Texture {
    const SIZE: u32 = 256;
    let mut rng = Rng::new(0x1eaf);
    // Transparent texels have the crown's colour, so that no other colour bleeds in at the edges.
    let mut canvas = Canvas { size: SIZE, rgba: vec![[70, 98, 44, 0]; (SIZE * SIZE) as usize] };
    let bark = [88, 66, 46];
    canvas.stroke(DVec2::new(128.0, 255.0), DVec2::new(128.0, 90.0), [8.0, 3.0], bark);
    for i in 0..9 {
        let start = DVec2::new(128.0, 190.0 - 12.0 * f64::from(i));
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let end = start + DVec2::new(side * rng.range(40.0, 80.0), -rng.range(20.0, 60.0));
        canvas.stroke(start, end, [3.0, 1.0], bark);
    }
    for _ in 0..850 {
        let angle = rng.range(0.0, 2.0 * PI);
        let reach = rng.range(0.0, 1.0).sqrt();
        let place = DVec2::new(128.0, 108.0) + DVec2::new(112.0 * angle.cos(), 96.0 * angle.sin()) * reach;
        let shade = rng.range(0.7, 1.15);
        let color = [74.0 * shade, 116.0 * shade, 44.0 * shade].map(|c| c as u8);
        canvas.leaf(place, rng.range(0.0, PI), rng.range(5.0, 8.5), color);
    }
    Texture { name: "leaves".into(), width: SIZE, height: SIZE, rgba: canvas.rgba, sampling: Sampling::default() }
}

struct Canvas {
    size: u32,
    rgba: Vec<[u8; 4]>,
}

impl Canvas {
    /// Paints the texels whose centre is `inside`, of those within `reach` of `middle`.
    fn paint(&mut self, middle: DVec2, reach: f64, color: [u8; 3], inside: impl Fn(DVec2) -> bool) {
        let end = f64::from(self.size);
        let range = |c: f64| ((c - reach).clamp(0.0, end) as u32)..((c + reach + 1.0).clamp(0.0, end) as u32);
        for y in range(middle.y) {
            for x in range(middle.x) {
                if inside(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)) {
                    let [r, g, b] = color;
                    self.rgba[(y * self.size + x) as usize] = [r, g, b, 255];
                }
            }
        }
    }

    /// A pointed ellipse `length` long to either side.
    fn leaf(&mut self, middle: DVec2, angle: f64, length: f64, color: [u8; 3]) {
        let axis = DVec2::from_angle(angle);
        self.paint(middle, length, color, |p| {
            let along = (p - middle).dot(axis) / length;
            let across = (p - middle).perp_dot(axis) / length;
            across.abs() < 0.5 * (1.0 - along * along)
        });
    }

    /// A line that gets thinner.
    fn stroke(&mut self, from: DVec2, to: DVec2, widths: [f64; 2], color: [u8; 3]) {
        let along = to - from;
        let reach = along.length() * 0.5 + widths[0];
        self.paint((from + to) * 0.5, reach, color, |p| {
            let t = ((p - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            p.distance(from + along * t) < 0.5 * (widths[0] + (widths[1] - widths[0]) * t)
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh_check::check;

    #[test]
    fn trees_are_closed_and_stand_on_the_ground() {
        for tree in [fir(12), broadleaf(10, &mut Rng::new(3))] {
            for mesh in [&tree.wood, &tree.leaves] {
                let report = check(mesh);
                assert!(report.is_closed() && report.degenerate_triangles == 0, "{}: {report:?}", mesh.name);
            }
            assert_eq!(tree.wood.bounds().min.y, 0.0);
            assert!((tree.leaves.bounds().max.y - 1.0).abs() < 0.1, "{:?}", tree.leaves.bounds());
        }
    }

    #[test]
    fn the_picture_of_a_tree_is_cut_out() {
        let texture = leaf_texture();
        let opaque = texture.rgba.iter().filter(|p| p[3] == 255).count() as f64 / texture.rgba.len() as f64;
        assert!((0.3..0.7).contains(&opaque), "{opaque} of the card is there");
        // The trunk meets the ground; the other borders are empty.
        assert!(texture.alpha(Vec2::new(0.5, 0.98)) == 1.0 && texture.alpha(Vec2::new(0.02, 0.98)) == 0.0);
        assert!((0..256).all(|i| texture.rgba[i][3] == 0 && texture.rgba[i * 256][3] == 0));
    }
}

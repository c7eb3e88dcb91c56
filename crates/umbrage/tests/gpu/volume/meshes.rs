//! Triangles that do not make a surface.

use super::random::Random;
use super::{Bench, EXACT, assert_none, floor, put};
use crate::common::gpu;
use umbrage::core::glam::{DAffine3, DVec3, Vec3};
use umbrage::core::{Light, LightShape, Mesh, primitive};

/// Every triangle with vertices of its own, corners of them moved by one unit in the last place.
fn cracked(mesh: &Mesh, random: &mut Random) -> Mesh {
    let mut cracked = Mesh::default();
    for corner in mesh.indices.iter().map(|i| mesh.positions[*i as usize]) {
        let mut nudge = |x: f32| if random.unit() < 0.3 { x.next_up() } else { x };
        cracked.positions.push(Vec3::new(nudge(corner.x), nudge(corner.y), nudge(corner.z)));
        cracked.indices.push(cracked.indices.len() as u32);
    }
    cracked
}

fn with_triangles_turned(mut mesh: Mesh, random: &mut Random) -> Mesh {
    for i in 0..mesh.triangle_count() {
        if random.unit() < 0.3 {
            mesh.indices.swap(3 * i, 3 * i + 1);
        }
    }
    mesh
}

/// Some triangles two and three times, some of them turned round.
fn with_copies(mut mesh: Mesh, random: &mut Random) -> Mesh {
    let all: Vec<[u32; 3]> = mesh.triangles().collect();
    for [a, b, c] in all {
        match random.below(4) {
            0 => mesh.indices.extend([a, b, c]),
            1 => mesh.indices.extend([a, c, b]),
            2 => mesh.indices.extend([b, c, a, c, b, a]),
            _ => (),
        }
    }
    mesh
}

/// Triangles without area between the corners of others, and edges that one neighbour splits and
/// the other does not.
fn with_slivers(mut mesh: Mesh, random: &mut Random) -> Mesh {
    let all: Vec<[u32; 3]> = mesh.triangles().collect();
    for [a, b, c] in all {
        let middle = mesh.positions.len() as u32;
        mesh.positions.push((mesh.positions[a as usize] + mesh.positions[b as usize]) * 0.5);
        match random.below(4) {
            0 => mesh.indices.extend([a, b, b]),
            1 => mesh.indices.extend([a, middle, b, c, c, c]),
            2 => mesh.indices.extend([a, middle, c]),
            _ => (),
        }
    }
    mesh
}

fn with_holes(mut mesh: Mesh, random: &mut Random) -> Mesh {
    let kept: Vec<[u32; 3]> = mesh.triangles().filter(|_| random.unit() < 0.8).collect();
    mesh.indices = kept.into_flattened();
    mesh
}

/// Thousands of vertices at one place, from which triangles go out to all sides, and as many with
/// no extent at all.
fn burst() -> Mesh {
    let n = 1000;
    let mut mesh = Mesh { positions: vec![Vec3::ZERO; n], ..Mesh::default() };
    let sphere = primitive::sphere(20, 12);
    for (i, [a, b, _]) in (0..).zip(sphere.triangles()) {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([a, b].map(|v| sphere.positions[v as usize]));
        mesh.indices.extend([i % n as u32, first, first + 1]);
    }
    mesh.indices.extend(0..999);
    mesh
}

fn triangles(positions: &[[f32; 3]], indices: &[u32]) -> Mesh {
    Mesh { positions: positions.iter().map(|p| (*p).into()).collect(), indices: indices.to_vec(), ..Mesh::default() }
}

/// Triangle soups by name.
pub fn soups() -> Vec<(&'static str, Mesh)> {
    let random = &mut Random(8);
    let (sphere, torus) = (primitive::sphere(24, 12), primitive::torus(0.8, 0.3, 24, 12));
    let lone = [[-1.0, -0.4, 0.2], [1.0, -0.2, 0.0], [0.1, 0.9, -0.4]];
    let bent = [[-1.0, 0.0, -1.0], [1.0, 0.4, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.4, 1.0]];
    let mut crossed = torus.transformed(&DAffine3::from_rotation_x(1.2));
    crossed.append(&torus);
    let needle = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1e-6, 1e-6], [0.0, 0.5, 0.0]];
    vec![
        ("cracked sphere", cracked(&sphere, random)),
        ("cracked torus", cracked(&torus, random)),
        ("turned triangles", with_triangles_turned(torus.clone(), random)),
        ("copies", with_copies(sphere.clone(), random)),
        ("slivers", with_slivers(torus.clone(), random)),
        ("holes", with_holes(sphere, random)),
        ("all of it", cracked(&with_holes(with_copies(with_triangles_turned(torus, random), random), random), random)),
        ("burst", burst()),
        ("a triangle", triangles(&lone, &[0, 1, 2])),
        ("a bent quad", triangles(&bent, &[0, 2, 1, 0, 2, 3])),
        (
            "a fin",
            triangles(&[lone[0], lone[1], lone[2], [0.3, 0.2, 1.0], [0.2, -0.9, 0.4]], &[0, 1, 2, 0, 1, 3, 1, 0, 4]),
        ),
        ("a needle", triangles(&needle, &[0, 1, 2, 1, 0, 3])),
        ("tori through each other", crossed),
    ]
}

#[test]
fn any_triangles_throw_their_shadow() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let direction = DVec3::new(-0.3, -1.0, 0.4).normalize();
    let lights = [
        LightShape::Point { position: DVec3::new(1.5, 4.0, 1.0) },
        LightShape::Directional { direction, angle_deg: 0.0 },
        // In the mesh's box.
        LightShape::Point { position: DVec3::new(0.33, 1.61, -0.17) },
    ];
    for (name, mesh) in soups() {
        let mut scene = floor(lights[0].clone());
        put(&mut scene, mesh, DAffine3::from_translation(DVec3::new(0.0, 1.5, 0.0)));
        let mut bench = Bench::new(&gpu, scene, (160, 120), &EXACT);
        for (number, shape) in lights.iter().enumerate() {
            for eye in [DVec3::new(0.0, 4.0, 7.0), DVec3::new(-2.0, 0.3, -0.6), DVec3::new(0.21, 1.43, 0.3)] {
                let camera = umbrage::core::Camera { eye, fov_y_deg: 60.0, ..bench.scene.camera.clone() };
                let what = format!("{name}, light {number} from {eye}");
                wrong.extend(bench.complaints(&what, &camera, &Light::new(shape.clone())));
            }
        }
    }
    assert_none(&wrong);
}

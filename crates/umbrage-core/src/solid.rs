//! Meshes that every ray from outside enters through a front face, so that their back faces hide
//! nothing that the front faces don't.

use crate::{mesh::Mesh, weld::weld};
use std::collections::HashSet;

/// Most triangles of a mesh that is looked at: the test goes by their square.
const MOST: usize = 256;

/// How far a vertex may be above a triangle's plane, over the size of the mesh.
const ROUNDING: f64 = 1e-6;

/// True where the triangles are all of the surface of a convex body, counter-clockwise seen from
/// outside. Larger meshes than of 256 triangles are not looked at.
pub fn is_convex_solid(mesh: &Mesh) -> bool {
    (4..=MOST).contains(&mesh.triangle_count()) && is_closed(mesh) && is_convex(mesh)
}

/// True where every edge is run along once each way.
fn is_closed(mesh: &Mesh) -> bool {
    let first = weld(&mesh.positions);
    let mut edges = HashSet::new();
    let corners = mesh.triangles().map(|t| t.map(|i| first[i as usize]));
    for [a, b, c] in corners {
        if a == b || b == c || c == a || ![(a, b), (b, c), (c, a)].into_iter().all(|edge| edges.insert(edge)) {
            return false;
        }
    }
    edges.iter().all(|(a, b)| edges.contains(&(*b, *a)))
}

/// True where no vertex is above the plane of a triangle, and every triangle has one.
fn is_convex(mesh: &Mesh) -> bool {
    let size = mesh.bounds().size().max_element();
    mesh.triangles().all(|triangle| {
        let [a, b, c] = mesh.corners(triangle).map(|p| p.as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let above = |i: &u32| normal.dot(mesh.positions[*i as usize].as_dvec3() - a);
        normal.length_squared() > 0.5 && mesh.indices.iter().all(|i| above(i) <= ROUNDING * size)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitive;
    use glam::Vec3;

    fn octahedron() -> Mesh {
        let positions = vec![Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
        let indices = vec![0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5];
        Mesh { positions, indices, ..Mesh::default() }
    }

    #[test]
    fn convex_bodies_are_solid() {
        for mesh in [primitive::cube(), octahedron()] {
            assert!(is_convex_solid(&mesh), "{} triangles", mesh.triangle_count());
        }
    }

    #[test]
    fn what_is_open_turned_or_dented_is_not() {
        let cube = primitive::cube();
        let mut open = cube.clone();
        open.indices.truncate(33);
        let mut turned = cube.clone();
        turned.indices.reverse();
        let mut one_turned = cube.clone();
        one_turned.indices.swap(0, 1);
        let mut twice = cube.clone();
        twice.append(&cube);
        let mut two = cube.clone();
        two.append(&cube.transformed(&glam::DAffine3::from_translation(glam::DVec3::X * 3.0)));
        let mut dented = octahedron();
        dented.positions[0] *= -0.3;
        let mut broken = cube.clone();
        broken.positions[0] = Vec3::NAN;
        let flat = primitive::plane();
        for (i, mesh) in
            [open, turned, one_turned, twice, two, dented, broken, flat, Mesh::default()].iter().enumerate()
        {
            assert!(!is_convex_solid(mesh), "case {i}");
        }
    }
}

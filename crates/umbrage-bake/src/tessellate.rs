//! Cuts triangles until edges are short.

use glam::{DMat3, Vec3};
use std::collections::HashMap;
use umbrage_core::Mesh;

/// Rounds of cutting; each halves the longest edges.
const MOST_ROUNDS: usize = 16;

/// The mesh with its edges cut in halves until none is longer than `longest`, in the metric of
/// `world_from_mesh`. Whether an edge is cut depends on its ends alone, so neighbours stay
/// neighbours and no gap opens. Stops before there are more than `most` vertices. Triangles with
/// corners that are not there are left out; joints are, too.
pub fn tessellated(mesh: &Mesh, world_from_mesh: DMat3, longest: f64, most: usize) -> Mesh {
    let mut cut = plain(mesh);
    for _ in 0..MOST_ROUNDS {
        let Some(next) = round(&cut, world_from_mesh, longest, most) else { break };
        cut = next;
    }
    cut
}

/// Without joints, with normals, with triangles that are in range.
fn plain(mesh: &Mesh) -> Mesh {
    let vertices = mesh.positions.len();
    let in_range = |t: &[u32; 3]| t.iter().all(|&i| (i as usize) < vertices);
    let mut plain = Mesh {
        name: mesh.name.clone(),
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone(),
        indices: mesh.triangles().filter(in_range).flatten().collect(),
        ..Mesh::default()
    };
    if mesh.uvs.len() == vertices {
        plain.uvs.clone_from(&mesh.uvs);
    }
    if mesh.opacities.len() == vertices {
        plain.opacities.clone_from(&mesh.opacities);
    }
    plain.generate_normals_if_absent();
    plain
}

/// One round; `None` where nothing is to be cut, or there would be too many vertices.
fn round(mesh: &Mesh, world_from_mesh: DMat3, longest: f64, most: usize) -> Option<Mesh> {
    let length = |a: u32, b: u32| {
        let along = mesh.positions[b as usize].as_dvec3() - mesh.positions[a as usize].as_dvec3();
        (world_from_mesh * along).length()
    };
    let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
    let mut cut = Mesh { indices: Vec::with_capacity(mesh.indices.len()), ..mesh.clone() };
    for [a, b, c] in mesh.triangles() {
        let halves = [(a, b), (b, c), (c, a)].map(|(a, b)| {
            // Lengths that are no numbers are not cut; neither are edges without end.
            let is_long = length(a, b) > longest && length(a, b).is_finite();
            is_long.then(|| *middles.entry((a.min(b), a.max(b))).or_insert_with(|| add_middle(&mut cut, a, b)))
        });
        if cut.positions.len() > most {
            return None;
        }
        cut.indices.extend(parts([a, b, c], halves).into_iter().flatten().flatten());
    }
    (!middles.is_empty()).then_some(cut)
}

fn add_middle(mesh: &mut Mesh, a: u32, b: u32) -> u32 {
    let (a, b) = (a as usize, b as usize);
    mesh.positions.push((mesh.positions[a] + mesh.positions[b]) * 0.5);
    mesh.normals.push((mesh.normals[a] + mesh.normals[b]).normalize_or(mesh.normals[a]));
    if let (Some(from), Some(to)) = (mesh.uvs.get(a), mesh.uvs.get(b)) {
        mesh.uvs.push((*from + *to) * 0.5);
    }
    if let (Some(from), Some(to)) = (mesh.opacities.get(a), mesh.opacities.get(b)) {
        mesh.opacities.push((*from + *to) * 0.5);
    }
    mesh.positions.len() as u32 - 1
}

/// The triangles that one becomes whose sides have these middles.
fn parts([a, b, c]: [u32; 3], [ab, bc, ca]: [Option<u32>; 3]) -> [Option<[u32; 3]>; 4] {
    match (ab, bc, ca) {
        (None, None, None) => [Some([a, b, c]), None, None, None],
        (Some(ab), Some(bc), Some(ca)) => [Some([a, ab, ca]), Some([ab, b, bc]), Some([ca, bc, c]), Some([ab, bc, ca])],
        // With one or two middles: turned until the side after the first corner has one, and the
        // one before it has none.
        (Some(ab), bc, None) => match bc {
            None => [Some([a, ab, c]), Some([ab, b, c]), None, None],
            Some(bc) => [Some([ab, b, bc]), Some([a, ab, bc]), Some([a, bc, c]), None],
        },
        _ => parts([b, c, a], [bc, ca, ab]),
    }
}

/// The area of a triangle, square metres.
pub(crate) fn area([a, b, c]: [Vec3; 3], world_from_mesh: DMat3) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| world_from_mesh * p.as_dvec3());
    0.5 * (b - a).cross(c - a).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::{mesh_check, primitive};

    #[test]
    fn edges_become_short_and_solids_stay_closed() {
        let stretched = DMat3::from_diagonal(glam::DVec3::new(3.0, 1.0, 0.5));
        for mesh in [primitive::cube(), primitive::cone(5, 1), primitive::torus(1.0, 0.3, 9, 5)] {
            let cut = tessellated(&mesh, stretched, 0.3, 100_000);
            let longest = cut.triangles().flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]).map(|(a, b)| {
                let at = |i: u32| stretched * cut.positions[i as usize].as_dvec3();
                (at(a) - at(b)).length()
            });
            assert!(longest.fold(0.0, f64::max) <= 0.3 + 1e-6, "{}", mesh.name);
            assert!(mesh_check::check(&cut).is_closed(), "{} has gaps", mesh.name);
            let areas = |m: &Mesh| m.triangles().map(|t| area(m.corners(t), stretched)).sum::<f64>();
            assert!((areas(&cut) / areas(&mesh) - 1.0).abs() < 1e-5, "{}", mesh.name);
        }
    }

    #[test]
    fn cutting_ends_at_the_budget_and_at_triangles_without_shape() {
        let few = tessellated(&primitive::plane(), DMat3::IDENTITY, 1e-3, 500);
        assert!(few.positions.len() > 100 && few.positions.len() <= 500, "{}", few.positions.len());
        let mut bad = primitive::plane();
        bad.positions.extend([Vec3::NAN, Vec3::INFINITY]);
        bad.indices.extend([0, 1, 4, 0, 5, 5, 7, 8, 9]);
        bad.normals.clear();
        let cut = tessellated(&bad, DMat3::IDENTITY, 0.5, 1000);
        assert_eq!(cut.normals.len(), cut.positions.len());
        assert_eq!(mesh_check::check(&cut).out_of_range_triangles, 0);
    }
}

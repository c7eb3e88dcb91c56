//! What is wrong with a mesh: open and non-manifold edges, degenerate and duplicate triangles.
//!
//! Shadow volumes need closed casters, and leaks often start at cracks; `umbrage info` shows these
//! numbers.

use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::weld::weld;
use glam::Vec3;
use std::ops::{Add, Mul};

/// Counts of what a mesh holds and what is wrong with it. Edges are those between **positions**:
/// vertices at exactly the same place are one, however their normals and texture coordinates
/// differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshReport {
    /// Triangles in all.
    pub triangles: usize,
    /// Vertices in all, as stored.
    pub vertices: usize,
    /// Different positions among the vertices.
    pub positions: usize,
    /// Edges that only one triangle uses: the rim of a hole.
    pub open_edges: usize,
    /// Edges that more than two triangles use.
    pub non_manifold_edges: usize,
    /// Edges whose two triangles run along them in the same direction: one of them is inside out.
    pub inconsistent_edges: usize,
    /// Triangles of no area. Where two corners coincide the edges are not counted; a triangle whose
    /// corners lie in a line may close a seam, so its edges are.
    pub degenerate_triangles: usize,
    /// Triangles between the same three positions as an earlier one, whichever way round.
    pub duplicate_triangles: usize,
    /// Vertices with a coordinate that is NaN or infinite.
    pub non_finite_vertices: usize,
    /// Triangles that name a vertex that does not exist; otherwise left out of the account.
    pub out_of_range_triangles: usize,
}

impl MeshReport {
    /// True where there are triangles and they bound a solid: every edge has one triangle on either
    /// side, wound alike.
    pub fn is_closed(&self) -> bool {
        self.triangles > 0
            && self.open_edges + self.non_manifold_edges + self.inconsistent_edges == 0
            && self.non_finite_vertices + self.out_of_range_triangles == 0
    }

    /// Every count put through `f` together with that of `other`.
    fn zip(self, other: Self, f: impl Fn(usize, usize) -> usize) -> Self {
        Self {
            triangles: f(self.triangles, other.triangles),
            vertices: f(self.vertices, other.vertices),
            positions: f(self.positions, other.positions),
            open_edges: f(self.open_edges, other.open_edges),
            non_manifold_edges: f(self.non_manifold_edges, other.non_manifold_edges),
            inconsistent_edges: f(self.inconsistent_edges, other.inconsistent_edges),
            degenerate_triangles: f(self.degenerate_triangles, other.degenerate_triangles),
            duplicate_triangles: f(self.duplicate_triangles, other.duplicate_triangles),
            non_finite_vertices: f(self.non_finite_vertices, other.non_finite_vertices),
            out_of_range_triangles: f(self.out_of_range_triangles, other.out_of_range_triangles),
        }
    }
}

impl Add for MeshReport {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Mul<usize> for MeshReport {
    type Output = Self;
    fn mul(self, times: usize) -> Self {
        self.zip(self, |a, _| a * times)
    }
}

impl std::iter::Sum for MeshReport {
    fn sum<I: Iterator<Item = Self>>(reports: I) -> Self {
        reports.fold(Self::default(), Add::add)
    }
}

/// Looks a mesh over. Any mesh will do, a broken one too.
pub fn check(mesh: &Mesh) -> MeshReport {
    let welded = weld(&mesh.positions);
    let in_range = |t: &[u32; 3]| t.iter().all(|&i| (i as usize) < mesh.positions.len());
    let kept: Vec<[u32; 3]> = mesh.triangles().filter(in_range).collect();
    let corners: Vec<[u32; 3]> = kept.iter().map(|t| t.map(|i| welded[i as usize])).collect();
    let [open_edges, non_manifold_edges, inconsistent_edges] = count_edges(&corners);
    MeshReport {
        triangles: mesh.triangle_count(),
        vertices: mesh.positions.len(),
        positions: welded.iter().zip(0..).filter(|(first, i)| *first == i).count(),
        open_edges,
        non_manifold_edges,
        inconsistent_edges,
        degenerate_triangles: kept.iter().filter(|t| has_no_area(mesh.corners(**t))).count(),
        duplicate_triangles: count_duplicates(&corners),
        non_finite_vertices: mesh.positions.iter().filter(|p| !p.is_finite()).count(),
        out_of_range_triangles: mesh.triangle_count() - kept.len(),
    }
}

/// Looks all meshes of a scene over, each counted as often as it is placed. Where instances touch
/// or overlap is their own affair: no edge joins two of them.
pub fn check_scene(scene: &Scene) -> MeshReport {
    let mut placed = vec![0; scene.meshes.len()];
    for instance in &scene.instances {
        placed[instance.mesh] += 1;
    }
    scene.meshes.iter().zip(placed).filter(|(_, n)| *n > 0).map(|(mesh, n)| check(mesh) * n).sum()
}

/// How many edges are open, non-manifold and inconsistently wound.
fn count_edges(triangles: &[[u32; 3]]) -> [usize; 3] {
    let mut edges: Vec<(u32, u32, bool)> = Vec::with_capacity(3 * triangles.len());
    for &[a, b, c] in triangles.iter().filter(|[a, b, c]| a != b && b != c && c != a) {
        edges.extend([(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b), a < b)));
    }
    edges.sort_unstable();
    let mut counts = [0; 3];
    for uses in edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        match uses {
            [_] => counts[0] += 1,
            [x, y] => counts[2] += usize::from(x.2 == y.2),
            _ => counts[1] += 1,
        }
    }
    counts
}

fn count_duplicates(triangles: &[[u32; 3]]) -> usize {
    let mut sorted = triangles.to_vec();
    sorted.iter_mut().for_each(|t| t.sort_unstable());
    sorted.sort_unstable();
    sorted.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

/// The differences and products of single-precision numbers are next to exact in double precision,
/// so this finds corners in a line and no thin triangle that is none.
fn has_no_area(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    (b - a).cross(c - a).length_squared() == 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitive;
    use glam::DAffine3;

    #[test]
    fn primitives_are_closed_but_for_the_plane() {
        for mesh in [
            primitive::cube(),
            primitive::sphere(16, 8),
            primitive::cylinder(16, 3),
            primitive::cone(16, 3),
            primitive::torus(1.0, 0.3, 16, 8),
        ] {
            let report = check(&mesh);
            assert!(report.is_closed() && report.degenerate_triangles == 0, "{}: {report:?}", mesh.name);
            // Euler: V − E + F is 2, and 0 for the torus; every triangle has one and a half edges.
            let want = if mesh.name == "torus" { 0 } else { 2 };
            assert_eq!(report.positions as i64 - report.triangles as i64 / 2, want, "{}: {report:?}", mesh.name);
        }
        let plane = check(&primitive::plane());
        assert_eq!((plane.open_edges, plane.is_closed()), (4, false));
    }

    #[test]
    fn a_crack_opens_the_edges_along_it() {
        let mut cube = primitive::cube();
        // One corner of the first face moved by the last bit: that face's two edges there come
        // apart from the others'. The diagonal is the face's own.
        cube.positions[1].x = cube.positions[1].x.next_up();
        let report = check(&cube);
        assert_eq!((report.open_edges, report.positions), (4, 9), "{report:?}");
        assert!(!report.is_closed());
    }

    #[test]
    fn a_missing_triangle_leaves_three_open_edges() {
        let mut sphere = primitive::sphere(16, 8);
        sphere.indices.drain(60..63);
        let report = check(&sphere);
        assert_eq!((report.open_edges, report.non_manifold_edges), (3, 0), "{report:?}");
    }

    #[test]
    fn a_doubled_triangle_is_a_duplicate_whichever_way_round() {
        for order in [[0, 1, 2], [1, 2, 0], [2, 1, 0]] {
            let mut cube = primitive::cube();
            cube.indices.extend(order);
            let report = check(&cube);
            assert_eq!((report.duplicate_triangles, report.non_manifold_edges), (1, 3), "{order:?}: {report:?}");
            assert!(!report.is_closed());
        }
    }

    #[test]
    fn a_turned_triangle_is_inconsistent_with_its_three_neighbours() {
        let mut cube = primitive::cube();
        cube.indices.swap(0, 1);
        let report = check(&cube);
        assert_eq!((report.inconsistent_edges, report.open_edges), (3, 0), "{report:?}");
        assert!(!report.is_closed());
    }

    #[test]
    fn triangles_without_area_are_found() {
        let mut cube = primitive::cube();
        cube.indices.extend([0, 0, 1]);
        let report = check(&cube);
        assert_eq!(report.degenerate_triangles, 1);
        assert!(report.is_closed(), "two equal corners add no edge: {report:?}");
        let line = Mesh {
            positions: vec![Vec3::ZERO, Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.2, 0.4, 0.6)],
            indices: vec![0, 1, 2],
            ..Mesh::default()
        };
        assert_eq!((check(&line).degenerate_triangles, check(&line).open_edges), (1, 3));
        let thin = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(0.5, 1e-20, 0.0)], ..line };
        assert_eq!(check(&thin).degenerate_triangles, 0);
    }

    #[test]
    fn broken_numbers_and_indices_are_counted() {
        let mut cube = primitive::cube();
        cube.positions[3].y = f32::NAN;
        cube.positions[4].z = f32::INFINITY;
        cube.indices[35] = 24;
        let report = check(&cube);
        assert_eq!((report.non_finite_vertices, report.out_of_range_triangles, report.triangles), (2, 1, 12));
        assert!(!report.is_closed());
    }

    #[test]
    fn nothing_is_not_closed() {
        assert_eq!(check(&Mesh::default()), MeshReport::default());
        assert!(!MeshReport::default().is_closed());
    }

    #[test]
    fn minus_zero_is_zero() {
        let mut plane = primitive::plane();
        plane.append(&primitive::plane());
        plane.positions[4..].iter_mut().for_each(|p| p.y = -0.0);
        assert_eq!(check(&plane).positions, 4);
    }

    #[test]
    fn a_scene_counts_what_is_placed() {
        let mut scene = Scene::default();
        let plane = scene.add_mesh(primitive::plane());
        let cube = scene.add_mesh(primitive::cube());
        scene.add_mesh(primitive::sphere(8, 8));
        for mesh in [plane, plane, cube] {
            scene.place(mesh, 0, DAffine3::IDENTITY);
        }
        let report = check_scene(&scene);
        assert_eq!((report.triangles, report.open_edges), (scene.triangle_count(), 8));
    }
}

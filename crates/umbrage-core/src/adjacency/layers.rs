//! How many triangles can lie behind one another.

use super::{Edge, NONE};
use crate::bounds::Bounds;
use glam::DVec3;
use std::f64::consts::PI;

/// The sum over all parts that edges hold together; see [`super::Adjacency::layers`]. A part that
/// is not `rigid` may be convex now and not later.
pub(super) fn count(corners: &[[DVec3; 3]], edges: &[Edge], rigid: bool) -> u32 {
    let is_closed = edges.iter().all(Edge::is_balanced);
    let mut roots = Roots::of(corners.len(), edges);
    let triangles = sorted((0..corners.len() as u32).map(|t| (roots.find(t), t)));
    let edge_numbers = sorted(edges.iter().zip(0..).map(|(e, i)| (roots.find(e.triangles[0]), i)));
    let same = |a: &(u32, u32), b: &(u32, u32)| a.0 == b.0;
    // Every part has triangles and edges, so that the two lists go from part to part in step.
    let parts = triangles.chunk_by(same).zip(edge_numbers.chunk_by(same));
    let layers = parts.map(|(triangles, part_edges)| {
        let part_edges = || part_edges.iter().map(|(_, i)| &edges[*i as usize]);
        let is_convex = rigid && part_edges().all(Edge::is_balanced) && is_convex(corners, triangles, part_edges());
        let every = triangles.len() as u64;
        match (is_convex, is_closed) {
            (true, true) => 1,
            (true, false) => 2,
            (false, true) => every.div_ceil(2),
            (false, false) => every,
        }
    });
    u32::try_from(layers.sum::<u64>()).unwrap_or(u32::MAX)
}

fn sorted(pairs: impl Iterator<Item = (u32, u32)>) -> Vec<(u32, u32)> {
    let mut sorted: Vec<_> = pairs.collect();
    sorted.sort_unstable();
    sorted
}

/// Sets of triangles that edges join (union–find); each is named by one of its own.
struct Roots(Vec<u32>);

impl Roots {
    fn of(triangles: usize, edges: &[Edge]) -> Self {
        let mut roots = Self((0..triangles as u32).collect());
        for edge in edges.iter().filter(|e| e.triangles[1] != NONE) {
            roots.join(edge.triangles[0], edge.triangles[1]);
        }
        // Records of one edge stand side by side.
        for pair in edges.windows(2).filter(|pair| pair[0].is_at(&pair[1])) {
            roots.join(pair[0].triangles[0], pair[1].triangles[0]);
        }
        roots
    }

    fn find(&mut self, mut triangle: u32) -> u32 {
        while self.0[triangle as usize] != triangle {
            // Halving the way on the way.
            let next = self.0[triangle as usize];
            self.0[triangle as usize] = self.0[next as usize];
            triangle = self.0[triangle as usize];
        }
        triangle
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

/// True where a closed part is the surface of a convex body, the rounding of its vertices aside.
///
/// The middle is under every triangle and seen from there they cover every direction once; no
/// neighbour rises above a triangle, and none of some dozens of vertices all over the part. Without
/// the last a dish of very many triangles would pass, flat at every single edge.
fn is_convex<'a>(corners: &[[DVec3; 3]], triangles: &[(u32, u32)], mut edges: impl Iterator<Item = &'a Edge>) -> bool {
    let corners_of = |t: u32| corners[t as usize];
    let all = || triangles.iter().flat_map(|(_, t)| corners_of(*t));
    let middle = all().sum::<DVec3>() / (3 * triangles.len()) as f64;
    let covered: f64 = triangles.iter().map(|(_, t)| solid_angle(corners_of(*t).map(|p| p - middle))).sum();
    if (covered.abs() - 4.0 * PI).abs() > PI {
        return false;
    }
    let bounds = Bounds::of(all());
    // Each coordinate is off by half a unit in the last place, of the corners of the triangle and
    // the vertex above.
    let rounding = 4.0 * 2f64.powi(-24) * bounds.largest_coordinate();
    let top = |t: u32| Top::of(corners_of(t), covered.signum(), rounding);
    let spread: Vec<DVec3> = all().step_by((3 * triangles.len()).div_ceil(64)).collect();
    edges.all(|e| {
        let [a, b] = e.triangles;
        top(a).is_above(&corners_of(b)) && top(b).is_above(&corners_of(a))
    }) && triangles.iter().map(|(_, t)| top(*t)).all(|top| top.is_clear_of(middle) && top.is_above(&spread))
}

/// Signed solid angle of a triangle from the origin, positive where it shows its back.
/// Van Oosterom, Strackee, "The Solid Angle of a Plane Triangle", 1983, equation 8.
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    2.0 * a.dot(b.cross(c)).atan2(la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la)
}

/// The outer side of a triangle of a body.
struct Top {
    corner: DVec3,
    /// Unit length; zero where the triangle has no area.
    normal: DVec3,
    /// How much a vertex may seem to rise above the plane, and how much more for every metre of
    /// distance.
    rounding: f64,
    tilt: f64,
}

impl Top {
    fn of([a, b, c]: [DVec3; 3], outwards: f64, rounding: f64) -> Self {
        let normal = (b - a).cross(c - a);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        // The lowest height of the triangle is what holds its plane against tilting. With 1 or
        // more, as for a triangle without area, the plane says nothing.
        let tilt = (rounding * longest / normal.length()).min(1.0);
        Self { corner: a, normal: normal.normalize_or_zero() * outwards, rounding, tilt }
    }

    fn is_clear_of(&self, middle: DVec3) -> bool {
        self.tilt == 1.0 || self.normal.dot(middle - self.corner) < -self.rounding
    }

    fn is_above(&self, points: &[DVec3]) -> bool {
        points.iter().all(|p| {
            let way = *p - self.corner;
            self.normal.dot(way) <= self.rounding + self.tilt * way.length()
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::adjacency::Adjacency;
    use crate::mesh::Mesh;
    use crate::primitive;
    use glam::{DAffine3, DMat3, DVec3, Vec3};

    fn layers(mesh: &Mesh) -> u32 {
        Adjacency::of(mesh).layers
    }

    /// The first mesh and, away from it, the second.
    fn both(mut mesh: Mesh, other: &Mesh) -> Mesh {
        mesh.append(&other.transformed(&DAffine3::from_translation(DVec3::new(3.0, 4.0, 5.0))));
        mesh
    }

    #[test]
    fn convex_parts_count_once_in_a_closed_mesh_and_twice_in_an_open_one() {
        let cube = primitive::cube();
        let mut two = cube.clone();
        for (mesh, want) in [(&cube, 2), (&primitive::sphere(16, 8), 3), (&primitive::cone(12, 3), 4)] {
            two = both(two, mesh);
            assert_eq!(layers(&two), want);
            two = two.transformed(&DAffine3::from_translation(DVec3::new(3.0, 4.0, 5.0)));
        }
        let plane = primitive::plane();
        assert_eq!((layers(&plane), layers(&both(cube, &plane))), (2, 4));
        assert_eq!(layers(&Mesh::default()), 0);
    }

    #[test]
    fn rounding_leaves_convex_what_is() {
        for mesh in [
            primitive::cube(),
            primitive::sphere(256, 128),
            primitive::sphere(400, 5),
            primitive::cylinder(100, 40),
            primitive::cone(64, 16),
        ] {
            for (size, place) in [(1.0, 0.0), (1e-3, 0.0), (1e3, 1e5), (1.0, 100.0)] {
                let turned = DMat3::from_rotation_z(0.3) * DMat3::from_rotation_x(0.4);
                let shape = turned * DMat3::from_diagonal(DVec3::new(0.3, 1.0, 2.0) * size);
                let moved = mesh.transformed(&DAffine3::from_mat3_translation(shape, DVec3::splat(place)));
                assert_eq!(layers(&moved), 1, "{} of size {size} at {place}", mesh.name);
            }
        }
    }

    #[test]
    fn a_body_inside_out_is_as_convex() {
        let mut mesh = primitive::sphere(12, 6);
        mesh.indices.as_chunks_mut::<3>().0.iter_mut().for_each(|t| t.swap(0, 1));
        assert_eq!(layers(&mesh), 1);
    }

    #[test]
    fn of_other_bodies_every_second_triangle_counts() {
        let torus = primitive::torus(1.0, 0.3, 16, 8);
        assert_eq!(layers(&torus), 128);
        assert_eq!(layers(&both(torus, &primitive::cube())), 129);
        let mut dented = primitive::sphere(16, 8);
        dented.positions.iter_mut().filter(|p| p.y > 0.99).for_each(|p| p.y = 0.9);
        assert_eq!(layers(&dented), 112);
    }

    #[test]
    fn a_doubled_body_is_not_convex() {
        let mut cube = primitive::cube();
        cube.append(&primitive::cube());
        assert_eq!(layers(&cube), 12);
    }

    #[test]
    fn flat_bodies_are_not_convex() {
        // Both sides of a sheet, and of another upon it. How much of the sky they cover seen from
        // within is a matter of rounding; here it comes out as all of it, once.
        let sheets = Mesh {
            positions: vec![Vec3::ZERO, Vec3::new(1.0, 0.33333334, -0.6666667), Vec3::new(-0.8233408, 0.25926557, 0.0)],
            indices: vec![0, 1, 2, 1, 0, 2, 2, 0, 1, 1, 0, 2],
            ..Mesh::default()
        };
        assert_eq!(layers(&sheets), 2);
    }

    #[test]
    fn a_shallow_dish_is_not_flat() {
        // At every single edge it is, for its vertices are far from the origin and rounded.
        let mut dish = primitive::sphere(256, 128);
        dish.positions.iter_mut().filter(|p| p.y > 0.0).for_each(|p| p.y = -0.1 * (1.0 - p.x * p.x - p.z * p.z));
        dish.positions.iter_mut().for_each(|p| *p += Vec3::splat(300.0));
        assert_eq!(layers(&dish), 256 * 127);
    }

    #[test]
    fn of_open_and_inconsistent_parts_every_triangle_counts() {
        let mut cube = primitive::cube();
        cube.indices.swap(0, 1);
        assert_eq!(layers(&cube), 12);
        cube.indices.drain(..3);
        assert_eq!(layers(&cube), 11);
    }

    #[test]
    fn a_part_is_what_edges_join_not_corners() {
        let mut cube = primitive::cube();
        let touching = DAffine3::from_translation(DVec3::ONE);
        cube.append(&primitive::cube().transformed(&touching));
        assert_eq!(layers(&cube), 2);
        // Three fins at one edge are one part, whichever way they are paired.
        let fins = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_Z],
            indices: vec![0, 1, 2, 0, 1, 3, 0, 1, 4],
            ..Mesh::default()
        };
        assert_eq!(layers(&fins), 3);
    }
}

//! Silhouettes: the edges that bound a mesh's shadow, and the triangles that cast it.
//!
//! Every triangle that casts is taken **turned to the light**, whichever way it is wound. The edges
//! of all of them, those cancelled that two run along in opposite directions, are the **contour**.
//! It is the boundary of a sum of triangles and so it is a cycle: as many of its edges enter a
//! vertex as leave it, for any triangles and wherever a triangle is said to face. Drawn away from
//! the light it makes the sides of a shadow volume that is closed without exception.

use crate::adjacency::{Adjacency, Edge, NONE};
use glam::{DAffine3, DVec3, DVec4, Vec4};

/// Which triangles cast the shadow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// All of them. Right for any mesh, light and point.
    All,
    /// Those that face away from the light. Right for a closed mesh where light and points are
    /// outside its bounds, and half the number of sides.
    Away,
}

/// +1 where the light is in front of the plane or in it, −1 behind. `light` is homogeneous, in mesh
/// space relative to [`Adjacency::center`], see [`light_in_mesh`]. A triangle without area, its
/// plane zero, faces every light.
pub fn facing(plane: Vec4, light: Vec4) -> i32 {
    // In this order and precision, as shaders do it.
    if plane.x * light.x + plane.y * light.y + plane.z * light.z + plane.w * light.w >= 0.0 { 1 } else { -1 }
}

/// How often the edge is in the contour, −2…2: from `vertices[0]` to `vertices[1]` where positive,
/// back where negative.
pub fn multiplicity(edge: &Edge, planes: &[Vec4], light: Vec4, rule: Rule) -> i32 {
    // A triangle that faces away and is turned to the light runs along its edges backwards.
    let along = |triangle: u32| match (facing(planes[triangle as usize], light), rule) {
        (1, Rule::Away) => 0,
        (facing, _) => facing,
    };
    let [first, second] = edge.triangles;
    match (second, edge.same_direction) {
        (NONE, _) => along(first),
        (_, true) => along(first) + along(second),
        (_, false) => along(first) - along(second),
    }
}

/// An edge of the contour. It runs with the triangle that casts the shadow on its left, seen from
/// the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContourEdge {
    /// Index into [`crate::Mesh::positions`] of its start, of all vertices at the same place the
    /// first.
    pub from: u32,
    /// The same of its end.
    pub to: u32,
    /// How many surfaces end here, 1 or 2.
    pub times: u32,
    /// Index into [`Adjacency::edges`].
    pub edge: u32,
}

/// Appends the contour to `into`, in the order of [`Adjacency::edges`].
pub fn contour(adjacency: &Adjacency, light: Vec4, rule: Rule, into: &mut Vec<ContourEdge>) {
    for (edge, number) in adjacency.edges.iter().zip(0..) {
        let [a, b] = edge.vertices;
        let signed = multiplicity(edge, &adjacency.planes, light, rule);
        let (from, to) = if signed > 0 { (a, b) } else { (b, a) };
        if signed != 0 {
            into.push(ContourEdge { from, to, times: signed.unsigned_abs(), edge: number });
        }
    }
}

/// The triangles that cast the shadow under `rule`, each counter-clockwise seen from the light.
pub fn light_cap(adjacency: &Adjacency, light: Vec4, rule: Rule) -> impl Iterator<Item = [u32; 3]> {
    adjacency.triangles.iter().zip(&adjacency.planes).filter_map(move |(&[a, b, c], &plane)| {
        match (facing(plane, light), rule) {
            (1, Rule::All) => Some([a, b, c]),
            (1, Rule::Away) => None,
            _ => Some([a, c, b]),
        }
    })
}

/// Splits a contour into closed walks that together use every edge as often as its `times` says. A
/// walk visits no vertex twice; it lists vertices in order and returns from the last to the first.
pub fn loops(contour: &[ContourEdge]) -> Vec<Vec<u32>> {
    let mut ways = Ways::of(contour);
    let mut loops = Vec::new();
    for start in 0..ways.vertices.len() {
        ways.walk(start, &mut loops);
    }
    loops
}

/// The edges of a contour on the way to be walked.
struct Ways {
    /// Vertices that edges leave, ascending. What follows goes by places in this list.
    vertices: Vec<u32>,
    /// For every vertex the ends of edges that still leave it.
    exits: Vec<Vec<usize>>,
    /// For every vertex, where on the current path it is.
    on_path: Vec<Option<usize>>,
}

impl Ways {
    fn of(contour: &[ContourEdge]) -> Self {
        let mut vertices: Vec<u32> = contour.iter().map(|e| e.from).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut exits = vec![Vec::new(); vertices.len()];
        for e in contour {
            // In a cycle each end is a start, too.
            if let (Ok(from), Ok(to)) = (vertices.binary_search(&e.from), vertices.binary_search(&e.to)) {
                exits[from].extend((0..e.times).map(|_| to));
            }
        }
        Self { on_path: vec![None; vertices.len()], vertices, exits }
    }

    /// Follows edges from `start` until none leaves it any more. Wherever the path meets itself, a
    /// loop is cut off.
    fn walk(&mut self, start: usize, loops: &mut Vec<Vec<u32>>) {
        let mut path = vec![start];
        self.on_path[start] = Some(0);
        while let Some(next) = path.last().and_then(|&v| self.exits[v].pop()) {
            if let Some(met) = self.on_path[next] {
                loops.push(path[met..].iter().map(|&v| self.vertices[v]).collect());
                path.drain(met + 1..).for_each(|v| self.on_path[v] = None);
            } else {
                self.on_path[next] = Some(path.len());
                path.push(next);
            }
        }
        // Of a cycle only the start is left.
        path.iter().for_each(|&v| self.on_path[v] = None);
    }
}

/// A light as [`facing`] takes it. `light` is homogeneous in world space: a point with w = 1, or
/// with w = 0 the direction to the light.
pub fn light_in_mesh(light: DVec4, mesh_from_world: &DAffine3, mesh_center: DVec3) -> Vec4 {
    let place = light.truncate();
    if light.w == 0.0 {
        mesh_from_world.transform_vector3(place).normalize_or_zero().extend(0.0).as_vec4()
    } else {
        (mesh_from_world.transform_point3(place) - mesh_center).extend(1.0).as_vec4()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adjacency::tests::{mesh, moebius};
    use crate::{Mesh, primitive};
    use glam::{DMat3, DQuat, Vec3};
    use std::collections::BTreeMap;

    const RULES: [Rule; 2] = [Rule::All, Rule::Away];

    /// The contour, after a look whether it is the boundary of the light caps.
    fn checked(adjacency: &Adjacency, light: Vec4, rule: Rule) -> Vec<ContourEdge> {
        let mut found = Vec::new();
        contour(adjacency, light, rule, &mut found);
        let mut sums = BTreeMap::<[u32; 2], i32>::new();
        let mut add = |a: u32, b: u32, times: i32| {
            *sums.entry([a.min(b), a.max(b)]).or_default() += if a < b { times } else { -times };
        };
        for [a, b, c] in light_cap(adjacency, light, rule) {
            [(a, b), (b, c), (c, a)].into_iter().for_each(|(a, b)| add(a, b, 1));
        }
        found.iter().for_each(|e| add(e.from, e.to, -(e.times as i32)));
        assert!(sums.values().all(|sum| *sum == 0), "{rule:?}, light {light}: {found:?}");
        check_loops(&found);
        found
    }

    /// Loops use every edge as often as it says, and visit no vertex twice.
    fn check_loops(contour: &[ContourEdge]) {
        let mut want: Vec<_> =
            contour.iter().flat_map(|e| std::iter::repeat_n((e.from, e.to), e.times as usize)).collect();
        let loops = loops(contour);
        let after = |l: &[u32], k: usize| l[(k + 1) % l.len()];
        let mut got: Vec<_> = loops.iter().flat_map(|l| (0..l.len()).map(|k| (l[k], after(l, k)))).collect();
        want.sort_unstable();
        got.sort_unstable();
        assert_eq!(got, want);
        for l in &loops {
            let mut visited = l.clone();
            visited.sort_unstable();
            visited.dedup();
            assert!(visited.len() == l.len() && l.len() > 1, "{l:?}");
        }
    }

    /// How many edges the contour has, how often each counts (0 where that differs), and how many
    /// loops it makes.
    fn shape(adjacency: &Adjacency, light: Vec4, rule: Rule) -> (usize, u32, usize) {
        let contour = checked(adjacency, light, rule);
        let times = contour.first().map_or(0, |e| e.times);
        let is_even = contour.iter().all(|e| e.times == times);
        (contour.len(), if is_even { times } else { 0 }, loops(&contour).len())
    }

    fn lights() -> Vec<Vec4> {
        let ways = (0..40).map(|i| {
            let (height, angle) = ((i as f32 + 0.5) / 20.0 - 1.0, i as f32 * 2.4);
            let flat = (1.0 - height * height).sqrt();
            Vec3::new(flat * angle.cos(), height, flat * angle.sin())
        });
        ways.flat_map(|way| [way.extend(0.0), (way * 3.0).extend(1.0), (way * 0.2).extend(1.0)]).collect()
    }

    #[test]
    fn a_cube_has_six_edges_around_it_and_four_from_straight_over_a_face() {
        let cube = Adjacency::of(&primitive::cube());
        for light in [Vec4::new(1.0, 2.0, 3.0, 0.0), Vec4::new(-3.0, 2.0, 4.0, 1.0)] {
            assert_eq!(shape(&cube, light, Rule::Away), (6, 1, 1));
            assert_eq!(shape(&cube, light, Rule::All), (6, 2, 2));
        }
        for light in [Vec4::new(0.0, 5.0, 0.0, 1.0), Vec4::new(0.1, -5.0, 0.2, 1.0), Vec4::X] {
            assert_eq!(shape(&cube, light, Rule::Away), (4, 1, 1));
            assert_eq!(shape(&cube, light, Rule::All), (4, 2, 2));
        }
    }

    #[test]
    fn a_light_within_a_closed_body_sees_no_contour() {
        let cube = Adjacency::of(&primitive::cube());
        let light = Vec4::new(0.1, 0.2, -0.3, 1.0);
        assert_eq!(shape(&cube, light, Rule::All), (0, 0, 0));
        assert_eq!(light_cap(&cube, light, Rule::All).count(), 12);
        assert_eq!(light_cap(&cube, light, Rule::Away).count(), 12, "walls show their backs to what is inside");
    }

    #[test]
    fn a_torus_from_above_has_two_loops() {
        let torus = Adjacency::of(&primitive::torus(1.0, 0.3, 16, 8));
        for light in [Vec4::Y, Vec4::new(0.01, 5.0, 0.02, 1.0)] {
            assert_eq!(shape(&torus, light, Rule::Away), (32, 1, 2));
        }
    }

    #[test]
    fn a_plane_has_its_four_sides_for_any_light() {
        let plane = Adjacency::of(&primitive::plane());
        for light in lights() {
            assert_eq!(shape(&plane, light, Rule::All), (4, 1, 1));
        }
    }

    #[test]
    fn a_triangle_is_turned_to_the_light() {
        let triangle = Adjacency::of(&mesh(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]));
        let ways = |light| loops(&checked(&triangle, light, Rule::All));
        assert_eq!(ways(Vec4::Z), [[0, 1, 2]]);
        assert_eq!(ways(Vec4::NEG_Z), [[0, 2, 1]]);
        assert!(checked(&triangle, Vec4::Z, Rule::Away).is_empty());
        assert_eq!(loops(&checked(&triangle, Vec4::NEG_Z, Rule::Away)), [[0, 2, 1]]);
        assert_eq!(light_cap(&triangle, Vec4::NEG_Z, Rule::All).collect::<Vec<_>>(), [[0, 2, 1]]);
        // In the plane of the triangle the light is in front.
        assert_eq!((facing(triangle.planes[0], Vec4::X), facing(Vec4::ZERO, Vec4::W)), (1, 1));
    }

    #[test]
    fn two_triangles_at_one_place_throw_two_shadows_whichever_way_round() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
        for second in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
            let twice = Adjacency::of(&mesh(&positions, &[[0, 1, 2], second]));
            for light in [Vec4::Z, Vec4::NEG_Z, Vec4::new(9.0, 9.0, -1.0, 1.0)] {
                assert_eq!(shape(&twice, light, Rule::All), (3, 2, 2), "{second:?}");
            }
        }
    }

    #[test]
    fn three_fins_count_as_they_are_seen() {
        // At 0, 120 and 240 degrees around Z.
        let positions = [Vec3::ZERO, Vec3::Z, Vec3::X, Vec3::new(-0.5, 0.866, 0.0), Vec3::new(-0.5, -0.866, 0.0)];
        let fins = Adjacency::of(&mesh(&positions, &[[0, 1, 2], [0, 1, 3], [0, 1, 4]]));
        // A fin up to 180 degrees clockwise of the light runs along the edge from 0 to 1, any other
        // back.
        for (light, want) in [(Vec4::Y, -1), (Vec4::new(1.0, 1.0, 0.0, 0.0), 1), (Vec4::NEG_Y, 1)] {
            let contour = checked(&fins, light, Rule::All);
            let middle = contour.iter().filter(|e| e.from < 2 && e.to < 2);
            let sum: i32 = middle.map(|e| if e.from == 0 { e.times as i32 } else { -(e.times as i32) }).sum();
            assert_eq!(sum, want, "{light}: {contour:?}");
        }
    }

    #[test]
    fn contours_are_cycles_for_any_mesh_and_light() {
        let mut turned = primitive::cube();
        turned.indices.swap(0, 1);
        let mut cracked = primitive::cube();
        cracked.positions[1].x = cracked.positions[1].x.next_up();
        let mut broken = primitive::sphere(8, 6);
        broken.positions[12] = Vec3::NAN;
        let mut doubled = primitive::torus(1.0, 0.4, 9, 7);
        doubled.append(&primitive::torus(1.0, 0.4, 9, 7));
        doubled.indices.drain(30..60);
        for mesh in [turned, cracked, broken, doubled, moebius(), Mesh::default()] {
            let adjacency = Adjacency::of(&mesh);
            for light in lights() {
                RULES.iter().for_each(|rule| drop(checked(&adjacency, light, *rule)));
            }
        }
    }

    #[test]
    fn winding_does_not_matter_where_all_triangles_throw() {
        let mut turned = primitive::cube();
        turned.indices.swap(0, 1);
        turned.indices.swap(18, 20);
        let (cube, turned) = (Adjacency::of(&primitive::cube()), Adjacency::of(&turned));
        let ends = |adjacency: &Adjacency, light| {
            let contour = checked(adjacency, light, Rule::All);
            let mut ends: Vec<_> = contour.iter().map(|e| (e.from, e.to, e.times)).collect();
            ends.sort_unstable();
            ends
        };
        for light in lights() {
            assert_eq!(ends(&cube, light), ends(&turned, light));
        }
    }

    #[test]
    fn loops_of_what_is_no_cycle_end() {
        let edge = |from, to| ContourEdge { from, to, times: 2, edge: 0 };
        assert!(loops(&[edge(0, 1), edge(2, 2), edge(1, 7)]).iter().all(|l| l == &[2]));
        assert!(loops(&[]).is_empty());
    }

    #[test]
    fn a_figure_of_eight_is_two_loops() {
        let edge = |from, to| ContourEdge { from, to, times: 1, edge: 0 };
        let mut eight = loops(&[edge(0, 1), edge(1, 2), edge(2, 0), edge(2, 3), edge(3, 4), edge(4, 2)]);
        eight.sort_unstable();
        assert_eq!(eight.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3]);
    }

    #[test]
    fn lights_come_into_the_mesh_however_far_it_is_from_the_origin() {
        let rotation = DMat3::from_quat(DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2));
        let place = DVec3::new(1e7, -2e7, 3e7);
        let mesh_from_world = DAffine3::from_mat3_translation(rotation * 2.0, place).inverse();
        let center = DVec3::new(0.0, 0.0, 4.0);
        let point = light_in_mesh((place + DVec3::new(0.0, 6.0, 10.0)).extend(1.0), &mesh_from_world, center);
        assert!((point - Vec4::new(3.0, 0.0, 1.0, 1.0)).length() < 1e-6, "{point}");
        let direction = light_in_mesh(DVec4::new(0.0, 5.0, 0.0, 0.0), &mesh_from_world, center);
        assert!((direction - Vec4::X).length() < 1e-6, "{direction}");
        assert_eq!(light_in_mesh(DVec4::ZERO, &mesh_from_world, center), Vec4::ZERO);
    }
}

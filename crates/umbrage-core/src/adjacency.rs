//! Which triangles meet at which edge: what silhouettes and shadow volumes are found from.
//!
//! Any triangles will do: open, non-manifold, doubled, wound this way and that.

mod layers;
mod order;

use crate::bounds::Bounds;
use crate::mesh::Mesh;
use crate::weld::weld_mesh;
use glam::{DVec3, DVec4, Vec4};

/// No second triangle.
pub const NONE: u32 = u32::MAX;

/// An edge between two positions, with one or two of the triangles at it. Where more than two
/// triangles meet there are several of them: first pairs that run in opposite directions, then
/// pairs that run alike, then a single triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Indices into [`Mesh::positions`], of all vertices at the same place the first.
    pub vertices: [u32; 2],
    /// Indices into [`Adjacency::triangles`]. The first triangle runs along the edge from
    /// `vertices[0]` to `vertices[1]`; the second may be [`NONE`].
    pub triangles: [u32; 2],
    /// True where the second triangle runs along the edge in the direction of the first: one of
    /// them is inside out. False where there is no second.
    pub same_direction: bool,
}

impl Edge {
    /// True where the two triangles run along it in opposite directions.
    pub fn is_balanced(&self) -> bool {
        self.triangles[1] != NONE && !self.same_direction
    }

    /// True where both are between the same positions.
    fn is_at(&self, other: &Self) -> bool {
        let [a, b] = other.vertices;
        self.vertices == [a, b] || self.vertices == [b, a]
    }
}

/// The triangles of a mesh, their planes and what joins them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Adjacency {
    /// Indices into [`Mesh::positions`], of all vertices at the same place the first. Triangles
    /// with a corner that does not exist or is not finite and those with two corners at one place
    /// are left out. Those whose corners lie in a line stay: they close seams.
    pub triangles: Vec<[u32; 3]>,
    /// Which triangle of the mesh each of them is, rising.
    pub numbers: Vec<u32>,
    /// Every edge of every triangle is in exactly one of them. Neighbours in space are mostly
    /// neighbours here.
    pub edges: Vec<Edge>,
    /// One a triangle, a unit normal n and an offset w: n · (p − `center`) + w is positive in
    /// front. All zero for a triangle without area. Computed in double precision.
    pub planes: Vec<Vec4>,
    /// The middle of the box around the triangles.
    pub center: DVec3,
    /// True where at every edge as many triangles run one way as the other; for no triangles too.
    /// As many triangles then show their front as their back along any line between two points
    /// outside the box, whichever the shape.
    pub is_closed: bool,
    /// Share of the edges, 0…1, that keep it from being closed: holes, borders, and triangles wound
    /// against their neighbours.
    pub open_share: f64,
    /// Length of the sum of all triangles' areas as vectors over the sum of their lengths, 0…1: 0
    /// for a closed mesh, 1 for a flat one.
    pub flatness: f64,
    /// No more triangles than this that face away from the light (for meshes that are not closed:
    /// triangles) lie on any line that starts at a light outside the box. Convex parts, up to the
    /// rounding of their vertices, count once (twice), of others every second (every) triangle. Of
    /// a mesh with joints no part is taken for convex.
    pub layers: u32,
    /// Length of the longest edge, in units of the mesh.
    pub longest_edge: f64,
}

impl Adjacency {
    /// Looks a mesh over. Any mesh will do, a broken one too.
    pub fn of(mesh: &Mesh) -> Self {
        let (numbers, triangles): (Vec<u32>, Vec<[u32; 3]>) = welded_triangles(mesh).into_iter().unzip();
        let mut edges = edges(&triangles);
        let position = |i: u32| mesh.positions[i as usize].as_dvec3();
        let corners: Vec<[DVec3; 3]> = triangles.iter().map(|t| t.map(position)).collect();
        let center = Bounds::of(corners.iter().flatten().copied()).center();
        let layers = layers::count(&corners, &edges, mesh.weights.is_empty());
        order::sort_by_place(&mut edges, |e| (position(e.vertices[0]) + position(e.vertices[1])) * 0.5);
        let length_squared = |e: &Edge| position(e.vertices[0]).distance_squared(position(e.vertices[1]));
        Self {
            is_closed: edges.iter().all(Edge::is_balanced),
            open_share: edges.iter().filter(|e| !e.is_balanced()).count() as f64 / edges.len().max(1) as f64,
            flatness: flatness(&corners),
            layers,
            longest_edge: edges.iter().map(length_squared).fold(0.0, f64::max).sqrt(),
            planes: planes(&triangles, mesh, center).collect(),
            center,
            triangles,
            numbers,
            edges,
        }
    }
}

impl Adjacency {
    /// [`Adjacency::planes`] of the mesh in another pose, about the same centre.
    pub fn planes_in(&self, posed: &Mesh) -> Vec<Vec4> {
        planes(&self.triangles, posed, self.center).collect()
    }
}

fn flatness(corners: &[[DVec3; 3]]) -> f64 {
    let areas = corners.iter().map(|[a, b, c]| (*b - *a).cross(*c - *a));
    let (sum, all) = areas.fold((DVec3::ZERO, 0.0), |(sum, all), area| (sum + area, all + area.length()));
    if all > 0.0 { sum.length() / all } else { 0.0 }
}

fn planes(triangles: &[[u32; 3]], mesh: &Mesh, center: DVec3) -> impl Iterator<Item = Vec4> {
    triangles.iter().map(move |t| plane(mesh.corners(*t).map(|p| p.as_dvec3() - center)).as_vec4())
}

/// The mesh with every triangle that repeats an earlier one's corners, whichever way round, shrunk
/// to a point; numbers stay.
///
/// A copy adds nothing to a shadow but sides on top of one another, and where unequal numbers of
/// copies meet a side in the middle of a surface, where rounding may put a pixel on the wrong side
/// of it.
pub fn without_copies(mesh: &Mesh) -> Mesh {
    let welded = weld_mesh(mesh);
    let place = |i: u32| welded.get(i as usize).copied().unwrap_or(NONE);
    let mut sorted: Vec<([u32; 3], usize)> = mesh.triangles().map(|t| t.map(place)).zip(0..).collect();
    sorted.iter_mut().for_each(|(corners, _)| corners.sort_unstable());
    sorted.sort_unstable();
    let mut single = mesh.clone();
    for pair in sorted.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        let at = 3 * pair[1].1;
        single.indices[at + 1] = single.indices[at];
        single.indices[at + 2] = single.indices[at];
    }
    single
}

/// Numbers and welded corners of the triangles that are whole.
fn welded_triangles(mesh: &Mesh) -> Vec<(u32, [u32; 3])> {
    let welded = weld_mesh(mesh);
    let is_whole = |t: &[u32; 3]| t.iter().all(|&i| mesh.positions.get(i as usize).is_some_and(|p| p.is_finite()));
    let whole = (0..).zip(mesh.triangles()).filter(|(_, t)| is_whole(t));
    let triangles = whole.map(|(number, t)| (number, t.map(|i| welded[i as usize])));
    triangles.filter(|(_, [a, b, c])| a != b && b != c && c != a).collect()
}

/// The plane of a triangle; zero where it has no area.
fn plane([a, b, c]: [DVec3; 3]) -> DVec4 {
    let normal = (b - a).cross(c - a);
    let length = normal.length();
    if length > 0.0 { (normal / length).extend(-normal.dot(a) / length) } else { DVec4::ZERO }
}

/// A triangle at an edge, packed so that numbers sort by the edge, then by direction, then by
/// triangle.
struct Use(u128);

impl Use {
    fn new([from, to]: [u32; 2], triangle: u32) -> Self {
        let [low, high] = [from.min(to), from.max(to)].map(u128::from);
        Self(low << 96 | high << 64 | u128::from(from > to) << 32 | u128::from(triangle))
    }

    fn triangle(&self) -> u32 {
        self.0 as u32
    }

    /// True where the triangle runs from the higher to the lower vertex.
    fn is_backward(&self) -> bool {
        self.0 >> 32 & 1 == 1
    }

    /// The lower vertex, the higher one.
    fn vertices(&self) -> [u32; 2] {
        [(self.0 >> 96) as u32, (self.0 >> 64) as u32]
    }
}

fn edges(triangles: &[[u32; 3]]) -> Vec<Edge> {
    let around = |(&[a, b, c], i): (&[u32; 3], u32)| [[a, b], [b, c], [c, a]].map(|ends| Use::new(ends, i));
    let mut uses: Vec<Use> = triangles.iter().zip(0..).flat_map(around).collect();
    uses.sort_unstable_by_key(|u| u.0);
    let mut edges = Vec::with_capacity(uses.len().div_ceil(2));
    for at_edge in uses.chunk_by(|a, b| a.vertices() == b.vertices()) {
        pair_up(at_edge, &mut edges);
    }
    edges
}

/// Splits the triangles at one edge into records of at most two. Opposite ones go together, so that
/// where both face the light, or neither does, they cancel.
fn pair_up(at_edge: &[Use], edges: &mut Vec<Edge>) {
    let (forward, backward) = at_edge.split_at(at_edge.partition_point(|u| !u.is_backward()));
    let pairs = forward.len().min(backward.len());
    edges.extend(forward.iter().zip(backward).map(|(f, b)| Edge {
        vertices: f.vertices(),
        triangles: [f.triangle(), b.triangle()],
        same_direction: false,
    }));
    let [low, high] = at_edge[0].vertices();
    for (vertices, rest) in [([low, high], &forward[pairs..]), ([high, low], &backward[pairs..])] {
        edges.extend(rest.chunks(2).map(|pair| Edge {
            vertices,
            triangles: [pair[0].triangle(), pair.get(1).map_or(NONE, Use::triangle)],
            same_direction: pair.len() == 2,
        }));
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::{mesh_check, primitive};
    use glam::Vec3;

    pub(crate) fn mesh(positions: &[Vec3], triangles: &[[u32; 3]]) -> Mesh {
        Mesh { positions: positions.to_vec(), indices: triangles.as_flattened().to_vec(), ..Mesh::default() }
    }

    /// What must hold for any mesh: every directed edge of every triangle is in one record, on the
    /// side it says.
    fn checked(mesh: &Mesh) -> Adjacency {
        let adjacency = Adjacency::of(mesh);
        let of_triangles = |t: &[u32; 3], i: u32| [[t[0], t[1], i], [t[1], t[2], i], [t[2], t[0], i]];
        let mut want: Vec<[u32; 3]> =
            adjacency.triangles.iter().zip(0..).flat_map(|(t, i)| of_triangles(t, i)).collect();
        let mut got = Vec::new();
        for e in &adjacency.edges {
            let [a, b] = e.vertices;
            got.push([a, b, e.triangles[0]]);
            match (e.triangles[1], e.same_direction) {
                (NONE, same) => assert!(!same, "{e:?}"),
                (second, true) => got.push([a, b, second]),
                (second, false) => got.push([b, a, second]),
            }
        }
        want.sort_unstable();
        got.sort_unstable();
        assert_eq!(got, want);
        assert_eq!(adjacency.planes.len(), adjacency.triangles.len());
        adjacency
    }

    /// Number of records that are (open, same direction, opposite direction).
    fn kinds(adjacency: &Adjacency) -> (usize, usize, usize) {
        let count = |kind: fn(&Edge) -> bool| adjacency.edges.iter().filter(|e| kind(e)).count();
        (count(|e| e.triangles[1] == NONE), count(|e| e.same_direction), count(Edge::is_balanced))
    }

    #[test]
    fn closed_primitives_have_one_and_a_half_edges_a_triangle() {
        for mesh in [
            primitive::cube(),
            primitive::sphere(16, 8),
            primitive::cylinder(16, 3),
            primitive::cone(16, 3),
            primitive::torus(1.0, 0.3, 16, 8),
        ] {
            let adjacency = checked(&mesh);
            assert_eq!(kinds(&adjacency), (0, 0, mesh.triangle_count() * 3 / 2), "{}", mesh.name);
            assert!(adjacency.is_closed && mesh_check::check(&mesh).is_closed());
            assert_eq!(adjacency.center, mesh.bounds().center());
        }
    }

    #[test]
    fn the_plane_is_open_and_nothing_is_closed() {
        let plane = checked(&primitive::plane());
        assert_eq!((kinds(&plane), plane.is_closed), ((4, 0, 1), false));
        let nothing = checked(&Mesh::default());
        assert!(nothing.is_closed && nothing.edges.is_empty() && nothing.layers == 0 && nothing.longest_edge == 0.0);
    }

    #[test]
    fn planes_are_unit_and_positive_in_front() {
        let mut cube = primitive::cube();
        cube.positions.iter_mut().for_each(|p| *p += Vec3::splat(1000.0));
        let adjacency = checked(&cube);
        assert_eq!((adjacency.center, adjacency.longest_edge), (DVec3::splat(1000.0), 2f64.sqrt()));
        for plane in &adjacency.planes {
            assert_eq!((plane.truncate().length(), plane.w), (1.0, -0.5), "outside is in front: {plane}");
        }
    }

    #[test]
    fn a_turned_triangle_runs_along_its_edges_like_its_neighbours() {
        let mut cube = primitive::cube();
        cube.indices.swap(0, 1);
        let adjacency = checked(&cube);
        assert_eq!((kinds(&adjacency), adjacency.is_closed), ((0, 3, 15), false));
    }

    #[test]
    fn a_crack_opens_the_edges_along_it() {
        let mut cube = primitive::cube();
        cube.positions[1].x = cube.positions[1].x.next_up();
        let adjacency = checked(&cube);
        assert_eq!((kinds(&adjacency), adjacency.is_closed), ((4, 0, 16), false));
    }

    #[test]
    fn three_fins_at_an_edge_are_a_pair_and_a_single() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_Z];
        let at_first = |adjacency: &Adjacency| {
            let at = adjacency.edges.iter().filter(|e| e.vertices.iter().all(|v| *v < 2));
            at.map(|e| (e.vertices, e.triangles, e.same_direction)).collect::<Vec<_>>()
        };
        let alike = checked(&mesh(&positions, &[[0, 1, 2], [0, 1, 3], [4, 0, 1]]));
        assert_eq!(at_first(&alike), [([0, 1], [0, 1], true), ([0, 1], [2, NONE], false)]);
        let one_back = checked(&mesh(&positions, &[[0, 1, 2], [3, 1, 0], [4, 0, 1]]));
        assert_eq!(at_first(&one_back), [([0, 1], [0, 1], false), ([0, 1], [2, NONE], false)]);
        let two_back = checked(&mesh(&positions, &[[1, 0, 2], [0, 1, 3], [1, 0, 4]]));
        assert_eq!(at_first(&two_back), [([0, 1], [1, 0], false), ([1, 0], [2, NONE], false)]);
    }

    #[test]
    fn copies_go_and_numbers_stay() {
        let mut sphere = primitive::sphere(8, 6);
        let alone = Adjacency::of(&sphere);
        let [a, b, c] = sphere.triangles().nth(20).expect("a triangle");
        sphere.indices.splice(0..0, [b, c, a, c, b, a]);
        let single = Adjacency::of(&without_copies(&sphere));
        assert_eq!((single.triangles.len(), single.is_closed), (alone.triangles.len(), true));
        assert!(single.numbers.contains(&0) && !single.numbers.contains(&1) && !single.numbers.contains(&22));
        let broken = Mesh { indices: vec![0, 1, 999, 0, 1, 999], ..primitive::plane() };
        assert!(Adjacency::of(&without_copies(&broken)).triangles.is_empty());
    }

    #[test]
    fn what_joints_may_part_is_not_joined() {
        let mut cube = primitive::cube();
        let lower = |p: &Vec3| crate::rig::Influence { joint: u32::from(p.y < 0.0), weight: 1.0 };
        cube.positions.iter().for_each(|p| cube.weights.push(&[lower(p)]));
        let bends = checked(&cube);
        assert_eq!((bends.is_closed, bends.layers), (true, 6), "closed in any pose, but not convex in all");
        cube.weights = Default::default();
        (0..24).for_each(|i| cube.weights.push(&[crate::rig::Influence { joint: i / 4, weight: 1.0 }]));
        let parts = checked(&cube);
        assert_eq!((kinds(&parts), parts.is_closed), ((24, 0, 6), false), "six sides that may move away");
    }

    #[test]
    fn both_sides_of_a_sheet_are_closed_and_two_copies_are_not() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let sheet = checked(&mesh(&positions, &[[0, 1, 2], [2, 1, 0]]));
        assert_eq!((kinds(&sheet), sheet.is_closed), ((0, 0, 3), true));
        let copies = checked(&mesh(&positions, &[[0, 1, 2], [1, 2, 0]]));
        assert_eq!((kinds(&copies), copies.is_closed), ((0, 3, 0), false));
    }

    #[test]
    fn a_moebius_strip_runs_into_itself_at_one_edge() {
        let strip = checked(&moebius());
        assert_eq!((kinds(&strip), strip.is_closed), ((32, 1, 31), false));
    }

    /// Sixteen quads around, turned over once.
    pub(crate) fn moebius() -> Mesh {
        let rim = |i: u32| {
            let (i, side) = (i / 2 % 16, if (i / 2 >= 16) == i.is_multiple_of(2) { 0.3 } else { -0.3 });
            let around = glam::Quat::from_rotation_y(i as f32 / 16.0 * std::f32::consts::TAU);
            let twist = glam::Quat::from_rotation_z(i as f32 / 16.0 * std::f32::consts::PI);
            around * (Vec3::X + twist * Vec3::Y * side)
        };
        let quads = (0..16).flat_map(|i| [[2 * i, 2 * i + 1, 2 * i + 2], [2 * i + 2, 2 * i + 1, 2 * i + 3]]);
        mesh(&(0..34).map(rim).collect::<Vec<_>>(), &quads.collect::<Vec<_>>())
    }

    #[test]
    fn triangles_without_area_close_a_seam() {
        // The first triangle of the cube split in the middle of an edge that its neighbour does not
        // split.
        let mut cube = primitive::cube();
        let [a, b, c, m] = [cube.indices[0], cube.indices[1], cube.indices[2], cube.positions.len() as u32];
        cube.positions.push((cube.positions[a as usize] + cube.positions[b as usize]) * 0.5);
        cube.indices.splice(..3, [a, m, c, m, b, c]);
        assert!(!checked(&cube).is_closed);
        cube.indices.extend([a, b, m]);
        let adjacency = checked(&cube);
        assert!(adjacency.is_closed);
        assert_eq!((adjacency.layers, adjacency.planes[13]), (1, Vec4::ZERO));
    }

    #[test]
    fn broken_triangles_are_left_out() {
        let mut cube = primitive::cube();
        let whole = checked(&cube);
        cube.positions.extend([Vec3::NAN, Vec3::new(0.0, f32::INFINITY, 0.0), cube.positions[0]]);
        cube.indices.extend([0, 1, 24, 1, 25, 2, 0, 1, 99, 0, 1, u32::MAX, 0, 1, 26, 3, 3, 3, 7]);
        assert_eq!(checked(&cube), whole);
    }

    #[test]
    fn many_triangles_at_one_edge_and_many_vertices_at_one_place_are_no_trouble() {
        let rim = (0..100_000).map(|i| Vec3::new(0.0, i as f32, 1.0));
        let positions: Vec<Vec3> = [Vec3::ZERO, Vec3::X].into_iter().chain(rim).collect();
        let fan: Vec<[u32; 3]> = (2..100_002).map(|i| if i % 4 == 0 { [1, 0, i] } else { [0, 1, i] }).collect();
        let fan = checked(&mesh(&positions, &fan));
        assert_eq!((kinds(&fan), fan.layers), ((200_000, 25_000, 25_000), 100_000));
        let one_place = mesh(&[Vec3::ONE; 3000], &(0..1000).map(|i| [i, i + 1000, i + 2000]).collect::<Vec<_>>());
        assert!(checked(&one_place).triangles.is_empty());
    }

    #[test]
    fn huge_and_tiny_numbers_stay_numbers() {
        for size in [1e-38, 1e37] {
            let mut cube = primitive::cube();
            cube.positions.iter_mut().for_each(|p| *p *= size);
            let adjacency = checked(&cube);
            assert!(adjacency.planes.iter().all(|p| p.is_finite() && p.truncate().length() == 1.0), "{size}");
            assert_eq!(adjacency.layers, 1);
        }
    }
}

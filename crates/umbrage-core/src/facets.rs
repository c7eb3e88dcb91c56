//! The flat parts of a mesh: coplanar triangles that together are large enough to be a receiver of
//! their own.

use crate::Mesh;
use glam::{DVec2, DVec3, DVec4};
use std::collections::HashMap;

/// Triangles of one mesh that lie in one plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Facet {
    /// Corners, in order, of a rectangle in the plane around all of the triangles; mesh units.
    pub corners: [DVec3; 4],
    /// What share of the rectangle the triangles cover, were none of them over another.
    pub share: f64,
}

/// At most this many of the largest facets of a mesh count.
const MOST: usize = 64;

/// Least area of a facet, as a share of the mesh's.
const LEAST_SHARE: f64 = 0.002;

/// So many of the largest groups are looked through for parts of one plane.
const MOST_COMPARED: usize = 256;

/// Corners may be off the plane by this share of the mesh's largest coordinate: some roundings of
/// single precision.
const FLATNESS: f64 = 1e-6;

/// The largest facets of a mesh, by area. Triangles without area, and those with corners that are
/// not finite, belong to none.
pub fn facets(mesh: &Mesh) -> Vec<Facet> {
    let center = mesh.bounds().center();
    let size = mesh.bounds().largest_coordinate();
    let mut triangles: Vec<Triangle> =
        mesh.triangles().filter_map(|t| Triangle::of(mesh.corners(t).map(|p| p.as_dvec3() - center))).collect();
    let total: f64 = triangles.iter().map(|t| t.area).sum();
    triangles.sort_by(|a, b| b.area.total_cmp(&a.area));
    let mut groups =
        Groups { tolerance: FLATNESS * size, cell: 1e-4 * size, planes: Vec::new(), cells: HashMap::new() };
    for triangle in &triangles {
        groups.add(triangle);
    }
    let mut planes = groups.planes;
    planes.iter_mut().for_each(Group::settle);
    planes.sort_by(|a, b| b.area.total_cmp(&a.area));
    planes.truncate(MOST_COMPARED);
    unite(&mut planes, groups.tolerance);
    planes.retain(|plane| plane.area >= LEAST_SHARE * total);
    planes.sort_by(|a, b| b.area.total_cmp(&a.area));
    planes.truncate(MOST);
    planes.iter().map(|plane| plane.facet(center)).collect()
}

struct Triangle {
    corners: [DVec3; 3],
    normal: DVec3,
    area: f64,
}

impl Triangle {
    fn of(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let cross = (b - a).cross(c - a);
        let normal = cross.try_normalize().filter(|n| n.is_finite())?;
        // One sign for fronts and backs of the same plane.
        let largest = normal.to_array().into_iter().max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
        Some(Self { corners, normal: normal * largest.signum(), area: 0.5 * cross.length() })
    }
}

/// A group of triangles; the first one, its largest, gives the plane until all are there.
struct Group {
    plane: DVec4,
    /// Of all triangles: normals times areas, and middles times areas.
    normals: DVec3,
    middles: DVec3,
    right: DVec3,
    up: DVec3,
    low: DVec2,
    high: DVec2,
    area: f64,
}

impl Group {
    fn new(triangle: &Triangle) -> Self {
        let [a, b, c] = triangle.corners;
        let edges = [b - a, c - b, a - c];
        let longest = edges.into_iter().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        // An edge that the next triangle has, too, is often a diagonal; the other two are not.
        let side = edges.into_iter().find(|e| longest.is_some_and(|longest| e.length() < longest.length()));
        let right = side.unwrap_or(b - a).normalize();
        Self {
            plane: triangle.normal.extend(-triangle.normal.dot(a)),
            normals: DVec3::ZERO,
            middles: DVec3::ZERO,
            right,
            up: triangle.normal.cross(right),
            low: DVec2::INFINITY,
            high: DVec2::NEG_INFINITY,
            area: 0.0,
        }
    }

    fn holds(&self, triangle: &Triangle, tolerance: f64) -> bool {
        triangle.corners.iter().all(|p| self.plane.dot(p.extend(1.0)).abs() <= tolerance)
    }

    fn add(&mut self, triangle: &Triangle) {
        for p in triangle.corners {
            let at = DVec2::new(self.right.dot(p), self.up.dot(p));
            (self.low, self.high) = (self.low.min(at), self.high.max(at));
        }
        self.area += triangle.area;
        self.normals += triangle.normal * triangle.area;
        self.middles += triangle.corners.into_iter().sum::<DVec3>() * (triangle.area / 3.0);
    }

    /// Takes the mean plane of all triangles: that of one is off by rounding over the triangle's
    /// size, which many others multiply.
    fn settle(&mut self) {
        let Some(normal) = self.normals.try_normalize() else { return };
        self.plane = normal.extend(-normal.dot(self.middles / self.area));
        self.right = (self.right - normal * normal.dot(self.right)).normalize_or(normal.any_orthonormal_vector());
        self.up = normal.cross(self.right);
    }

    /// The rectangle's corners, relative to the mesh's middle.
    fn corners(&self) -> [DVec3; 4] {
        let on_plane = self.plane.truncate() * -self.plane.w;
        let at = |x: f64, y: f64| on_plane + self.right * x + self.up * y;
        let (low, high) = (self.low, self.high);
        [at(low.x, low.y), at(high.x, low.y), at(high.x, high.y), at(low.x, high.y)]
    }

    /// Takes in another one where both are parts of one plane; false where they are not.
    fn take(&mut self, other: &Self, tolerance: f64) -> bool {
        let holds =
            |one: &Self, other: &Self| other.corners().iter().all(|p| one.plane.dot(p.extend(1.0)).abs() <= tolerance);
        let is_one = holds(self, other) && holds(other, self);
        if is_one {
            for p in other.corners() {
                let at = DVec2::new(self.right.dot(p), self.up.dot(p));
                (self.low, self.high) = (self.low.min(at), self.high.max(at));
            }
            self.area += other.area;
            self.normals += other.normals;
            self.middles += other.middles;
            self.settle();
        }
        is_one
    }

    fn facet(&self, center: DVec3) -> Facet {
        let size = self.high - self.low;
        Facet { corners: self.corners().map(|p| p + center), share: (self.area / (size.x * size.y)).clamp(0.0, 1.0) }
    }
}

/// Makes one of groups that are parts of one plane: a tessellated surface that no axis is
/// perpendicular to is rounded into several.
fn unite(planes: &mut Vec<Group>, tolerance: f64) {
    let mut united: Vec<Group> = Vec::new();
    for group in planes.drain(..) {
        if !united.iter_mut().any(|other| other.take(&group, tolerance)) {
            united.push(group);
        }
    }
    *planes = united;
}

/// Groups, found again by direction and offset in coarse steps.
struct Groups {
    tolerance: f64,
    cell: f64,
    planes: Vec<Group>,
    cells: HashMap<[i64; 4], Vec<u32>>,
}

impl Groups {
    fn add(&mut self, triangle: &Triangle) {
        let offset = triangle.normal.dot(triangle.corners[0]);
        let [x, y, z] = (triangle.normal * 1e3).round().to_array().map(|v| v as i64);
        let step = (offset / self.cell).round() as i64;
        for near in [step, step - 1, step + 1] {
            let found = self.cells.get(&[x, y, z, near]).into_iter().flatten();
            let fits = |i: &&u32| self.planes[**i as usize].holds(triangle, self.tolerance);
            if let Some(&i) = found.into_iter().find(fits) {
                self.planes[i as usize].add(triangle);
                return;
            }
        }
        let mut group = Group::new(triangle);
        group.add(triangle);
        self.cells.entry([x, y, z, step]).or_default().push(self.planes.len() as u32);
        self.planes.push(group);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitive;
    use glam::{DAffine3, DMat3, Vec3};

    fn area(facet: &Facet) -> f64 {
        let [a, b, _, d] = facet.corners;
        (b - a).cross(d - a).length()
    }

    #[test]
    fn a_cube_has_six_and_a_plane_has_one() {
        let turned = DAffine3::from_mat3(DMat3::from_rotation_x(0.4) * DMat3::from_rotation_z(1.1));
        let cube = facets(&primitive::cube().transformed(&turned));
        assert_eq!(cube.len(), 6);
        let full = |f: &Facet| (f.share - 1.0).abs() < 1e-6;
        assert!(cube.iter().all(|f| full(f) && (area(f) - area(&cube[0])).abs() < 1e-5), "{cube:?}");
        let plane = facets(&primitive::plane());
        assert!(plane.len() == 1 && full(&plane[0]));
    }

    #[test]
    fn what_is_curved_has_none() {
        assert!(facets(&primitive::sphere(64, 32)).is_empty());
    }

    #[test]
    fn many_small_coplanar_triangles_are_one_facet_in_any_direction() {
        let turned = DAffine3::from_mat3(DMat3::from_rotation_x(0.4) * DMat3::from_rotation_z(1.1));
        for side in [10, 100, 200_u32] {
            let mesh = tiles(side);
            for mesh in [mesh.transformed(&turned), mesh] {
                let found = facets(&mesh);
                assert_eq!(found.len(), 1, "{side}: {found:?}");
                let all = f64::from(side * side);
                assert!((area(&found[0]) / all - 1.0).abs() < 1e-3 && (found[0].share - 1.0).abs() < 1e-3, "{side}");
            }
        }
    }

    /// Squares of side 1 beside each other, wound either way.
    fn tiles(side: u32) -> Mesh {
        let mut mesh = Mesh::default();
        for i in 0..side * side {
            let (x, z) = ((i % side) as f32, (i / side) as f32);
            let first = mesh.positions.len() as u32;
            mesh.positions
                .extend([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(u, v)| Vec3::new(x + u, 2.0, z + v)));
            let quad = if i % 3 == 0 { [0, 1, 2, 0, 2, 3] } else { [0, 2, 1, 0, 3, 2] };
            mesh.indices.extend(quad.map(|k| first + k));
        }
        mesh
    }

    #[test]
    fn broken_triangles_belong_to_none() {
        let mut mesh = primitive::plane();
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([Vec3::NAN, Vec3::INFINITY, Vec3::ZERO, Vec3::X, Vec3::X * 2.0]);
        mesh.indices.extend([0, 1, 2, 2, 3, 4].map(|k| first + k));
        assert_eq!(facets(&mesh).len(), 1);
        assert!(facets(&Mesh::default()).is_empty());
    }
}

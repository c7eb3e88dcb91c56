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

/// A group of triangles; the first one, its largest, gives the plane.
struct Group {
    plane: DVec4,
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
    }

    fn facet(&self, center: DVec3) -> Facet {
        let on_plane = self.plane.truncate() * -self.plane.w;
        let at = |x: f64, y: f64| center + on_plane + self.right * x + self.up * y;
        let (low, high) = (self.low, self.high);
        let size = high - low;
        Facet {
            corners: [at(low.x, low.y), at(high.x, low.y), at(high.x, high.y), at(low.x, high.y)],
            share: (self.area / (size.x * size.y)).clamp(0.0, 1.0),
        }
    }
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
    fn many_small_coplanar_triangles_are_one_facet() {
        let mut mesh = Mesh::default();
        for i in 0..100_u32 {
            let (x, z) = ((i % 10) as f32, (i / 10) as f32);
            let first = mesh.positions.len() as u32;
            mesh.positions
                .extend([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(u, v)| Vec3::new(x + u, 2.0, z + v)));
            let quad = if i % 3 == 0 { [0, 1, 2, 0, 2, 3] } else { [0, 2, 1, 0, 3, 2] };
            mesh.indices.extend(quad.map(|k| first + k));
        }
        let found = facets(&mesh);
        assert_eq!(found.len(), 1);
        assert!((area(&found[0]) - 100.0).abs() < 1e-3 && (found[0].share - 1.0).abs() < 1e-3);
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

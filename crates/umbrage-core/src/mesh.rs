//! Triangle meshes.

use crate::{bounds::Bounds, rig::Weights, weld::weld_mesh};
use glam::{DAffine3, DVec3, DVec4, Vec2, Vec3};

/// Indexed triangles in the mesh's own space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// For messages.
    pub name: String,
    /// Vertex positions, metres before the instance's scale.
    pub positions: Vec<Vec3>,
    /// Unit shading normals, one a vertex. Only shading uses them; shadows go by the triangles.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one a vertex, or none at all.
    pub uvs: Vec<Vec2>,
    /// Opacity of each vertex, 0…1, or none at all: of a surface with an alpha mask it multiplies
    /// that of the material.
    pub opacities: Vec<f32>,
    /// What moves the vertices, where the mesh has joints; one entry a vertex, or none at all.
    pub weights: Weights,
    /// Three a triangle, counter-clockwise seen from the front.
    pub indices: Vec<u32>,
}

impl Mesh {
    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// Vertex indices of each triangle.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.indices.as_chunks::<3>().0.iter().copied()
    }

    /// [`Mesh::indices`] with the first vertex at exactly its place for each, unless joints may
    /// part them: fewer vertices where only places count. A triangle whose corners are on a line,
    /// and stay there, is one vertex: projected, rounding could open it to a sliver.
    pub fn welded_indices(&self) -> Vec<u32> {
        let first = weld_mesh(self);
        let mut welded: Vec<u32> = self.indices.iter().map(|&i| first.get(i as usize).copied().unwrap_or(i)).collect();
        let triangles = welded.as_chunks_mut::<3>().0.iter_mut().filter(|_| self.weights.is_empty());
        for triangle in triangles.filter(|t| t.iter().all(|i| (*i as usize) < self.positions.len())) {
            let [a, b, c] = self.corners(*triangle).map(|p| p.as_dvec3());
            // Exact: twice the 24 bits of single precision fit double precision.
            if (b - a).cross(c - a) == DVec3::ZERO {
                *triangle = [triangle[0]; 3];
            }
        }
        welded
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: [u32; 3]) -> [Vec3; 3] {
        triangle.map(|i| self.positions[i as usize])
    }

    /// The box around the vertices that triangles use.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.indices.iter().map(|&i| self.positions[i as usize].as_dvec3()))
    }

    /// The plane that all triangles lie in, as a unit normal with the offset in `w` (n · p + w =
    /// 0), if there is one.
    pub fn plane(&self) -> Option<DVec4> {
        let corners = || self.indices.iter().map(|&i| self.positions[i as usize].as_dvec3());
        let normal = self.triangles().find_map(|t| {
            let [a, b, c] = self.corners(t).map(|p| p.as_dvec3());
            (b - a).cross(c - a).try_normalize()
        })?;
        let offset = -normal.dot(corners().next()?);
        let tolerance = 1e-7 * self.bounds().largest_coordinate();
        corners().all(|p| (normal.dot(p) + offset).abs() <= tolerance).then_some(normal.extend(offset))
    }

    /// Gives every vertex a normal where the mesh has none (or a wrong number of them): the mean of
    /// its triangles' normals weighted by the angle there, so that it does not depend on how faces
    /// were split.
    pub fn generate_normals_if_absent(&mut self) {
        if self.normals.len() == self.positions.len() && self.normals.iter().all(|n| n.is_finite()) {
            return;
        }
        self.normals = vec![Vec3::ZERO; self.positions.len()];
        for t in self.indices.as_chunks::<3>().0 {
            let corners = t.map(|i| self.positions[i as usize]);
            for (k, &i) in t.iter().enumerate() {
                self.normals[i as usize] += face_normal(corners) * angle_at(corners, k);
            }
        }
        for n in &mut self.normals {
            *n = n.normalize_or(Vec3::Y);
        }
    }

    /// The same triangles with normals made anew: smooth over edges that bend by less than
    /// `crease_deg` degrees, sharp over the others, where vertices are split. Triangles that share
    /// a vertex index are neighbours.
    pub fn with_creases(&self, crease_deg: f32) -> Mesh {
        let least_cos = crease_deg.to_radians().cos();
        let triangles: Vec<[u32; 3]> = self.triangles().collect();
        let faces: Vec<Vec3> = triangles.iter().map(|t| face_normal(self.corners(*t))).collect();
        let mut around = vec![Vec::new(); self.positions.len()];
        for (face, t) in triangles.iter().enumerate() {
            for (k, &i) in t.iter().enumerate() {
                around[i as usize].push((face, angle_at(self.corners(*t), k)));
            }
        }
        let mut mesh = Mesh { name: self.name.clone(), ..Mesh::default() };
        let mut made: Vec<Vec<u32>> = vec![Vec::new(); self.positions.len()];
        for (face, t) in triangles.iter().enumerate() {
            for v in t.map(|i| i as usize) {
                let smooth = around[v].iter().filter(|(other, _)| faces[*other].dot(faces[face]) >= least_cos);
                let sum: Vec3 = smooth.map(|(other, angle)| faces[*other] * *angle).sum();
                let normal = sum.normalize_or(Vec3::Y);
                let same = made[v].iter().copied().find(|&i| mesh.normals[i as usize] == normal);
                mesh.indices.push(same.unwrap_or_else(|| {
                    let new = mesh.positions.len() as u32;
                    made[v].push(new);
                    mesh.positions.push(self.positions[v]);
                    mesh.normals.push(normal);
                    mesh.uvs.extend(self.uvs.get(v));
                    mesh.opacities.extend(self.opacities.get(v));
                    if !self.weights.is_empty() {
                        mesh.weights.push(self.weights.of(v));
                    }
                    new
                }));
            }
        }
        mesh
    }

    /// The mesh moved by `transform`; a mirroring one turns the triangles round, so that fronts
    /// stay fronts.
    pub fn transformed(&self, transform: &DAffine3) -> Mesh {
        let mut mesh = self.clone();
        let normal_matrix = transform.matrix3.inverse().transpose();
        for p in &mut mesh.positions {
            *p = transform.transform_point3(p.as_dvec3()).as_vec3();
        }
        for n in &mut mesh.normals {
            *n = (normal_matrix * n.as_dvec3()).as_vec3().normalize_or(Vec3::Y);
        }
        if transform.matrix3.determinant() < 0.0 {
            mesh.indices.as_chunks_mut::<3>().0.iter_mut().for_each(|t| t.swap(1, 2));
        }
        mesh
    }

    /// Appends the triangles of `other`, as they are; joints are taken for the same.
    pub fn append(&mut self, other: &Mesh) {
        let base = self.positions.len() as u32;
        let both_uvs = self.uvs.len() == self.positions.len() && other.uvs.len() == other.positions.len();
        if !self.weights.is_empty() || !other.weights.is_empty() {
            self.weights.pad(self.positions.len());
            self.weights.append(&other.weights);
            self.weights.pad(self.positions.len() + other.positions.len());
        }
        if !self.opacities.is_empty() || !other.opacities.is_empty() {
            self.opacities.resize(self.positions.len(), 1.0);
            self.opacities.extend(&other.opacities);
            self.opacities.resize(self.positions.len() + other.positions.len(), 1.0);
        }
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
        if both_uvs {
            self.uvs.extend(&other.uvs);
        } else {
            self.uvs.clear();
        }
        self.indices.extend(other.indices.iter().map(|i| i + base));
    }
}

/// Unit normal of a triangle's front; zero where it has no area.
fn face_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// Angle of a triangle at its corner `k`, radians.
fn angle_at(corners: [Vec3; 3], k: usize) -> f32 {
    let to = |j: usize| (corners[(k + j) % 3] - corners[k]).normalize_or_zero();
    to(1).dot(to(2)).clamp(-1.0, 1.0).acos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitive;

    #[test]
    fn triangles_that_are_lines_weld_to_a_point() {
        let positions = [[0.0, 1.0, 0.0], [0.5, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]].map(Vec3::from).to_vec();
        let mesh = Mesh { positions, indices: vec![0, 1, 2, 0, 2, 3], ..Mesh::default() };
        assert_eq!(mesh.welded_indices(), [0, 0, 0, 0, 2, 3]);
    }

    #[test]
    fn only_flat_meshes_have_a_plane() {
        let plane = primitive::plane().plane();
        assert_eq!(plane.map(|p| p.y.abs()), Some(1.0));
        assert_eq!(primitive::cube().plane(), None);
        assert_eq!(Mesh::default().plane(), None);
    }

    #[test]
    fn generated_normals_of_a_flat_quad_are_its_own() {
        let mut m = Mesh {
            positions: vec![Vec3::ZERO, Vec3::Z, Vec3::new(1.0, 0.0, 1.0), Vec3::X],
            indices: vec![0, 1, 2, 0, 2, 3],
            ..Mesh::default()
        };
        m.generate_normals_if_absent();
        assert!(m.normals.iter().all(|n| (*n - Vec3::Y).length() < 1e-6), "{:?}", m.normals);
    }

    #[test]
    fn creases_split_a_welded_cube_and_leave_a_sphere_smooth() {
        let welded = Mesh {
            positions: (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32)).collect(),
            indices: vec![
                0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1,
                7, 5,
            ],
            ..Mesh::default()
        };
        let sharp = welded.with_creases(60.0);
        assert_eq!((sharp.positions.len(), sharp.triangle_count()), (24, 12));
        assert!(sharp.normals.iter().all(|n| n.abs().max_element() == 1.0), "{:?}", sharp.normals);
        assert_eq!(welded.with_creases(91.0).positions.len(), 8);
        let sphere = primitive::sphere(32, 16).with_creases(60.0);
        for (p, n) in sphere.positions.iter().zip(&sphere.normals) {
            assert!(p.dot(*n) > 0.98, "normal {n} at {p}");
        }
    }

    #[test]
    fn a_mirrored_mesh_still_faces_outwards() {
        let t = DAffine3::from_scale(DVec3::new(-2.0, 1.0, 3.0));
        let mesh = primitive::sphere(16, 8).transformed(&t);
        for t in mesh.triangles() {
            let corners = mesh.corners(t);
            assert!(face_normal(corners).dot(corners[0]) > 0.0);
            assert!(t.iter().all(|&i| face_normal(corners).dot(mesh.normals[i as usize]) > 0.0));
        }
    }

    #[test]
    fn degenerate_triangles_leave_finite_normals() {
        let mut m = Mesh { positions: vec![Vec3::ZERO; 3], indices: vec![0, 1, 2], ..Mesh::default() };
        m.generate_normals_if_absent();
        assert!(m.normals.iter().all(|n| n.is_finite() && (n.length() - 1.0).abs() < 1e-6));
    }
}

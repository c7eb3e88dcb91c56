//! Triangle meshes.

use crate::bounds::Bounds;
use glam::{Vec2, Vec3};

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

    /// The corners of a triangle.
    pub fn corners(&self, triangle: [u32; 3]) -> [Vec3; 3] {
        triangle.map(|i| self.positions[i as usize])
    }

    /// The box around the vertices that triangles use.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.indices.iter().map(|&i| self.positions[i as usize].as_dvec3()))
    }

    /// Gives every vertex a normal where the mesh has none (or a wrong number of them): the mean of its
    /// triangles' normals weighted by the angle there, so that it does not depend on how faces were split.
    pub fn generate_normals_if_absent(&mut self) {
        if self.normals.len() == self.positions.len() && self.normals.iter().all(|n| n.is_finite()) {
            return;
        }
        self.normals = vec![Vec3::ZERO; self.positions.len()];
        for t in self.indices.as_chunks::<3>().0 {
            let p = t.map(|i| self.positions[i as usize]);
            let face = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
            for k in 0..3 {
                let to = |j: usize| (p[(k + j) % 3] - p[k]).normalize_or_zero();
                self.normals[t[k] as usize] += face * to(1).dot(to(2)).clamp(-1.0, 1.0).acos();
            }
        }
        for n in &mut self.normals {
            *n = n.normalize_or(Vec3::Y);
        }
    }

    /// Appends the triangles of `other`, as they are.
    pub fn append(&mut self, other: &Mesh) {
        let base = self.positions.len() as u32;
        let both_uvs = self.uvs.len() == self.positions.len() && other.uvs.len() == other.positions.len();
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

#[cfg(test)]
mod tests {
    use super::*;

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
    fn degenerate_triangles_leave_finite_normals() {
        let mut m = Mesh { positions: vec![Vec3::ZERO; 3], indices: vec![0, 1, 2], ..Mesh::default() };
        m.generate_normals_if_absent();
        assert!(m.normals.iter().all(|n| n.is_finite() && (n.length() - 1.0).abs() < 1e-6));
    }
}

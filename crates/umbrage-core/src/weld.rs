//! Vertices at the same place made one.

use crate::mesh::Mesh;
use glam::Vec3;
use std::collections::HashMap;

/// For every vertex the first one at exactly its place. Bits are compared, but −0 is 0.
pub(crate) fn weld(positions: &[Vec3]) -> Vec<u32> {
    // Place and number side by side in one integer: sorting is then fast, and the first of equals
    // stands in front.
    let key = |(p, i): (&Vec3, u32)| {
        // Adding 0 makes −0 and 0 equal.
        let [x, y, z] = (*p + 0.0).to_array().map(|c| u128::from(c.to_bits()));
        x << 96 | y << 64 | z << 32 | u128::from(i)
    };
    let mut keys: Vec<u128> = positions.iter().zip(0..).map(key).collect();
    keys.sort_unstable();
    let mut welded = vec![0; positions.len()];
    for same in keys.chunk_by(|a, b| a >> 32 == b >> 32) {
        for &k in same {
            welded[k as u32 as usize] = same[0] as u32;
        }
    }
    welded
}

/// The same for a mesh, where vertices at one place that joints may part stay apart.
pub(crate) fn weld_mesh(mesh: &Mesh) -> Vec<u32> {
    let mut welded = weld(&mesh.positions);
    if mesh.weights.is_empty() {
        return welded;
    }
    // For every place its vertices that are held differently.
    let mut firsts: HashMap<u32, Vec<u32>> = HashMap::new();
    for (vertex, first) in (0..).zip(&mut welded) {
        let known = firsts.entry(*first).or_default();
        let weights = mesh.weights.of(vertex as usize);
        *first = known.iter().copied().find(|k| mesh.weights.of(*k as usize) == weights).unwrap_or_else(|| {
            known.push(vertex);
            vertex
        });
    }
    welded
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Influence;

    #[test]
    fn the_first_vertex_at_a_place_stands_for_all() {
        let (a, b) = (Vec3::new(1.0, 0.0, -2.0), Vec3::new(1.0, 0.0, 2.0));
        let positions = [b, a, Vec3::new(1.0, -0.0, 2.0), a, Vec3::NAN, b, Vec3::NAN];
        assert_eq!(weld(&positions), [0, 1, 0, 1, 4, 0, 4]);
        assert!(weld(&[]).is_empty());
    }

    #[test]
    fn vertices_that_joints_may_part_stay_apart() {
        let mut mesh = Mesh { positions: vec![Vec3::ONE; 4], ..Mesh::default() };
        assert_eq!(weld_mesh(&mesh), [0; 4]);
        for joint in [0, 1, 0, 1] {
            mesh.weights.push(&[Influence { joint, weight: 1.0 }]);
        }
        assert_eq!(weld_mesh(&mesh), [0, 1, 0, 1]);
    }

    #[test]
    fn neighbours_in_the_last_bit_stay_apart() {
        assert_eq!(weld(&[Vec3::ONE, Vec3::new(1.0, 1.0, 1f32.next_up())]), [0, 1]);
    }
}

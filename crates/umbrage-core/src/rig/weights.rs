//! Which joints hold a vertex, and meshes posed by them.

use crate::bounds::Bounds;
use crate::mesh::Mesh;
use glam::{DAffine3, DMat3, DVec3};

/// How much a joint moves a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Influence {
    /// Index into [`super::Skin::joints`].
    pub joint: u32,
    /// A share of 1.
    pub weight: f32,
}

/// The joints of every vertex of a mesh, as many as each has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Weights {
    /// Where the influences of each vertex end.
    ends: Vec<u32>,
    influences: Vec<Influence>,
}

impl Weights {
    /// Adds the next vertex. Weights that are not over 0 are left out, those of one joint added up,
    /// all brought to a sum of 1 and put in the order of joints, so that vertices held alike are
    /// the same. A vertex that no joint holds stays where it is.
    pub fn push(&mut self, influences: &[Influence]) {
        let counts = |i: &Influence| i.weight > 0.0 && i.weight.is_finite();
        let mut kept: Vec<Influence> = influences.iter().copied().filter(counts).collect();
        kept.sort_by_key(|i| i.joint);
        kept.dedup_by(|again, first| {
            let same = again.joint == first.joint;
            first.weight += if same { again.weight } else { 0.0 };
            same
        });
        let sum: f64 = kept.iter().map(|i| f64::from(i.weight)).sum();
        let share = |i: &Influence| Influence { weight: (f64::from(i.weight) / sum) as f32, ..*i };
        self.influences.extend(kept.iter().map(share));
        self.ends.push(self.influences.len() as u32);
    }

    /// Number of vertices; 0 for a mesh that is not moved by joints.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// True for a mesh that is not moved by joints.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// What moves a vertex; nothing for one that is not there.
    pub fn of(&self, vertex: usize) -> &[Influence] {
        let start = vertex.checked_sub(1).map_or(0, |before| self.ends.get(before).copied().unwrap_or(0));
        let end = self.ends.get(vertex).copied().unwrap_or(start);
        &self.influences[start as usize..end as usize]
    }

    /// Where the influences of each vertex end in [`Weights::influences`].
    pub fn ends(&self) -> &[u32] {
        &self.ends
    }

    /// Those of all vertices, one after the other.
    pub fn influences(&self) -> &[Influence] {
        &self.influences
    }

    /// Adds vertices that no joint holds until there are `count`.
    pub(crate) fn pad(&mut self, count: usize) {
        self.ends.resize(count.max(self.ends.len()), self.influences.len() as u32);
    }

    /// Adds the vertices of another mesh that hangs on the same joints.
    pub(crate) fn append(&mut self, other: &Self) {
        let base = self.influences.len() as u32;
        self.influences.extend(&other.influences);
        self.ends.extend(other.ends.iter().map(|end| base + end));
    }

    /// What the joints do to a vertex together. A joint that is not there does nothing.
    fn blend(&self, vertex: usize, joints: &[DAffine3]) -> Option<DAffine3> {
        let influences = self.of(vertex);
        let nothing = DAffine3 { matrix3: DMat3::ZERO, translation: DVec3::ZERO };
        let add = |sum: DAffine3, i: &Influence| {
            let joint = joints.get(i.joint as usize).copied().unwrap_or(DAffine3::IDENTITY);
            let weight = f64::from(i.weight);
            DAffine3 {
                matrix3: sum.matrix3 + joint.matrix3 * weight,
                translation: sum.translation + joint.translation * weight,
            }
        };
        (!influences.is_empty()).then(|| influences.iter().fold(nothing, add))
    }
}

impl Mesh {
    /// The mesh as its joints hold it: linear blend skinning. Triangles keep their order of
    /// corners.
    pub fn posed(&self, joints: &[DAffine3]) -> Mesh {
        let mut mesh = self.clone();
        for (vertex, position) in mesh.positions.iter_mut().enumerate() {
            let Some(blend) = self.weights.blend(vertex, joints) else { continue };
            *position = blend.transform_point3(position.as_dvec3()).as_vec3();
            if let Some(normal) = mesh.normals.get_mut(vertex) {
                let moved = normal_matrix(&blend.matrix3) * normal.as_dvec3();
                *normal = moved.try_normalize().unwrap_or(DVec3::Y).as_vec3();
            }
        }
        mesh
    }
}

/// The matrix for normals, up to a positive factor: the cofactors, which exist also where there is
/// no inverse.
fn normal_matrix(m: &DMat3) -> DMat3 {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * m.determinant().signum()
}

/// For every joint a box around the vertices that it has a part in: what a box around any pose is
/// quickly made from.
#[derive(Clone, Debug, PartialEq)]
pub struct JointBoxes {
    joints: Vec<Bounds>,
    /// Around what no joint holds.
    rest: Bounds,
}

impl JointBoxes {
    /// Of the vertices that triangles use.
    pub fn of(mesh: &Mesh) -> Self {
        let count = mesh.weights.influences.iter().map(|i| i.joint as usize + 1).max().unwrap_or(0);
        let mut boxes = Self { joints: vec![Bounds::EMPTY; count], rest: Bounds::EMPTY };
        for &vertex in &mesh.indices {
            let Some(position) = mesh.positions.get(vertex as usize).filter(|p| p.is_finite()) else { continue };
            let influences = mesh.weights.of(vertex as usize);
            for influence in influences {
                let bounds = &mut boxes.joints[influence.joint as usize];
                *bounds = bounds.with(position.as_dvec3());
            }
            if influences.is_empty() {
                boxes.rest = boxes.rest.with(position.as_dvec3());
            }
        }
        boxes
    }

    /// A box that surely holds the posed mesh, as it comes out in single precision. A vertex is a
    /// mean of where its joints would take it, so it is within what holds all of these.
    pub fn posed(&self, joints: &[DAffine3]) -> Bounds {
        let of = |(number, bounds): (usize, &Bounds)| {
            bounds.transformed(&joints.get(number).copied().unwrap_or(DAffine3::IDENTITY))
        };
        let all = self.joints.iter().enumerate().map(of).fold(self.rest, Bounds::union);
        if all.is_empty() { all } else { all.grown(ROUNDING * all.largest_coordinate()) }
    }
}

/// Of matrices, weights and sums in single precision.
const ROUNDING: f64 = 1e-6;

//! How many triangles lie between the eye and the light: where a count that starts at the eye has
//! to begin.

use crate::bvh;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ray::Ray;
use obvhs::{Boundable, BvhBuildParams};
use umbrage_core::adjacency::Adjacency;
use umbrage_core::glam::{DMat3, DVec2, DVec3, DVec4};
use umbrage_core::silhouette::facing;
use umbrage_core::{Bounds, Mesh};

/// A hierarchy over a mesh's triangles, numbered as in its [`Adjacency`].
pub(crate) struct EyeTree {
    tree: Bvh2,
    /// Boxes are grown by this, mesh units.
    margin: f64,
}

/// A segment from the eye to the light in mesh space; w = 0 is the direction to a light infinitely
/// far away.
pub(super) struct Sight {
    pub eye: DVec3,
    pub light: DVec4,
    /// What passes the segment, or an end of it, by no more than this can't be told to be on one
    /// side, mesh units.
    pub tolerance: f64,
}

/// The most that a matrix lengthens a vector, from above.
pub(crate) fn largest_stretch(m: &DMat3) -> f64 {
    (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt()
}

impl EyeTree {
    pub fn new(mesh: &Mesh, adjacency: &Adjacency) -> Self {
        let margin = 1e-2 * mesh.bounds().largest_coordinate();
        let boxes: Vec<Padded> = adjacency
            .triangles
            .iter()
            .map(|&t| Padded::around(mesh.corners(t).map(|p| p.as_dvec3()), margin))
            .collect();
        if boxes.is_empty() {
            return Self { tree: Bvh2::default(), margin };
        }
        Self { tree: bvh::build(&boxes, BvhBuildParams::fastest_build()), margin }
    }

    /// False where surely no triangle touches the box, which is in mesh space.
    pub fn may_touch(&self, mesh: &Mesh, adjacency: &Adjacency, bounds: &Bounds) -> bool {
        let mut found = false;
        self.tree.aabb_traverse(Aabb::new(vector(bounds.min), vector(bounds.max)), |tree, node| {
            let node = &tree.nodes[node as usize];
            let first = node.first_index as usize;
            // Boxes of the tree are larger than triangles.
            found = tree.primitive_indices[first..first + node.prim_count as usize].iter().any(|&t| {
                let corners = mesh.corners(adjacency.triangles[t as usize]);
                Bounds::of(corners.map(|p| p.as_dvec3())).overlaps(bounds)
            });
            !found
        });
        found
    }

    /// How many triangles the segment crosses, of those that face the light and of those that face
    /// away. `None` where it passes an edge or ends at a triangle so closely that rounding decides.
    pub(super) fn count(&self, mesh: &Mesh, adjacency: &Adjacency, sight: &Sight) -> Option<[u32; 2]> {
        let direction = sight.light.truncate() - sight.eye * sight.light.w;
        let length = direction.length();
        let is_safe = length > 0.0 && length.is_finite() && sight.tolerance < 0.5 * self.margin;
        if !is_safe {
            return None;
        }
        if adjacency.triangles.is_empty() {
            return Some([0; 2]);
        }
        let end = if sight.light.w == 0.0 { f64::INFINITY } else { length };
        let line = Line::new(sight.eye, direction / length);
        let light = (sight.light.truncate() - adjacency.center * sight.light.w).extend(sight.light.w).as_vec4();
        let ray = Ray::new(vector(sight.eye), vector(line.direction), 0.0, end as f32);
        let (mut count, mut is_close) = ([0; 2], false);
        self.tree.ray_traverse_miss(ray, |_, leaf| {
            let t = self.tree.primitive_indices[leaf] as usize;
            let is_away = facing(adjacency.planes[t], light) < 0;
            let corners = mesh.corners(adjacency.triangles[t]).map(|p| p.as_dvec3());
            match line.crosses(&corners, end, sight.tolerance) {
                Some(crosses) => count[usize::from(is_away)] += u32::from(crosses),
                None => is_close = true,
            }
            // Nothing ends the search but a case that can't be decided.
            if is_close { 0.0 } else { f32::INFINITY }
        });
        (!is_close).then_some(count)
    }
}

/// A line with two directions across it.
struct Line {
    origin: DVec3,
    direction: DVec3,
    across: [DVec3; 2],
}

impl Line {
    /// `direction` is of unit length.
    fn new(origin: DVec3, direction: DVec3) -> Self {
        let (a, b) = direction.any_orthonormal_pair();
        Self { origin, direction, across: [a, b] }
    }

    /// Whether the line meets the triangle between 0 and `end` metres; `None` where it is within
    /// `tolerance` of not being so.
    fn crosses(&self, corners: &[DVec3; 3], end: f64, tolerance: f64) -> Option<bool> {
        let seen = corners.map(|c| {
            let p = c - self.origin;
            (DVec2::new(p.dot(self.across[0]), p.dot(self.across[1])), p.dot(self.direction))
        });
        let edges = [(0, 1), (1, 2), (2, 0)];
        let is_beyond = seen.iter().all(|(_, t)| *t < -tolerance || *t > end + tolerance)
            && (seen.iter().all(|(_, t)| *t < 0.0) || seen.iter().all(|(_, t)| *t > end));
        if is_beyond {
            return Some(false);
        }
        if edges.iter().any(|&(i, j)| distance_to_segment(seen[i].0, seen[j].0) <= tolerance) {
            return None;
        }
        let area = |(i, j): (usize, usize)| seen[i].0.perp_dot(seen[j].0);
        let areas = edges.map(area);
        let is_inside = areas.iter().all(|a| *a > 0.0) || areas.iter().all(|a| *a < 0.0);
        if !is_inside {
            return Some(false);
        }
        // The weight of a corner is the area opposite to it.
        let t = (areas[1] * seen[0].1 + areas[2] * seen[1].1 + areas[0] * seen[2].1) / areas.iter().sum::<f64>();
        let is_at_an_end = t.abs() <= tolerance || (t - end).abs() <= tolerance;
        (!is_at_an_end).then_some(t > 0.0 && t < end)
    }
}

/// Distance of the origin to the segment.
fn distance_to_segment(a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let share =
        if along.length_squared() > 0.0 { (-a.dot(along) / along.length_squared()).clamp(0.0, 1.0) } else { 0.0 };
    (a + along * share).length()
}

/// A vector of the hierarchy's crate, which may have another version of `glam` than we have.
fn vector<V: From<[f32; 3]>>(v: DVec3) -> V {
    v.as_vec3().to_array().into()
}

/// The box of a triangle, grown.
struct Padded(Aabb);

impl Padded {
    fn around([a, b, c]: [DVec3; 3], margin: f64) -> Self {
        Self(Aabb::new(vector(a.min(b).min(c) - margin), vector(a.max(b).max(c) + margin)))
    }
}

impl Boundable for Padded {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

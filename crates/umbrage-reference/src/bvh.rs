//! A bounding volume hierarchy over triangles: boxes in single precision, triangles in double.

use crate::shaft::Shaft;
use crate::triangle::{Ray, SeenTriangle, Triangle};
use glam::DVec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, leaf_collapser::collapse, reinsertion::ReinsertionOptimizer};
use obvhs::ray::{Ray as BoxRay, RayHit};
use obvhs::{Boundable, BvhBuildParams, ploc::PlocBuilder};

/// Boxes are grown by this share of the largest coordinate. A ray's origin is at most about eight
/// largest coordinates off, so that rounding it and the slab test move a box by less than 8 · 6
/// roundings of 2⁻²⁴ each: the box of a triangle that a ray hits is never missed.
const PADDING: f64 = 1.0 / (1 << 18) as f64;

/// Triangles and the hierarchy over them.
pub(crate) struct Bvh {
    tree: Bvh2,
    /// In the order of the tree's leaves.
    triangles: Vec<Triangle>,
    /// Largest coordinate of any corner.
    largest: f64,
}

/// Decides whether a triangle that a ray meets is there, or is cut out at that point.
pub(crate) trait Opacity {
    /// True where the ray along `direction` is stopped by `triangle`.
    fn stops(&self, triangle: &Triangle, seen: &SeenTriangle, direction: DVec3) -> bool;
}

impl Bvh {
    pub fn new(triangles: Vec<Triangle>) -> Self {
        let corners = triangles.iter().flat_map(|t| t.corners());
        let largest = corners.map(|c| c.abs().max_element()).fold(0.0, f64::max);
        let boxes: Vec<Padded> = triangles.iter().map(|t| Padded::around(t, PADDING * largest)).collect();
        if triangles.is_empty() {
            return Self { tree: Bvh2::default(), triangles, largest };
        }
        let tree = build(&boxes);
        let triangles = tree.primitive_indices.iter().filter_map(|&i| triangles.get(i as usize).cloned()).collect();
        Self { tree, triangles, largest }
    }

    /// True where a triangle other than `own` stops the ray.
    pub fn is_blocked(&self, ray: &Ray, own: Option<u32>, opacity: &impl Opacity) -> bool {
        self.blocker(ray, own, opacity).is_some()
    }

    /// Index of some triangle, not of number `own`, that stops the ray.
    pub fn blocker(&self, ray: &Ray, own: Option<u32>, opacity: &impl Opacity) -> Option<usize> {
        let mut found = None;
        self.tree.ray_traverse_miss(self.box_ray(ray)?.0, |_, i| {
            if self.stops(i, ray, own, opacity) {
                found = Some(i);
                0.0
            } else {
                f32::INFINITY
            }
        });
        found
    }

    /// True where triangle `index`, if it is not of number `own`, stops the ray.
    #[inline]
    pub fn stops(&self, index: usize, ray: &Ray, own: Option<u32>, opacity: &impl Opacity) -> bool {
        let triangle = &self.triangles[index];
        let seen = triangle.seen_from(ray.origin);
        seen.is_hit(ray.direction, ray.t_min, ray.t_max)
            && Some(triangle.id) != own
            && opacity.stops(triangle, &seen, ray.direction)
    }

    /// The first triangle that is not of number `own` and stops the ray, and its t. Of triangles at
    /// the same place it is the first of the scene.
    pub fn first(&self, ray: &Ray, own: Option<u32>, opacity: &impl Opacity) -> Option<(&Triangle, f64)> {
        let (box_ray, start) = self.box_ray(ray)?;
        let length = ray.direction.length();
        let mut best: Option<(&Triangle, f64)> = None;
        let mut hit = RayHit::none();
        self.tree.ray_traverse(box_ray, &mut hit, |_, i| {
            let triangle = &self.triangles[i];
            let seen = triangle.seen_from(ray.origin);
            if !seen.is_hit(ray.direction, ray.t_min, ray.t_max) || Some(triangle.id) == own {
                return f32::INFINITY;
            }
            let t = seen.distance(ray.direction);
            let nearer = best.is_none_or(|(b, so_far)| t < so_far || (t == so_far && triangle.id < b.id));
            if !nearer || !opacity.stops(triangle, &seen, ray.direction) {
                return f32::INFINITY;
            }
            best = Some((triangle, t));
            self.rounded_up(t * length - start)
        });
        best
    }

    /// The triangles that may touch the shaft, up to `most` of them; `None` where there are more.
    pub fn within(&self, shaft: &Shaft, most: usize, into: &mut Vec<u32>) -> Option<()> {
        into.clear();
        let mut pending = Vec::with_capacity(64);
        pending.extend((!self.tree.nodes.is_empty()).then_some(0_u32));
        while let Some(node) = pending.pop().and_then(|i| self.tree.nodes.get(i as usize)) {
            let bounds = node.aabb();
            let [min, max] = [bounds.min, bounds.max].map(|v| DVec3::from_array(v.to_array().map(f64::from)));
            if !shaft.may_touch_box(min, max) {
                continue;
            }
            if !node.is_leaf() {
                pending.extend([node.first_index, node.first_index + 1]);
                continue;
            }
            let leaf = node.first_index..node.first_index + node.prim_count;
            into.extend(leaf.filter(|&i| shaft.may_touch_triangle(self.triangles[i as usize].corners())));
            if into.len() > most {
                return None;
            }
        }
        Some(())
    }

    /// The triangle of an index that [`Bvh::within`] gave.
    pub fn triangle(&self, index: u32) -> &Triangle {
        &self.triangles[index as usize]
    }

    /// The ray for the boxes, and how far along it starts: where it comes near them. Its t is the
    /// length from there. `None` where it surely misses them all or has no direction.
    fn box_ray(&self, ray: &Ray) -> Option<(BoxRay, f64)> {
        let length = ray.direction.length();
        let direction = ray.direction / length;
        if !(direction.is_finite() && ray.origin.is_finite()) {
            return None;
        }
        // All triangles are within √3 largest coordinates around the origin; no ray enters earlier
        // than at `start`.
        let reach = 1.8 * self.largest;
        let middle = -ray.origin.dot(direction);
        if (ray.origin + direction * middle).length_squared() > reach * reach {
            return None;
        }
        let start = (middle - reach).max(0.0);
        let t_max = ray.t_max * length - start;
        let origin = vector(ray.origin + direction * start);
        let far_behind = middle < -reach;
        let t_max = (t_max > 0.0 && !far_behind).then(|| self.rounded_up(t_max))?;
        Some((BoxRay::new(origin, vector(direction), 0.0, t_max), start))
    }

    fn rounded_up(&self, length: f64) -> f32 {
        (length * (1.0 + 1e-6) + PADDING * self.largest) as f32
    }
}

/// The hierarchy over `boxes`: `obvhs::bvh2::builder::build_bvh2` without the clock that it reads,
/// since browsers have none where it looks.
fn build(boxes: &[Padded]) -> Bvh2 {
    let params = BvhBuildParams::medium_build();
    let numbers = (0..boxes.len() as u32).collect();
    let mut tree = PlocBuilder::with_capacity(boxes.len()).build(
        params.ploc_search_distance,
        boxes,
        numbers,
        params.sort_precision,
        params.search_depth_threshold,
    );
    let again = params.reinsertion_batch_ratio * params.post_collapse_reinsertion_batch_ratio_multiplier;
    let mut optimizer = ReinsertionOptimizer::default();
    optimizer.run(&mut tree, params.reinsertion_batch_ratio, None);
    collapse(&mut tree, params.max_prims_per_leaf.clamp(1, 255), params.collapse_traversal_cost);
    optimizer.run(&mut tree, again, None);
    tree
}

/// A vector of the hierarchy's crate, which may have another version of `glam` than we have.
fn vector<V: From<[f32; 3]>>(v: DVec3) -> V {
    v.as_vec3().to_array().into()
}

/// The box of a triangle, grown.
struct Padded(Aabb);

impl Padded {
    fn around(triangle: &Triangle, margin: f64) -> Self {
        let [a, b, c] = *triangle.corners();
        Self(Aabb::new(vector(a.min(b).min(c) - margin), vector(a.max(b).max(c) + margin)))
    }
}

impl Boundable for Padded {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    struct Opaque;

    impl Opacity for Opaque {
        fn stops(&self, _: &Triangle, _: &SeenTriangle, _: DVec3) -> bool {
            true
        }
    }

    fn point() -> impl Strategy<Value = DVec3> {
        // Whole numbers give boxes that are flat and share their sides.
        let coordinate = || prop_oneof![-1.0..1.0, (-2..3).prop_map(f64::from)];
        (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// Rays that just touch corners and edges of boxes, from near and from far.
        #[test]
        fn the_hierarchy_finds_what_testing_every_triangle_finds(
            corners in prop::collection::vec((point(), point(), point()), 1..24),
            chosen: prop::sample::Index, share in 0.0..=1.0, from in point(), distance in 0.5..1e4,
        ) {
            let triangles: Vec<Triangle> = corners
                .iter()
                .zip(0..)
                .filter_map(|(&(a, b, c), id)| Triangle::new([a, b, c], id, Triangle::OPAQUE))
                .collect();
            let (a, b, c) = corners[chosen.index(corners.len())];
            // Inside the triangle by less than single precision resolves.
            let target = a.lerp(b, share).lerp(c, 1e-9);
            let origin = from * distance;
            let ray = Ray { origin, direction: target - origin, t_min: 0.0, t_max: 1.0 + 1e-12 };
            let hits = |t: &Triangle| t.seen_from(origin).is_hit(ray.direction, ray.t_min, ray.t_max);
            let bvh = Bvh::new(triangles.clone());
            prop_assert_eq!(bvh.is_blocked(&ray, None, &Opaque), triangles.iter().any(hits));
            let nearest = triangles.iter().filter(|t| hits(t)).map(|t| t.seen_from(origin).distance(ray.direction));
            prop_assert_eq!(bvh.first(&ray, None, &Opaque).map(|(_, t)| t), nearest.min_by(f64::total_cmp));
        }
    }
}

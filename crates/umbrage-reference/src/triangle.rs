//! Triangles in double precision, and the rays that meet them.

use glam::DVec3;

/// A straight way: the points `origin + t · direction`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    /// Where t = 0.
    pub origin: DVec3,
    /// From t = 0 to t = 1; of any length.
    pub direction: DVec3,
    /// Hits at or before this t do not count.
    pub t_min: f64,
    /// Hits at or after this t do not count.
    pub t_max: f64,
}

/// A triangle relative to the scene's centre.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    corners: [DVec3; 3],
    /// Its normal, twice as long as its area is large.
    normal: DVec3,
    /// Its number in the scene.
    pub id: u32,
    /// Index of its cut-out, or [`Triangle::OPAQUE`].
    pub cutout: u32,
}

impl Triangle {
    /// [`Triangle::cutout`] of a triangle without holes.
    pub const OPAQUE: u32 = u32::MAX;

    /// `None` for triangles without area and for corners that are not finite or farther off than
    /// single-precision boxes can hold.
    pub fn new(corners: [DVec3; 3], id: u32, cutout: u32) -> Option<Self> {
        /// Metres. Areas of boxes this large are still finite in single precision.
        const FARTHEST: f64 = 1e18;
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let near = corners.iter().all(|p| p.abs().max_element() < FARTHEST);
        (near && normal.length_squared() > 0.0).then_some(Self { corners, normal, id, cutout })
    }

    pub fn corners(&self) -> &[DVec3; 3] {
        &self.corners
    }

    /// Unit length; on the side from which the corners go counter-clockwise.
    pub fn unit_normal(&self) -> DVec3 {
        self.normal.normalize_or(DVec3::Y)
    }

    /// What all rays from one point have in common.
    #[inline]
    pub fn seen_from(&self, origin: DVec3) -> SeenTriangle {
        let [a, b, c] = self.corners;
        let (a, b, c) = (a - origin, b - origin, c - origin);
        SeenTriangle { normal: self.normal, height: a.dot(self.normal), sides: [c.cross(b), a.cross(c), b.cross(a)] }
    }
}

/// A triangle as seen from the origin of rays.
///
/// The planes through the origin and an edge are computed from the edge's ends alone, in either
/// order to the last bit apart from the sign, so that no ray slips through between triangles that
/// share an edge (compare Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", 2013).
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenTriangle {
    normal: DVec3,
    /// Corner · normal.
    height: f64,
    /// Normals of the planes through the origin and the edges opposite to the corners.
    sides: [DVec3; 3],
}

impl SeenTriangle {
    /// True where the ray meets it, from either side, with t between `t_min` and `t_max`.
    #[inline]
    pub fn is_hit(&self, direction: DVec3, t_min: f64, t_max: f64) -> bool {
        let slope = direction.dot(self.normal);
        // height / slope without the division; all is false for a ray along the plane.
        let (near, far) = (t_min * slope, t_max * slope);
        let within =
            if slope > 0.0 { near < self.height && self.height < far } else { near > self.height && self.height > far };
        within && {
            let [a, b, c] = self.sides;
            let (u, v, w) = (a.dot(direction), b.dot(direction), c.dot(direction));
            (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0)
        }
    }

    /// The t of a ray along `direction` that meets it.
    pub fn distance(&self, direction: DVec3) -> f64 {
        self.height / direction.dot(self.normal)
    }

    /// Barycentric coordinates of the point where a ray along `direction` meets it.
    pub fn barycentric(&self, direction: DVec3) -> [f64; 3] {
        let shares = self.sides.map(|s| s.dot(direction));
        let sum: f64 = shares.iter().sum();
        if sum == 0.0 { [1.0, 0.0, 0.0] } else { shares.map(|s| s / sum) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn triangle(corners: [DVec3; 3]) -> Triangle {
        Triangle::new(corners, 0, Triangle::OPAQUE).expect("a triangle with area")
    }

    #[test]
    fn a_hit_has_its_distance_and_barycentric_coordinates() {
        let t = triangle([DVec3::ZERO, DVec3::X, DVec3::Y]);
        let seen = t.seen_from(DVec3::new(0.25, 0.125, 3.0));
        let down = DVec3::NEG_Z * 2.0;
        assert!(seen.is_hit(down, 0.0, 2.0) && seen.is_hit(down, 1.4, 1.6));
        assert!(!seen.is_hit(down, 1.5, 2.0) && !seen.is_hit(down, 0.0, 1.5) && !seen.is_hit(-down, 0.0, 9.0));
        assert_eq!(seen.distance(down), 1.5);
        assert_eq!(seen.barycentric(down), [0.625, 0.25, 0.125]);
        assert!(!seen.is_hit(DVec3::X, 0.0, f64::INFINITY), "a ray along the plane");
    }

    #[test]
    fn triangles_without_area_or_place_are_none() {
        let bad = [
            [DVec3::ZERO, DVec3::X, DVec3::X * 2.0],
            [DVec3::ZERO, DVec3::X, DVec3::NAN],
            [DVec3::ZERO, DVec3::X, DVec3::Y * f64::INFINITY],
            [DVec3::ZERO, DVec3::X * 1e30, DVec3::Y * 1e30],
        ];
        for corners in bad {
            assert!(Triangle::new(corners, 0, Triangle::OPAQUE).is_none(), "{corners:?}");
        }
    }

    fn point() -> impl Strategy<Value = DVec3> {
        (-1.0..1.0, -1.0..1.0, -1.0..1.0).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        /// Rays to points of an edge hit at least one of the two triangles that share it.
        #[test]
        fn no_ray_slips_through_a_shared_edge(
            a in point(), b in point(), c in point(), d in point(), eye in point(), t in 0.0..1.0,
        ) {
            let eye = eye + DVec3::splat(3.0);
            let (p, q) = ([a, b, c], [b, a, d]);
            let edge_normal = (a - eye).cross(b - eye);
            // Only where the triangles lie on different sides of the edge as seen from the eye.
            prop_assume!(edge_normal.dot(c - eye) * edge_normal.dot(d - eye) < -1e-6);
            let (Some(p), Some(q)) = (Triangle::new(p, 0, 0), Triangle::new(q, 1, 0)) else { return Ok(()) };
            let direction = a.lerp(b, t) - eye;
            let hit = [p, q].iter().any(|x| x.seen_from(eye).is_hit(direction, 0.0, 2.0));
            prop_assert!(hit);
        }
    }
}

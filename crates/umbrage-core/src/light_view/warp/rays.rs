//! The rays of a light as points of a plane.

use super::super::perspective::WIDEST;
use glam::{DVec2, DVec3, DVec4};

/// Homogeneous coordinates of the rays of a light: three functions of a point, linear in (p, 1),
/// that do not change towards the light but for a common factor. The last one is positive before
/// the light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rays {
    pub axes: [DVec4; 3],
    /// The light's centre.
    pub light: DVec4,
    /// Where parallel rays are counted from.
    origin: DVec3,
}

impl Rays {
    /// Of a light that travels along `direction`, near `points`.
    pub fn parallel(direction: DVec3, points: &[DVec3]) -> Self {
        let origin = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
        let right = direction.any_orthonormal_vector();
        let axis = |axis: DVec3| axis.extend(-axis.dot(origin));
        Self { axes: [axis(right), axis(right.cross(direction)), DVec4::W], light: (-direction).extend(0.0), origin }
    }

    /// Of a light at `position`, around `forward`.
    pub fn from_point(position: DVec3, forward: DVec3, up: DVec3) -> Self {
        let right = forward.cross(up).normalize_or(forward.any_orthonormal_vector());
        let axis = |axis: DVec3| axis.extend(-axis.dot(position));
        let axes = [right, right.cross(forward), forward].map(axis);
        Self { axes, light: position.extend(1.0), origin: position }
    }

    pub fn is_parallel(&self) -> bool {
        self.light.w == 0.0
    }

    /// The ray through a point that is before the light. Rounding beside a light may not put it
    /// anywhere.
    pub fn of(&self, point: DVec3) -> DVec2 {
        let [x, y, ahead] = self.axes.map(|a| a.dot(point.extend(1.0)));
        let ray = DVec2::new(x, y) / ahead.max(f64::MIN_POSITIVE);
        if self.is_parallel() { ray } else { ray.clamp(DVec2::splat(-WIDEST), DVec2::splat(WIDEST)) }
    }

    /// How the ray changes when the point moves.
    pub fn change(&self, point: DVec3, way: DVec3) -> DVec2 {
        let ray = self.of(point);
        let [x, y, ahead] = self.axes.map(|a| a.truncate().dot(way));
        let distance = self.axes[2].dot(point.extend(1.0)).max(f64::MIN_POSITIVE);
        (DVec2::new(x, y) - ray * ahead) / distance
    }

    /// Whether a point is before the light and no farther off its axis than this tangent.
    pub fn sees(&self, point: DVec3, tangent: f64) -> bool {
        let [x, y, ahead] = self.axes.map(|a| a.dot(point.extend(1.0)));
        x.abs().max(y.abs()) <= tangent * ahead
    }

    /// A plane through the light in these coordinates.
    pub fn coordinates(&self, plane: DVec4) -> DVec3 {
        let [x, y, ahead] = self.axes.map(|a| a.truncate().dot(plane.truncate()));
        DVec3::new(x, y, if self.is_parallel() { plane.dot(self.origin.extend(1.0)) } else { ahead })
    }

    /// The plane with these coordinates.
    pub fn plane(&self, coordinates: DVec3) -> DVec4 {
        self.axes[0] * coordinates.x + self.axes[1] * coordinates.y + self.axes[2] * coordinates.z
    }

    /// The way to the light from a point, unit length.
    pub fn toward_light(&self, point: DVec3) -> DVec3 {
        (self.light.truncate() - point * self.light.w).normalize_or(DVec3::Y)
    }
}

/// The corners of the convex hull of points of a plane, counter-clockwise (Andrew's monotone
/// chain).
pub(super) fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.retain(|p| p.is_finite());
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut corners: Vec<DVec2> = Vec::new();
    let chain = |points: &mut dyn Iterator<Item = &DVec2>, corners: &mut Vec<DVec2>| {
        let first = corners.len();
        for &p in points {
            while let [.., a, b] = corners[first..] {
                if (b - a).perp_dot(p - b) > 0.0 {
                    break;
                }
                corners.pop();
            }
            corners.push(p);
        }
        // The last one begins the next chain.
        corners.pop();
    };
    chain(&mut points.iter(), &mut corners);
    chain(&mut points.iter().rev(), &mut corners);
    corners
}

/// The part of a convex polygon where a function of the rays is not negative.
pub(super) fn cut(polygon: &[DVec2], coordinates: DVec3) -> Vec<DVec2> {
    let side = |p: DVec2| coordinates.dot(p.extend(1.0));
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (at_a, at_b) = (side(a), side(b));
        if at_a >= 0.0 {
            kept.push(a);
        }
        if (at_a >= 0.0) != (at_b >= 0.0) {
            kept.push(a + (b - a) * (at_a / (at_a - at_b)));
        }
    }
    kept
}

//! Visibilities that have a formula: what the tracer is tested against.
//!
//! A straight edge cuts from what a point sees everything on one side of the plane through the
//! point and the edge. So does the point's own horizon. The functions here give the share of a
//! light above such a plane.

use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// How wide, metres, the penumbra of an edge is where the light's rays meet the surface at a right
/// angle: of a light of this radius at `distance`, past a blocker `gap` metres from the surface.
/// Of a sun, whose `distance` is infinite, the radius is the tangent of half its angle.
pub fn penumbra_width(radius: f64, distance: f64, gap: f64) -> f64 {
    if distance.is_infinite() { 2.0 * radius * gap } else { 2.0 * radius * gap / (distance - gap) }
}

/// The share of a disc's area on one side of a straight line, where (q − centre) · normal >
/// `distance` in units of the radius: the circular segment. 1 from −1 on down, 0 from 1 on up.
pub fn disc_beyond_line(distance: f64) -> f64 {
    let d = distance.clamp(-1.0, 1.0);
    (d.acos() - d * (1.0 - d * d).sqrt()) / PI
}

/// The share of a rectangle's area on one side of a straight line: the points q with q · `normal` >
/// `distance` of the rectangle of side lengths `size` around the origin.
///
/// `normal` is of any length, with `distance` scaled alike; if it or the size is zero, all lies
/// beyond a negative distance and nothing beyond others. A size of (s, 0) is a line.
pub fn rect_beyond_line(size: DVec2, normal: DVec2, distance: f64) -> f64 {
    // q · normal is the sum of two independent uniform variables with these half widths: a
    // trapezoid distribution.
    let half = (normal * size * 0.5).abs();
    let (wide, narrow) = (half.max_element(), half.min_element());
    // What lies beyond −d is the rest of what lies beyond d.
    let d = distance.abs();
    let beyond = if d >= wide + narrow {
        0.0
    } else if d > wide - narrow {
        (wide + narrow - d).powi(2) / (8.0 * wide * narrow)
    } else {
        0.5 - d / (2.0 * wide)
    };
    if distance < 0.0 { 1.0 - beyond } else { beyond }
}

/// The share of a disc light above the plane through `p` with the normal `up`. The disc lies around
/// `center`, perpendicular to `facing`.
pub fn disc_above_plane(p: DVec3, up: DVec3, center: DVec3, facing: DVec3, radius: f64) -> f64 {
    let facing = facing.normalize_or_zero();
    let slope = (up - facing * up.dot(facing)).length() * radius;
    let height = up.dot(center - p);
    if slope > 0.0 { disc_beyond_line(-height / slope) } else { f64::from(height > 0.0) }
}

/// The share of a sphere light above the plane through `p` with the normal `up`: that of the disc
/// that faces `p`.
pub fn sphere_above_plane(p: DVec3, up: DVec3, center: DVec3, radius: f64) -> f64 {
    disc_above_plane(p, up, center, center - p, radius)
}

/// The share of a rectangular light above the plane through `p` with the normal `up`. The light
/// lies around `center` with the given half axes; one of them zero makes it a line.
pub fn rect_above_plane(p: DVec3, up: DVec3, center: DVec3, half_axes: [DVec3; 2]) -> f64 {
    let normal = DVec2::new(up.dot(half_axes[0]), up.dot(half_axes[1]));
    rect_beyond_line(DVec2::splat(2.0), normal, -up.dot(center - p))
}

/// The normal, on the lit side, of the plane through `p` and a blocker's straight edge: the blocker
/// is a half-plane that ends at the line through `edge` along `along` and extends from there
/// towards `into`.
///
/// What is above that plane, and beyond the blocker as seen from `p`, is what `p` sees. Zero for a
/// `p` on the edge's line.
pub fn past_half_plane(p: DVec3, edge: DVec3, along: DVec3, into: DVec3) -> DVec3 {
    let normal = along.cross(edge - p).normalize_or_zero();
    if normal.dot(into) > 0.0 { -normal } else { normal }
}

/// The polygon in which a point light shadows the plane y = 0 behind a convex body: the hull of its
/// corners' projections, counter-clockwise as points (x, z).
///
/// `None` where a corner is not below the light or is under the plane, since the shadow is no
/// polygon then, and where there are fewer than three different projections.
pub fn shadow_on_ground(light: DVec3, corners: &[DVec3]) -> Option<Vec<DVec2>> {
    if !corners.iter().all(|c| c.y < light.y && c.y >= 0.0) {
        return None;
    }
    let project = |c: &DVec3| {
        let p = light + (*c - light) * (light.y / (light.y - c.y));
        DVec2::new(p.x, p.z)
    };
    convex_hull(corners.iter().map(project).collect())
}

/// True inside a convex polygon that goes counter-clockwise.
pub fn is_inside(polygon: &[DVec2], point: DVec2) -> bool {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).all(|(a, b)| (b - a).perp_dot(point - a) > 0.0)
}

/// Andrew's monotone chain.
fn convex_hull(mut points: Vec<DVec2>) -> Option<Vec<DVec2>> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let mut hull = half_hull(points.iter().copied());
    hull.extend(half_hull(points.iter().rev().copied()));
    (hull.len() >= 3).then_some(hull)
}

/// The side of the hull to the right of the way from the first to the last point, without the last.
fn half_hull(points: impl Iterator<Item = DVec2>) -> Vec<DVec2> {
    let mut chain: Vec<DVec2> = Vec::new();
    for p in points {
        while let [.., a, b] = chain[..] {
            if (b - a).perp_dot(p - b) > 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(p);
    }
    chain.pop();
    chain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_a_disc_and_all_of_it() {
        assert_eq!([-1.0, -7.0, 1.0, 7.0].map(disc_beyond_line), [1.0, 1.0, 0.0, 0.0]);
        assert!((disc_beyond_line(0.0) - 0.5).abs() < 1e-15);
        // A segment of 120 degrees.
        assert!((disc_beyond_line(0.5) - (1.0 / 3.0 - 3.0f64.sqrt() / (4.0 * PI))).abs() < 1e-15);
    }

    #[test]
    fn a_penumbra_is_as_wide_as_the_lines_past_the_edge_to_both_ends_of_the_light_say() {
        // The light from −1 to 1 at height 4, the edge at 0 and height 1.
        let [left, right] = [-1.0, 1.0].map(|x: f64| -x / 3.0);
        assert!((penumbra_width(1.0, 4.0, 1.0) - (left - right)).abs() < 1e-15);
        assert_eq!(penumbra_width(1.0, 4.0, 0.0), 0.0);
        // A sun is a light far away of as large an angle.
        assert!((penumbra_width(0.01, f64::INFINITY, 3.0) - penumbra_width(1e6, 1e8, 3.0)).abs() < 1e-8);
    }

    #[test]
    fn a_rectangle_is_cut_as_counting_cells_cuts_it() {
        let size = DVec2::new(3.0, 0.5);
        for normal in [DVec2::X, DVec2::Y, DVec2::new(0.3, 0.8), DVec2::new(-0.1, 0.9)] {
            for distance in [-3.0, -0.4, -0.05, 0.0, 0.1, 0.33, 2.0] {
                let n = 400;
                let cell = |i: i32, j: i32| (DVec2::new(f64::from(i), f64::from(j)) + 0.5) / f64::from(n) - 0.5;
                let beyond = (0..n * n).filter(|k| (cell(k % n, k / n) * size).dot(normal) > distance).count();
                let (got, want) = (rect_beyond_line(size, normal, distance), beyond as f64 / f64::from(n * n));
                assert!((got - want).abs() < 3e-3, "{normal} at {distance}: {got} instead of {want}");
            }
        }
        assert_eq!([-1.0, 0.0, 1.0].map(|d| rect_beyond_line(size, DVec2::ZERO, d)), [1.0, 0.0, 0.0]);
        assert_eq!(rect_beyond_line(DVec2::new(2.0, 0.0), DVec2::X, 0.5), 0.25);
    }

    #[test]
    fn the_shadow_of_a_box_straight_below_the_light() {
        let corners = umbrage_core::Bounds { min: DVec3::new(-1.0, 0.0, -1.0), max: DVec3::ONE }.corners();
        let polygon = shadow_on_ground(DVec3::Y * 2.0, &corners).unwrap_or_default();
        let want = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)].map(DVec2::from);
        assert_eq!(polygon, want);
        assert!(is_inside(&polygon, DVec2::new(1.9, -1.9)) && !is_inside(&polygon, DVec2::new(2.1, 0.0)));
        assert_eq!(shadow_on_ground(DVec3::Y, &corners), None);
        assert_eq!(shadow_on_ground(DVec3::Y * 2.0, &corners[..2]), None);
    }
}

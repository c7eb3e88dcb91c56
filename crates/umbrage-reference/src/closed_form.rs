//! Visibilities that have a formula.

use glam::DVec2;
use std::f64::consts::PI;

/// The share of a disc's area that lies on one side of a straight line: where (q − centre) · normal > `distance`, which
/// is in units of the radius. The circular segment.
///
/// From −1 on down it is 1, from 1 on up 0.
pub fn disc_beyond_line(distance: f64) -> f64 {
    let d = distance.clamp(-1.0, 1.0);
    (d.acos() - d * (1.0 - d * d).sqrt()) / PI
}

/// The share of a rectangle's area that lies on one side of a straight line: the points q with
/// q · `normal` > `distance`, for the rectangle of full side lengths `size` around the origin.
///
/// `normal` need not be of unit length if `distance` is scaled with it; zero has nothing beyond a distance ≥ 0.
pub fn rect_beyond_line(size: DVec2, normal: DVec2, distance: f64) -> f64 {
    // q · normal is the sum of two independent uniform variables: a trapezoid distribution with these half widths.
    let half = (normal * size * 0.5).abs();
    let (wide, narrow) = (half.max_element(), half.min_element());
    // Beyond d > 0 lies what is not beyond −d, by symmetry.
    let d = distance.abs();
    let beyond = if d >= wide + narrow {
        0.0
    } else if d >= wide - narrow && narrow > 0.0 {
        (wide + narrow - d).powi(2) / (8.0 * wide * narrow)
    } else {
        0.5 - d / (2.0 * wide)
    };
    if distance < 0.0 { 1.0 - beyond } else { beyond }
}

/// The visibility of a sphere light at `center` (radius `radius`) from the origin past a half-plane: everything at
/// `center`'s side... 
pub fn placeholder() {}

/// The polygon in which a point light shadows the plane y = 0 behind a convex body: the convex hull of its corners'
/// projections from the light, counter-clockwise seen from −y (as x, z).
///
/// All corners are below the light and on or above the plane; otherwise the shadow is no polygon and the result is
/// `None`, as it is for fewer than three different projections.
pub fn shadow_on_ground(light: glam::DVec3, corners: &[glam::DVec3]) -> Option<Vec<DVec2>> {
    if !corners.iter().all(|c| c.y < light.y && c.y >= 0.0) {
        return None;
    }
    let project = |c: &glam::DVec3| {
        let p = light + (*c - light) * (light.y / (light.y - c.y));
        DVec2::new(p.x, p.z)
    };
    convex_hull(corners.iter().map(project).collect())
}

/// Andrew's monotone chain.
fn convex_hull(mut points: Vec<DVec2>) -> Option<Vec<DVec2>> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
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
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    (hull.len() >= 3).then_some(hull)
}

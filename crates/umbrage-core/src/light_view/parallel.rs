//! Orthographic views of parallel light.

use super::rect::{Crop, Rect, Steps};
use super::{Fit, FitScene, Focus, LightView};
use crate::{bounds::Bounds, frustum::Frustum};
use glam::{DMat4, DVec2, DVec3, DVec4};

/// The view of a light at infinity that travels along `direction`.
pub(super) fn view(direction: DVec3, seen: &Frustum, scene: &FitScene, fit: &Fit) -> Option<LightView> {
    let mut points = Vec::new();
    match fit.focus {
        Focus::Light => points.extend(scene.receivers.iter().flat_map(Bounds::corners)),
        Focus::Visible => scene.receivers.iter().for_each(|b| seen.clip_box(b, &mut points)),
    }
    let (right, up) = tightest_axes(direction, &points, fit.focus);
    let rect = Rect::of(points.iter().map(|p| DVec2::new(right.dot(*p), up.dot(*p))))?.grown(fit.border_m);
    // Heights along the way the light travels: from the first caster to the last receiver.
    let height = |p: DVec3| direction.dot(p);
    let last = points.iter().map(|p| height(*p)).fold(f64::NEG_INFINITY, f64::max);
    let corners = scene.casters.iter().flat_map(Bounds::corners).chain(points.iter().copied());
    let first = corners.map(height).fold(f64::INFINITY, f64::min);
    let crop = Crop::to(rect, fit);
    Some(LightView::of(crop.matrix() * light_from_world([right, up, direction], [first, last]), fit.size, 0))
}

/// The view of a light at infinity that stands still: its texels lie on a grid that depends on
/// their size alone, and its heights are those of everything. `center` and `radius` are of what it
/// has to show.
pub(super) fn steady(
    direction: DVec3,
    (center, radius): (DVec3, f64),
    scene: &FitScene,
    steps: &Steps,
    fit: &Fit,
) -> LightView {
    let (right, up) = (direction.any_orthonormal_vector(), direction.any_orthonormal_vector().cross(direction));
    let rect = steps.rect(DVec2::new(right.dot(center), up.dot(center)), radius + fit.border_m, fit);
    let heights = scene.around.corners().map(|p| direction.dot(p));
    let ends =
        [heights.into_iter().fold(f64::INFINITY, f64::min), heights.into_iter().fold(f64::NEG_INFINITY, f64::max)];
    LightView::of(Crop::whole(rect).matrix() * light_from_world([right, up, direction], ends), fit.size, 0)
}

/// World to a space whose depth falls from 1 at the first of two heights along the light to 0 at
/// the last, and a little more to both sides.
fn light_from_world([right, up, direction]: [DVec3; 3], [first, last]: [f64; 2]) -> DMat4 {
    let margin = ((last - first) * 1e-4).max(1e-9 * (1.0 + first.abs().max(last.abs())));
    let (first, last) = (first - margin, last + margin);
    let depth = 1.0 / (last - first);
    DMat4::from_cols(
        right.extend(0.0),
        up.extend(0.0),
        (-direction * depth).extend(last * depth),
        DVec4::new(0.0, 0.0, 0.0, 1.0),
    )
    .transpose()
}

/// The points that lie farthest along `u` to either side.
fn ends(u: DVec2, points: &[DVec2]) -> [Option<DVec2>; 2] {
    let mut ends = [(None, f64::INFINITY), (None, f64::NEG_INFINITY)];
    for p in points {
        let along = u.dot(*p);
        if along < ends[0].1 {
            ends[0] = (Some(*p), along);
        }
        if along > ends[1].1 {
            ends[1] = (Some(*p), along);
        }
    }
    ends.map(|(end, _)| end)
}

/// Two axes across `direction` that give the points a small rectangle. A focus on the light keeps
/// fixed axes, so that the map does not turn with the camera.
fn tightest_axes(direction: DVec3, points: &[DVec3], focus: Focus) -> (DVec3, DVec3) {
    let a = direction.any_orthonormal_vector();
    let b = a.cross(direction);
    let axes = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        (a * cos + b * sin, b * cos - a * sin)
    };
    if focus == Focus::Light {
        return axes(0.0);
    }
    // A few extreme points in fixed directions stand for the hull.
    let flat: Vec<DVec2> = points.iter().map(|p| DVec2::new(a.dot(*p), b.dot(*p))).collect();
    let directions = (0..16).map(|i| DVec2::from_angle(std::f64::consts::PI * f64::from(i) / 16.0));
    let hull: Vec<DVec2> = directions.flat_map(|u| ends(u, &flat)).flatten().collect();
    let area = |angle: f64| {
        let u = DVec2::from_angle(angle);
        Rect::of(hull.iter().map(|p| DVec2::new(u.dot(*p), u.perp_dot(*p))))
            .map_or(0.0, |r| (r.max - r.min).element_product())
    };
    let best = (0..24)
        .map(|i| std::f64::consts::FRAC_PI_2 * f64::from(i) / 24.0)
        .min_by(|x, y| area(*x).total_cmp(&area(*y)))
        .unwrap_or(0.0);
    axes(best)
}

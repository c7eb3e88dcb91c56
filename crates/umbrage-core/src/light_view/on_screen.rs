//! How large texels are on the screen.

use super::LightView;
use crate::camera::CameraView;
use glam::{DMat4, DVec2, DVec3};

/// The view that counts at `point`; `None` where none covers it.
///
/// `splits` are distances along the camera's view, ascending, at which the view of one layer ends
/// and that of the next begins, unless that has a [`LightView::steady_border`] and the point is
/// inside of it; without any the first view that covers the point counts.
pub fn view_at<'a>(views: &'a [LightView], splits: &[f64], camera: &CameraView, point: DVec3) -> Option<&'a LightView> {
    let distance = -camera.view_from_world.transform_point3(point).z;
    let layer = splits.iter().filter(|split| distance >= **split).count() as u32;
    let is_within = |v: &LightView, border: f64| {
        let most = 1.0 - 2.0 * border / f64::from(v.size);
        v.project(point).is_some_and(|p| p.x.abs() <= most && p.y.abs() <= most)
    };
    let is_used = |v: &LightView| splits.is_empty() || v.layer == layer;
    let goes_on = |v: &LightView| v.layer + 1 == layer && v.steady_border.is_some_and(|border| is_within(v, border));
    let finer = views.iter().find(|v| goes_on(v));
    finer.or_else(|| views.iter().find(|v| is_used(v) && is_within(v, 0.0)))
}

/// How far, in pixels, one texel of the map that covers `point` reaches on the screen along the
/// surface there with `normal`: the largest singular value of ∂pixel/∂texel. `None` where no view
/// covers the point.
///
/// The view is that of [`view_at`].
pub fn texel_on_screen(
    views: &[LightView],
    splits: &[f64],
    camera: &CameraView,
    (width, height): (u32, u32),
    point: DVec3,
    normal: DVec3,
) -> Option<f64> {
    let view = view_at(views, splits, camera, point)?;
    let (s, t) = normal.try_normalize()?.any_orthonormal_pair();
    let half = |w: u32, h: u32| DVec2::new(f64::from(w), f64::from(h)) * 0.5;
    let texels = [s, t].map(|a| change(&view.tangent_at(point), half(view.size, view.size), point, a));
    let pixels = [s, t].map(|a| change(&camera.clip_from_world(), half(width, height), point, a));
    Some(largest(texels, pixels))
}

/// How far, in metres, one texel of `view` reaches at `point` across `way`, the direction to the
/// light. Infinite where the view sees nothing across it.
pub fn texel_across(view: &LightView, point: DVec3, way: DVec3) -> f64 {
    let Some(way) = way.try_normalize() else { return f64::INFINITY };
    let (s, t) = way.any_orthonormal_pair();
    let half = DVec2::splat(f64::from(view.size) * 0.5);
    let texels = [s, t].map(|a| change(&view.tangent_at(point), half, point, a));
    largest(texels, [DVec2::X, DVec2::Y])
}

/// Change of the place in a picture when the point moves along an axis of the surface.
fn change(clip_from_world: &DMat4, scale: DVec2, point: DVec3, axis: DVec3) -> DVec2 {
    let (p, d) = (*clip_from_world * point.extend(1.0), *clip_from_world * axis.extend(0.0));
    (d.truncate().truncate() * p.w - p.truncate().truncate() * d.w) / (p.w * p.w) * scale
}

/// The largest singular value of ∂`to`/∂`from`, both given as changes along the same two axes.
fn largest(from: [DVec2; 2], to: [DVec2; 2]) -> f64 {
    let det = from[0].perp_dot(from[1]);
    if det.abs() < f64::MIN_POSITIVE {
        return f64::INFINITY;
    }
    let x = (to[0] * from[1].y - to[1] * from[0].y) / det;
    let y = (to[1] * from[0].x - to[0] * from[1].x) / det;
    // That of the 2×2 matrix with columns x and y.
    let (sum, product) = (x.length_squared() + y.length_squared(), x.perp_dot(y));
    ((sum + (sum * sum - 4.0 * product * product).max(0.0).sqrt()) * 0.5).sqrt()
}

//! How near to the light casters may be in a view, from the boxes around them.

use super::texels::near;
use umbrage_core::Bounds;
use umbrage_core::glam::DVec3;
use umbrage_core::light_view::LightView;

/// The largest depth that the map of a view can hold, from the boxes around the casters. Of views
/// from a point: near / distance, not along the axis.
pub(super) fn nearest(view: &LightView, casters: &[Bounds]) -> f32 {
    let deepest = match view.is_perspective() {
        true => near(view) / nearest_distance(view, casters),
        false => first_depth(view, casters),
    };
    deepest.clamp(0.0, 1.0) as f32
}

/// From the light to the nearest caster that the view may show, at least that of the near plane;
/// infinity without any.
pub(super) fn nearest_distance(view: &LightView, casters: &[Bounds]) -> f64 {
    let (frustum, light) = (view.frustum(), view.eye());
    let seen = casters.iter().filter(|b| frustum.may_see(b));
    let distances = seen.map(|b| light.distance(light.clamp(b.min, b.max)));
    distances.fold(f64::INFINITY, f64::min).max(near(view))
}

/// The largest depth in a parallel view.
pub(super) fn first_depth(view: &LightView, casters: &[Bounds]) -> f64 {
    let depth = view.clip_from_world.row(2);
    let corners = casters.iter().flat_map(Bounds::corners);
    corners.map(|c: DVec3| depth.dot(c.extend(1.0))).fold(0.0, f64::max).min(1.0)
}

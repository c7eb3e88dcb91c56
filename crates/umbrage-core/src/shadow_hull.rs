//! Which casters can matter: to what is seen, to the near plane, to the eye, to which pixels.

use crate::{
    bounds::Bounds,
    camera::CameraView,
    view_body::ViewBody,
    volume::{Side, Volume},
};
use glam::{DVec2, DVec3, DVec4};

pub use crate::{
    convex::Convex,
    light_reach::{may_be_reached, may_light_view, reach},
};

/// Around all casters that can shadow what the camera sees of receivers: the convex hull of the
/// light's centre ([`crate::LightShape::center`]) and of the view between the nearest and the
/// farthest point of `receivers`, a box around all of them. The shadow of a caster outside misses
/// the view (PX 5.4, GG 9.5.3).
///
/// `None` where the camera sees no receiver, so that no caster matters.
pub fn shadow_hull(camera: &CameraView, receivers: &Bounds, light_center: DVec4) -> Option<Convex> {
    soft_shadow_hull(camera, receivers, &[light_center])
}

/// The same for a light that is spread out: `light` are points (w = 1) or directions (w = 0) whose
/// hull holds it.
pub fn soft_shadow_hull(camera: &CameraView, receivers: &Bounds, light: &[DVec4]) -> Option<Convex> {
    let view = ViewBody::of(camera);
    let receivers = view.relative_box(receivers);
    view.clip_corners(&receivers)?;
    let [first, last] = view.depths(&receivers);
    let (first, last) = (view.near.max(first), view.far.min(last));
    if first > last {
        return None;
    }
    let (near, far) = (view.at(first), view.at(last));
    // Planes of the view alone don't tell apart a large box that is around its apex.
    let seen = Bounds::of(near.into_iter().chain(far));
    if seen.grown(1e-12 * seen.largest_coordinate()).side(&receivers) == Side::Outside {
        return None;
    }
    let seen = near.into_iter().chain(far).map(|p| p.extend(1.0));
    let points: Vec<DVec4> = seen.chain(light.iter().map(|p| view.relative(*p))).collect();
    Some(Convex::hull_about(camera.eye, &points))
}

/// The side of `seen`, a box that holds all rays from the eye to what they end at, where the shadow
/// of the box `bounds` leaves it soonest, as n · p = w: what lies beyond counts for nothing. Zero
/// where the shadow leaves the box through several sides.
pub fn shadow_end(seen: &Bounds, bounds: &Bounds, light_center: DVec4) -> DVec4 {
    let light = light_center.truncate();
    let middle = bounds.center() * light_center.w - light;
    // How far each face of the caster's box is from the light, and how many times as far the
    // shadow's middle leaves.
    let (low, high) = (bounds.min * light_center.w - light, bounds.max * light_center.w - light);
    let (to_low, to_high) = (seen.min - bounds.center(), seen.max - bounds.center());
    // Not so steep that rounding moves where a ray meets the side.
    let least = 1e-3 * middle.length();
    let mut best = (f64::INFINITY, DVec4::ZERO);
    for (axis, normal) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
        let (times, end) = if low[axis] > least {
            (to_high[axis] / middle[axis], normal.extend(seen.max[axis]))
        } else if high[axis] < -least {
            (to_low[axis] / middle[axis], (-normal).extend(-seen.min[axis]))
        } else {
            continue;
        };
        if times < best.0 {
            best = (times, end);
        }
    }
    best.1
}

/// The occlusion pyramid (GG 9.5.4): the hull of the light's centre, the eye and the near
/// rectangle. A caster outside shadows no point of either.
pub fn occlusion_pyramid(camera: &CameraView, light_center: DVec4) -> Convex {
    let view = ViewBody::of(camera);
    let near = view.at(view.near);
    let points: [DVec4; 6] = std::array::from_fn(|i| match i {
        0..4 => near[i].extend(1.0),
        4 => DVec4::W,
        _ => view.relative(light_center),
    });
    Convex::hull_about(camera.eye, &points)
}

/// True where the segment from the eye to the light, a ray for a directional one, touches the box
/// grown by `margin` metres.
pub fn segment_touches(eye: DVec3, light_center: DVec4, bounds: &Bounds, margin: f64) -> bool {
    let direction = light_center.truncate() - eye * light_center.w;
    let (mut enter, mut leave) = (0.0_f64, if light_center.w == 0.0 { f64::INFINITY } else { 1.0 });
    let (low, high) = (bounds.min - eye - margin, bounds.max - eye + margin);
    for axis in 0..3 {
        if direction[axis] == 0.0 {
            if low[axis] > 0.0 || high[axis] < 0.0 {
                return false;
            }
            continue;
        }
        let (a, b) = (low[axis] / direction[axis], high[axis] / direction[axis]);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    !bounds.is_empty() && enter <= leave
}

/// False only where the box, sent to infinity away from the light, is surely outside the view: then
/// so is the dark cap of a caster in it (GG 9.5.3). True where the light is inside the box.
pub fn dark_cap_may_be_seen(camera: &CameraView, bounds: &Bounds, light_center: DVec4) -> bool {
    if bounds.is_empty() {
        return false;
    }
    let view = ViewBody::of(camera);
    let [x, y, w] = [0, 1, 3].map(|row| view.clip_from_relative.row(row).truncate());
    let away = bounds.corners().map(|c| c * light_center.w - light_center.truncate());
    let coordinate = (bounds.largest_coordinate() * light_center.w).max(light_center.abs().max_element());
    let size = away.iter().map(|d| d.length()).fold(0.0, f64::max);
    let rounding = 1e-12 * size + 8.0 * f64::EPSILON * coordinate;
    let unseen = |normal: DVec3| away.iter().all(|d| normal.dot(*d) < -rounding * normal.length());
    ![w + x, w - x, w + y, w - y, view.forward].into_iter().any(unseen)
}

/// The pixels x, y, width, height of a picture of `size` that the box may cover, rounded outwards
/// and one more. `None` where the box is outside the view, the whole picture where the eye is in
/// the box.
pub fn screen_rect(camera: &CameraView, bounds: &Bounds, size: (u32, u32)) -> Option<[u32; 4]> {
    let view = ViewBody::of(camera);
    let relative = view.relative_box(bounds);
    if !bounds.is_empty() && relative.min.cmple(DVec3::ZERO).all() && relative.max.cmpge(DVec3::ZERO).all() {
        return (size.0 > 0 && size.1 > 0).then_some([0, 0, size.0, size.1]);
    }
    let corners = view.clip_corners(&relative)?;
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for clip in in_front(&corners, view.near_w * (1.0 - 1e-9)) {
        let ndc = DVec2::new(clip.x, -clip.y) / clip.w;
        (low, high) = (low.min(ndc), high.max(ndc));
    }
    let size = DVec2::new(size.0.into(), size.1.into());
    let pixel = |ndc: DVec2| (ndc * 0.5 + 0.5) * size;
    let first = (pixel(low).floor() - 1.0).max(DVec2::ZERO);
    let last = (pixel(high).ceil() + 1.0).min(size);
    let extent = last - first;
    extent.cmpgt(DVec2::ZERO).all().then(|| [first.x, first.y, extent.x, extent.y].map(|v| v as u32))
}

/// The corners of a box in clip space with at least this `w`, and the points at it on the edges
/// that cross.
fn in_front(corners: &[DVec4; 8], w: f64) -> impl Iterator<Item = DVec4> {
    let kept = corners.iter().copied().filter(move |c| c.w >= w);
    let edges = (0..8).flat_map(|i| [1, 2, 4].map(|bit| (i, i | bit))).filter(|(i, j)| i != j);
    let crossings = edges.filter_map(move |(i, j)| {
        let (a, b) = (corners[i], corners[j]);
        ((a.w < w) != (b.w < w)).then(|| a.lerp(b, (w - a.w) / (b.w - a.w)))
    });
    kept.chain(crossings)
}

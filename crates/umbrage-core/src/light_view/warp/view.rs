//! A map of rays as a view: with depth.

use super::super::{Fit, FitScene, LightView};
use super::flat::FlatMap;
use super::horizon::Subject;
use super::rays::Rays;
use crate::frustum::Frustum;
use glam::{DMat4, DVec3, DVec4};

/// The view of a map. From a point, depth is `near` / distance from the horizon, scaled to metres.
/// Of parallel light it is the height over the lowest receiver, over the distance from the horizon:
/// 1 for the nearest caster that the map shows, in that measure.
pub(super) fn of(
    map: &FlatMap,
    subject: &Subject<'_>,
    scene: &FitScene,
    fit: &Fit,
    near: f64,
    layer: u32,
) -> Option<LightView> {
    let rays = &subject.rays;
    let rows = map.clip_from_ray.transpose();
    let [x, y, w] = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| rays.plane(row));
    let clip_from_world = if rays.is_parallel() {
        let sides = [w + x, w - x, w + y, w - y].map(|p| p / p.truncate().length().max(f64::MIN_POSITIVE));
        let depth = height_over_horizon(rays, w, Frustum::bounded_by(sides.to_vec()), subject.points, scene)?;
        [x, y, depth, w]
    } else {
        let metres = 1.0 / w.truncate().length();
        [x * metres, y * metres, DVec4::W * near, w * metres]
    };
    let [x, y, z, w] = clip_from_world;
    let clip_from_world = DMat4::from_cols(x, y, z, w).transpose();
    clip_from_world.is_finite().then(|| LightView::of(clip_from_world, fit.size, layer))
}

/// The row of depth of parallel light: no caster in the `column` of the map is nearer than 1, no
/// receiver farther than 0.
fn height_over_horizon(rays: &Rays, w: DVec4, column: Frustum, receivers: &[DVec3], scene: &FitScene) -> Option<DVec4> {
    let up = rays.light.truncate();
    let lowest = receivers.iter().map(|p| up.dot(*p)).fold(f64::INFINITY, f64::min);
    let mut points = receivers.to_vec();
    scene.casters.iter().for_each(|b| column.clip_box(b, &mut points));
    let highest = points.iter().map(|p| up.dot(*p)).fold(lowest, f64::max);
    let margin = ((highest - lowest) * 1e-4).max(1e-9 * (1.0 + lowest.abs().max(highest.abs())));
    let height = up.extend(margin - lowest);
    let most = points.iter().map(|p| height.dot(p.extend(1.0)) / w.dot(p.extend(1.0)));
    let most = most.filter(|d| d.is_finite()).fold(0.0, f64::max);
    (most > 0.0).then(|| height / (most * (1.0 + 1e-4)))
}

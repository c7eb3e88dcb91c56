//! A map of rays as a view: with depth.

use super::super::{Fit, FitScene, LightView};
use super::flat::FlatMap;
use super::horizon::Subject;
use crate::frustum::Frustum;
use glam::{DMat4, DVec3, DVec4};

/// The view of a map. From a point, depth is `near` / distance from the horizon, scaled to metres.
/// Of parallel light it is the height along the light over a plane under all receivers, over the
/// distance from the horizon: 1 for the nearest caster that the map shows, in that measure.
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
        let depth = height_over_horizon(subject, w, &Frustum::bounded_by(sides.to_vec()), scene)?;
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
///
/// Heights are counted from a plane across the light, or from that of the ground where those are
/// much less: then the ground has the same depth all over the map, and large grounds take no
/// precision from what stands on them.
fn height_over_horizon(subject: &Subject<'_>, w: DVec4, column: &Frustum, scene: &FitScene) -> Option<DVec4> {
    let up = subject.rays.light.truncate();
    let lowest = subject.points.iter().map(|p| up.dot(*p)).fold(f64::INFINITY, f64::min);
    let mut casters = Vec::new();
    scene.casters.iter().for_each(|b| column.clip_box(b, &mut casters));
    let ground = subject.ground().map(|plane| plane / plane.truncate().dot(up));
    let depth = |height: DVec4| depth_of(height, w, subject.points, &casters);
    let across = depth(up.extend(-lowest));
    let over_ground = ground.filter(|height| height.is_finite()).and_then(depth);
    match (across, over_ground) {
        (Some((_, most)), Some((row, over))) if over * MUCH < most => Some(row),
        (across, over_ground) => across.or(over_ground).map(|(row, _)| row),
    }
}

/// How much less heights over the ground have to be.
const MUCH: f64 = 64.0;

/// The row of depth for heights from some plane, and how high the highest caster is in that
/// measure.
fn depth_of(height: DVec4, w: DVec4, receivers: &[DVec3], casters: &[DVec3]) -> Option<(DVec4, f64)> {
    let over_horizon = |p: &DVec3| height.dot(p.extend(1.0)) / w.dot(p.extend(1.0));
    let range = |points: &[DVec3], [low, high]: [f64; 2]| {
        let depths = points.iter().map(over_horizon).filter(|d| d.is_finite());
        depths.fold([low, high], |[l, h], d| [l.min(d), h.max(d)])
    };
    let [low, high] = range(receivers, [f64::INFINITY, f64::NEG_INFINITY]);
    let highest = range(casters, [low, high])[1];
    // Where all is level, depth is of what rounding may leave.
    let rounding = receivers.iter().map(|p| 1e-9 * (1.0 + p.abs().max_element()) / w.dot(p.extend(1.0)).abs());
    let margin = (1e-2 * (highest - low)).max(rounding.fold(0.0, f64::max));
    let most = highest - low + 2.0 * margin;
    (most > 0.0 && most.is_finite()).then(|| ((height + w * (margin - low)) / most, most))
}

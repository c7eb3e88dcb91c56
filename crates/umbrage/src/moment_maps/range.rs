//! The range of depth that moments are taken in.

use crate::depth_maps::MapFrame;
use crate::view::View;
use umbrage_core::glam::DVec3;
use umbrage_core::{Bounds, Frustum};

/// Stored depth s to linear depth, (x + y s) / (z + w s): 0 at the nearest caster that the light's
/// views see, 1 at the farthest receiver.
pub(super) fn linear_from_stored(view: &View<'_>, maps: &MapFrame) -> [f32; 4] {
    let Some(first) = maps.views.first().filter(|_| maps.is_from_a_point()) else {
        // Parallel views are linear already and reach from the first caster to the last receiver.
        return [1.0, -1.0, 1.0, 0.0];
    };
    let near = first.clip_from_world.row(2).w;
    let (mut nearest, mut farthest) = (f64::INFINITY, 0.0_f64);
    let mut points = Vec::new();
    for light_view in &maps.views {
        if light_view.paraboloid.is_some() {
            // Its depth is the distance from the light itself, and it sees all around.
            let light = view.light.shape.center().truncate();
            let distances = maps.scene.casters.iter().map(|b| light.clamp(b.min, b.max).distance(light));
            nearest = distances.fold(nearest, f64::min);
            let corners = maps.scene.receivers.iter().flat_map(Bounds::corners);
            farthest = corners.map(|c| c.distance(light)).fold(farthest, f64::max);
            continue;
        }
        let frustum = Frustum::of(&light_view.clip_from_world);
        let ahead = light_view.clip_from_world.row(3);
        let distance = |p: &DVec3| ahead.dot(p.extend(1.0));
        let mut corners = |bounds: &Bounds| {
            points.clear();
            frustum.clip_box(bounds, &mut points);
            let distances = points.iter().map(distance);
            distances.fold((f64::INFINITY, 0.0_f64), |(low, high), d| (low.min(d), high.max(d)))
        };
        nearest = maps.scene.casters.iter().map(|b| corners(b).0).fold(nearest, f64::min);
        farthest = maps.scene.receivers.iter().map(|b| corners(b).1).fold(farthest, f64::max);
    }
    let nearest = nearest.clamp(near, farthest.max(near));
    // A little more than what rounding may put outside.
    let (nearest, farthest) = (nearest * (1.0 - MARGIN), farthest.max(near) * (1.0 + MARGIN));
    let scale = 1.0 / (farthest - nearest);
    [(near * scale) as f32, (-nearest * scale) as f32, 0.0, 1.0]
}

/// Of the range, relative.
const MARGIN: f64 = 1e-3;

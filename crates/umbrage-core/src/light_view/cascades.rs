//! Views of one light for parts of what a camera sees, each with a map of its own.
//!
//! Sources: Zhang et al. 2006; FE 3; Valient, "Stable Rendering of Cascaded Shadow Maps", ShaderX6
//! (steady views).

use super::rect::Steps;
use super::{Fit, FitScene, LightView, Omni, fit as fit_light, parallel, perspective};
use crate::splits::split_distances;
use crate::{bounds::Bounds, camera::CameraView, frustum::Frustum, light::LightShape};
use glam::{DVec2, DVec3, DVec4};

/// How a camera's view is split, and what the maps of its parts cover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cascades {
    /// Parts, 1 to [`MOST_SPLITS`](crate::splits::MOST_SPLITS).
    pub count: usize,
    /// From uniform (0) to logarithmic (1) borders.
    pub lambda: f64,
    /// Share of each split over which it is blended with the next one, whose map covers that, too.
    pub overlap: f64,
    /// What shadows end at, metres along the view; 0 for the farthest receiver.
    pub distance: f64,
    /// What the maps cover.
    pub cover: Cover,
}

/// What the map of a part covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cover {
    /// What the part holds of the receivers: scene-dependent, tight, and another one in every
    /// frame.
    Receivers,
    /// The part itself: scene-independent.
    Part,
    /// A sphere around the split, or with a spot a square, on a grid of texels that does not move
    /// with the camera. Maps move in steps of so many texels.
    Steady {
        /// Texels a step, at least 1: over so much the camera moves before a view changes at all.
        step_texels: f64,
    },
}

/// The range of distances of steady views grows and shrinks by this factor at once.
const RANGE_STEP: f64 = 1.189_207_115_002_721;

/// Least distance of the first border over the last one that steady views go by.
const NEAREST: f64 = 1e-3;

/// Fits a view of `light` to each part of what `camera` sees, as the layer of its number, replacing
/// what is in `views`, and writes the borders between parts to `borders`: one more than there are
/// parts, metres along the view. Parts that hold no receiver have no view.
///
/// Lights that shine to all sides, or to more than one view can hold, have no parts: they get what
/// [`fit`](super::fit) gives them, and what that returns; `borders` is empty then. So does a spot
/// while the camera sees receivers more than 60 degrees off its axis. Steady views must not change
/// with where the camera looks, and do not cover those.
pub fn fit_cascades(
    light: &LightShape,
    camera: &CameraView,
    scene: &FitScene,
    cascades: &Cascades,
    fit: &Fit,
    views: &mut Vec<LightView>,
    borders: &mut Vec<f64>,
) -> Option<Omni> {
    views.clear();
    borders.clear();
    let seen = camera.frustum();
    let is_split = match *light {
        LightShape::Spot { position, direction, outer_angle_deg, .. } => {
            let is_steady = matches!(cascades.cover, Cover::Steady { .. });
            perspective::is_narrow(outer_angle_deg)
                && (is_steady || perspective::is_within_widest(position, direction, &seen, scene))
        }
        _ => light.center().w == 0.0,
    };
    if !is_split {
        return fit_light(light, &seen, scene, fit, views);
    }
    if scene.around.is_empty() {
        return None;
    }
    let [near, far] = range(camera, &seen, scene, cascades)?;
    borders.extend(split_distances(near, far, cascades.count, cascades.lambda));
    let part = Part { light, camera, seen: &seen, scene, fit };
    for layer in 0..borders.len() - 1 {
        let back = if layer == 0 { 0.0 } else { cascades.overlap * (borders[layer] - borders[layer - 1]) };
        let ends = [borders[layer] - back, borders[layer + 1]];
        let view = match cascades.cover {
            Cover::Receivers => part.tight(ends),
            Cover::Part => part.whole(ends),
            Cover::Steady { step_texels } => part.steady(ends, &Steps { texels: step_texels }),
        };
        views.extend(view.map(|view| LightView { layer: layer as u32, ..view }));
    }
    None
}

/// A distance from the eye that nothing is beyond: the same for most places of the camera near each
/// other.
fn reach(camera: &CameraView, scene: &FitScene) -> f64 {
    let farthest = scene.around.corners().map(|c| c.distance(camera.eye)).into_iter().fold(0.0, f64::max);
    RANGE_STEP.powf(farthest.max(f64::MIN_POSITIVE).log(RANGE_STEP).ceil())
}

/// Where shadows begin and end along the view.
fn range(camera: &CameraView, seen: &Frustum, scene: &FitScene, cascades: &Cascades) -> Option<[f64; 2]> {
    let limit = if cascades.distance > 0.0 { cascades.distance } else { f64::INFINITY };
    if let Cover::Steady { .. } = cascades.cover {
        let far = reach(camera, scene).min(limit);
        let near = Frustum::of(&camera.clip_from_view).corners().iter().map(|c| -c.z).fold(f64::INFINITY, f64::min);
        let near = if near.is_finite() { near.max(NEAREST * far) } else { NEAREST * far };
        return Some([near.min(far), far]);
    }
    let (forward, mut points) = (camera.forward(), Vec::new());
    let [mut near, mut far] = [f64::INFINITY, f64::NEG_INFINITY];
    for receiver in &scene.receivers {
        let middle = forward.dot(receiver.center() - camera.eye);
        let half = forward.abs().dot(receiver.size() * 0.5);
        // What lies between what is known already need not be cut.
        if middle - half < near || middle + half > far {
            points.clear();
            seen.clip_box(receiver, &mut points);
            let distances = points.iter().map(|p| forward.dot(*p - camera.eye));
            [near, far] = distances.fold([near, far], |[near, far], d| [near.min(d), far.max(d)]);
        }
    }
    // Rounding may put the farthest receiver a little beyond.
    (near <= far).then(|| [near.min(limit), (far + 1e-6 * far.abs()).min(limit)])
}

/// What the view of a part is made from.
struct Part<'a> {
    light: &'a LightShape,
    camera: &'a CameraView,
    seen: &'a Frustum,
    scene: &'a FitScene,
    fit: &'a Fit,
}

impl Part<'_> {
    fn tight(&self, ends: [f64; 2]) -> Option<LightView> {
        self.view(&self.slice(ends), self.scene)
    }

    /// The part in place of the receivers in it.
    fn whole(&self, ends: [f64; 2]) -> Option<LightView> {
        let slice = self.slice(ends);
        let receivers = vec![Bounds::of(slice.corners().iter().copied())];
        self.view(&slice, &FitScene { casters: self.scene.casters.clone(), receivers, around: self.scene.around })
    }

    fn steady(&self, ends: [f64; 2], steps: &Steps) -> Option<LightView> {
        let center = self.light.center();
        if center.w == 0.0 {
            let ball = ball(self.camera, ends, reach(self.camera, self.scene));
            let view = parallel::steady(-center.truncate(), ball, self.scene, steps, self.fit);
            // Half of the map's width is 1.
            let soft_texels =
                self.fit.border_m * view.clip_from_world.row(0).truncate().length() * 0.5 * f64::from(view.size);
            return Some(LightView { steady_border: Some(self.fit.border_texels + soft_texels), ..view });
        }
        let view = self.view(&self.slice(ends), self.scene).map(|view| perspective::steady(&view, steps, self.fit))?;
        Some(LightView { steady_border: Some(self.fit.border_texels), ..view })
    }

    fn view(&self, slice: &Frustum, scene: &FitScene) -> Option<LightView> {
        let center = self.light.center();
        match *self.light {
            LightShape::Spot { position, direction, .. } => {
                let near = super::near(position, self.scene);
                perspective::within_widest(position, direction, near, slice, scene, self.fit)
            }
            _ => parallel::view(-center.truncate(), slice, scene, self.fit),
        }
    }

    fn slice(&self, ends: [f64; 2]) -> Frustum {
        self.seen.clone().and(&between(self.camera.forward(), self.camera.eye, ends))
    }
}

/// What lies between two distances from `eye` along `forward`.
fn between(forward: DVec3, eye: DVec3, [from, to]: [f64; 2]) -> Frustum {
    let plane = |normal: DVec3, offset: f64| -> DVec4 { normal.extend(offset - normal.dot(eye)) };
    Frustum::bounded_by(vec![plane(forward, -from), plane(-forward, to)])
}

/// Middle and radius of a sphere around what the camera may see between two distances along the
/// view and no farther than `reach` from the eye. The radius depends on the projection and the
/// distances alone, not on where the camera looks, to the last bit.
fn ball(camera: &CameraView, ends: [f64; 2], reach: f64) -> (DVec3, f64) {
    let part = Frustum::of(&camera.clip_from_view).and(&between(DVec3::NEG_Z, DVec3::ZERO, ends));
    // The farthest corner at either end, as its distances along and from the axis; beyond the reach
    // where its ray, or the end, leaves that.
    let [near, far] = ends.map(|d| {
        let at_end = part.corners().iter().filter(|c| (c.z + d).abs() <= 1e-6 * (1.0 + d.abs()));
        let aside = at_end.map(|c| c.truncate().length_squared()).fold(0.0, f64::max).sqrt();
        DVec2::new(d, aside)
    });
    // Of a sphere's cap that the view sees what is at its rim is farthest from any place on the
    // axis.
    let far = within(reach, near, far);
    let along = far.x - near.x;
    let middle = if along > 0.0 { (far.length_squared() - near.length_squared()) / (2.0 * along) } else { far.x };
    let axis = DVec2::new(middle.clamp(near.x, far.x.max(near.x)), 0.0);
    let center = DVec3::new(0.0, 0.0, -axis.x);
    let tip = ends[1].min(reach).max(ends[0]) - axis.x;
    let radius = near.distance(axis).max(far.distance(axis)).max(tip);
    (camera.view_from_world.inverse().transform_point3(center), radius)
}

/// The end of the way from `near` to `far` that is no farther than `reach` from the origin.
fn within(reach: f64, near: DVec2, far: DVec2) -> DVec2 {
    let way = far - near;
    if far.length() <= reach || near.length() >= reach || way == DVec2::ZERO {
        return far;
    }
    let (along, square) = (near.dot(way), way.length_squared());
    near + way * (((along * along + square * (reach * reach - near.length_squared())).sqrt() - along) / square)
}

#[cfg(test)]
mod tests;

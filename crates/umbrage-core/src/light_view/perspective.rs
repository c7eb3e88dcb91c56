//! Perspective views: a spot's, and the faces of a cube or tetrahedron.

use super::rect::{Crop, Rect, Steps};
use super::{Fit, FitScene, Focus, LightView, Omni, divided};
use crate::{bounds::Bounds, frustum::Frustum};
use glam::{DMat4, DVec2, DVec3, DVec4};

/// Widest half angle of a single perspective view, as a tangent: 60 degrees. A spot that has to
/// cover more gets several views.
pub(super) const WIDEST: f64 = 1.732;

/// Forward and up of the faces of a cube, in the order of the layers.
const CUBE: [(DVec3, DVec3); 6] = [
    (DVec3::X, DVec3::Y),
    (DVec3::NEG_X, DVec3::Y),
    (DVec3::Y, DVec3::Z),
    (DVec3::NEG_Y, DVec3::Z),
    (DVec3::Z, DVec3::Y),
    (DVec3::NEG_Z, DVec3::Y),
];

/// Horizontal length of the three axes of the tetrahedron that are not straight down, √8 / 3.
const ACROSS: f64 = 2.0 * std::f64::consts::SQRT_2 / 3.0;
/// Sine of 60 degrees.
const SIN_60: f64 = 0.866_025_403_784_438_6;

/// Forward and up of the faces of a tetrahedron. Up leads to a corner of the face, which is
/// opposite to another axis.
const TETRAHEDRON: [(DVec3, DVec3); 4] = [
    (DVec3::NEG_Y, DVec3::NEG_X),
    (DVec3::new(ACROSS, 1.0 / 3.0, 0.0), DVec3::Y),
    (DVec3::new(-0.5 * ACROSS, 1.0 / 3.0, SIN_60 * ACROSS), DVec3::Y),
    (DVec3::new(-0.5 * ACROSS, 1.0 / 3.0, -SIN_60 * ACROSS), DVec3::Y),
];

/// Forward and up of each layer.
pub(super) fn faces(omni: Omni) -> impl Iterator<Item = (DVec3, DVec3)> {
    let faces: &[_] = match omni {
        Omni::Cube => &CUBE,
        Omni::Tetrahedral => &TETRAHEDRON,
        Omni::DualParaboloid => &[],
    };
    faces.iter().copied()
}

/// What a whole face covers: a square of 90 degrees, or the box around an equilateral triangle
/// whose corners are 70.5 degrees from the axis, one of them up.
fn whole(omni: Omni) -> Rect {
    match omni {
        Omni::Tetrahedral => {
            Rect { min: DVec2::new(-6f64.sqrt(), -2f64.sqrt()), max: DVec2::new(6f64.sqrt(), 2.0 * 2f64.sqrt()) }
        }
        _ => Rect::around(1.0),
    }
}

/// Appends the faces of [`Fit::omni`] that see receivers.
pub(super) fn views(
    position: DVec3,
    near: f64,
    seen: &Frustum,
    scene: &FitScene,
    fit: &Fit,
    views: &mut Vec<LightView>,
) {
    for (layer, (forward, up)) in faces(fit.omni).enumerate() {
        let face = Perspective { position, forward, up, near };
        let rect = match fit.focus {
            Focus::Light => Some(whole(fit.omni)),
            Focus::Visible => {
                face.visible(seen, &scene.receivers, &self::face(position, forward, fit.omni), whole(fit.omni))
            }
        };
        if let Some(rect) = rect {
            let clip_from_world = Crop::to(rect, fit).matrix() * face.clip_from_world();
            views.push(LightView::of(clip_from_world, fit.size, layer as u32));
        }
    }
}

/// What lies before a face: the directions that belong to it.
pub(super) fn face(position: DVec3, forward: DVec3, omni: Omni) -> Frustum {
    let axes: Vec<DVec3> = faces(omni).map(|(forward, _)| forward).collect();
    nearest_to(position, forward, &axes)
}

/// The directions that are nearer to `axis` than to any other of `axes`.
fn nearest_to(position: DVec3, axis: DVec3, axes: &[DVec3]) -> Frustum {
    let between = axes.iter().filter(|other| **other != axis).map(|other| (axis - other).normalize());
    Frustum::bounded_by(between.map(|n| n.extend(-n.dot(position))).collect())
}

/// A view from a point with a square opening of 90 degrees.
pub(super) struct Perspective {
    pub position: DVec3,
    pub forward: DVec3,
    pub up: DVec3,
    pub near: f64,
}

impl Perspective {
    pub fn clip_from_world(&self) -> DMat4 {
        let right = self.forward.cross(self.up).normalize();
        let up = right.cross(self.forward);
        let row = |axis: DVec3| axis.extend(-axis.dot(self.position));
        DMat4::from_cols(row(right), row(up), DVec4::new(0.0, 0.0, 0.0, self.near), row(self.forward)).transpose()
    }

    /// What the camera sees of the receivers within the widest view that there is; `None` where
    /// that is nothing.
    fn cropped(&self, seen: &Frustum, scene: &FitScene, fit: &Fit) -> Option<LightView> {
        let tangents = DMat4::from_scale(DVec3::new(1.0 / WIDEST, 1.0 / WIDEST, 1.0));
        let opening = Frustum::of(&(tangents * self.clip_from_world()));
        let rect = self.visible(seen, &scene.receivers, &opening, Rect::around(WIDEST))?;
        Some(LightView::of(Crop::to(rect, fit).matrix() * self.clip_from_world(), fit.size, 0))
    }

    /// Whether the widest view holds all that the camera sees of the receivers.
    fn may_hold(&self, seen: &Frustum, receivers: &[Bounds]) -> bool {
        let clip_from_world = self.clip_from_world();
        let mut points = Vec::new();
        receivers.iter().for_each(|b| seen.clip_box(b, &mut points));
        points.iter().all(|p| {
            let clip = clip_from_world * p.extend(1.0);
            clip.truncate().truncate().abs().max_element() <= WIDEST * clip.w
        })
    }

    /// What the camera sees of the receivers within `opening`, as far as that is in `whole`.
    fn visible(&self, seen: &Frustum, receivers: &[Bounds], opening: &Frustum, whole: Rect) -> Option<Rect> {
        let clip_from_world = self.clip_from_world();
        let both = seen.clone().and(opening);
        let mut points = Vec::new();
        for bounds in receivers {
            both.clip_box(bounds, &mut points);
        }
        Rect::of(points.iter().map(|p| {
            let clip = clip_from_world * p.extend(1.0);
            divided(DVec4 { w: clip.w.max(self.near), ..clip }).clamp(whole.min, whole.max)
        }))
    }
}

/// Whether all that the camera sees of the receivers is within the widest view along `direction`.
pub(super) fn is_within_widest(position: DVec3, direction: DVec3, seen: &Frustum, scene: &FitScene) -> bool {
    let near = super::near(position, scene);
    let view = Perspective { position, forward: direction, up: direction.any_orthonormal_vector(), near };
    view.may_hold(seen, &scene.receivers)
}

/// The view of a spot that no cone wider than a single view asks for: what is seen outside of that
/// is not covered.
pub(super) fn within_widest(
    position: DVec3,
    direction: DVec3,
    near: f64,
    seen: &Frustum,
    scene: &FitScene,
    fit: &Fit,
) -> Option<LightView> {
    Perspective { position, forward: direction, up: direction.any_orthonormal_vector(), near }.cropped(seen, scene, fit)
}

/// Whether a cone fits a single view.
pub(super) fn is_narrow(outer_angle_deg: f64) -> bool {
    (0.0..=WIDEST).contains(&outer_angle_deg.to_radians().tan())
}

/// The single view of a spot; `None` where it would have to be wider than such a view can be.
pub(super) fn spot(
    position: DVec3,
    direction: DVec3,
    outer_angle_deg: f64,
    near: f64,
    seen: &Frustum,
    scene: &FitScene,
    fit: &Fit,
) -> Option<LightView> {
    let view = Perspective { position, forward: direction, up: direction.any_orthonormal_vector(), near };
    let rect = match fit.focus {
        Focus::Light => {
            if !is_narrow(outer_angle_deg) {
                return None;
            }
            Rect::around(outer_angle_deg.to_radians().tan())
        }
        Focus::Visible => {
            return if view.may_hold(seen, &scene.receivers) { view.cropped(seen, scene, fit) } else { None };
        }
    };
    Some(LightView::of(Crop::to(rect, fit).matrix() * view.clip_from_world(), fit.size, 0))
}

/// The same view on a grid of texels that depends on their size alone, which is one of a few: a
/// square that holds what `view` shows.
pub(super) fn steady(view: &LightView, steps: &Steps, fit: &Fit) -> LightView {
    // The view from the same place without a crop is what texels are counted in.
    let clip = view.clip_from_world;
    let (across, up, ahead) = (clip.row(0), clip.row(1), clip.row(3));
    let straight = DVec2::new(across.truncate().dot(ahead.truncate()), up.truncate().dot(ahead.truncate()));
    let scale =
        DVec2::new((across - ahead * straight.x).truncate().length(), (up - ahead * straight.y).truncate().length());
    let (center, half) = (-straight / scale, scale.recip());
    let size = SIZE_STEP.powf(half.max_element().log(SIZE_STEP).ceil());
    let rect = steps.rect(center, size, fit);
    let crop = Crop::whole(rect).after(&Crop { scale, moved: straight });
    LightView { clip_from_world: crop.matrix() * clip, ..view.clone() }
}

/// Steady views of a spot come in sizes of which each is so many times the one before.
const SIZE_STEP: f64 = std::f64::consts::SQRT_2;

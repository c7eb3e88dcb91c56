//! Paraboloid views: half of all directions on a disc (Brabec, Annen and Seidel, "Shadow Mapping
//! for Hemispherical and Omnidirectional Light Sources", 2002).
//!
//! A way d from the light, z ahead, stands at d.xy / (|d| + d.z): the stereographic projection from
//! the opposite of the axis. Planes through the light, and with them the edges of boxes, become
//! circles.

use super::perspective::Perspective;
use super::rect::{Crop, Rect};
use super::{Fit, FitScene, Focus, LightView, NEAR};
use crate::{bounds::Bounds, frustum::Frustum};
use glam::{DMat4, DVec2, DVec3, DVec4};

/// What of the plane of a paraboloid the map shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraboloid {
    /// Normalised device coordinates per unit of the plane; the disc of the hemisphere has
    /// radius 1.
    pub scale: DVec2,
    /// Where the axis is, in normalised device coordinates.
    pub axis: DVec2,
}

/// Planes around a cone.
const SIDES: u32 = 8;

/// Widest half angle of a cone that has planes around it, radians. A wider one is a half-space.
const WIDEST: f64 = 1.5;

impl Paraboloid {
    /// Of the clip coordinates of the perspective view along the axis; the depth is near /
    /// distance.
    pub(super) fn project(&self, clip: DVec4) -> Option<DVec3> {
        let way = DVec3::new(clip.x, clip.y, clip.w);
        let distance = way.length();
        (distance + way.z > 0.0).then(|| (self.scale * plane_from(way) + self.axis).extend(clip.z / distance))
    }

    /// |d| = d · u with u the unit way to the point, and stays so to first order around it.
    pub(super) fn tangent_at(&self, clip_from_world: &DMat4, point: DVec3) -> DMat4 {
        let rows = [0, 1, 2, 3].map(|i| clip_from_world.row(i));
        let clip = *clip_from_world * point.extend(1.0);
        let unit = DVec3::new(clip.x, clip.y, clip.w).normalize_or_zero();
        let w = rows[0] * unit.x + rows[1] * unit.y + rows[3] * (1.0 + unit.z);
        let bent = DMat4::from_cols(
            rows[0] * self.scale.x + w * self.axis.x,
            rows[1] * self.scale.y + w * self.axis.y,
            rows[2],
            w,
        );
        bent.transpose()
    }

    /// Around the circle around the rectangle of the plane that the map shows.
    pub(super) fn frustum(&self, clip_from_world: &DMat4) -> Frustum {
        let axes = [0, 1, 3].map(|i| clip_from_world.row(i));
        let (middle, radius) = (-self.axis / self.scale, self.scale.recip().length());
        let (from, to) = (2.0 * (middle.length() - radius).atan(), 2.0 * (middle.length() + radius).atan());
        let (tilt, half) = (0.5 * (from + to), 0.5 * (to - from));
        let outward = middle.normalize_or(DVec2::X) * tilt.sin();
        let towards = |d: DVec3| axes[0] * d.x + axes[1] * d.y + axes[2] * d.z;
        let cone = outward.extend(tilt.cos());
        if half > WIDEST {
            // Farther to the back than this is no point of the scene.
            let reach = clip_from_world.row(2).w / NEAR;
            return Frustum::bounded_by(vec![towards(cone) - DVec4::W * (half.cos().min(0.0) * reach)]);
        }
        let (a, b) = cone.any_orthonormal_pair();
        let side = |i: u32| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / f64::from(SIDES)).sin_cos();
            towards(cone * half.sin() + (a * cos + b * sin) * half.cos())
        };
        Frustum::bounded_by((0..SIDES).map(side).collect())
    }
}

/// Appends the paraboloids that see receivers.
pub(super) fn views(
    position: DVec3,
    near: f64,
    seen: &Frustum,
    scene: &FitScene,
    fit: &Fit,
    views: &mut Vec<LightView>,
) {
    for (layer, forward) in [DVec3::NEG_Y, DVec3::Y].into_iter().enumerate() {
        let clip_from_world = Perspective { position, forward, up: DVec3::Z, near }.clip_from_world();
        let rect = match fit.focus {
            Focus::Light => Some(Rect::around(1.0)),
            Focus::Visible => visible(position, forward, &clip_from_world, seen, &scene.receivers),
        };
        if let Some(rect) = rect {
            let Crop { scale, moved } = Crop::to(rect, fit);
            let paraboloid = Some(Paraboloid { scale, axis: moved });
            views.push(LightView { paraboloid, ..LightView::of(clip_from_world, fit.size, layer as u32) });
        }
    }
}

/// What the camera sees of the receivers in the hemisphere around `forward`, as a rectangle of the
/// plane.
fn visible(
    position: DVec3,
    forward: DVec3,
    clip_from_world: &DMat4,
    seen: &Frustum,
    receivers: &[Bounds],
) -> Option<Rect> {
    let hemisphere = Frustum::bounded_by(vec![forward.extend(-forward.dot(position))]);
    let both = seen.clone().and(&hemisphere);
    let (mut corners, mut plane) = (Vec::new(), Vec::new());
    for bounds in receivers {
        corners.clear();
        both.clip_box(bounds, &mut corners);
        let ways: Vec<DVec3> = corners
            .iter()
            .map(|p| *clip_from_world * p.extend(1.0))
            .filter_map(|clip| DVec3::new(clip.x, clip.y, clip.w.max(0.0)).try_normalize())
            .collect();
        if !ways.is_empty() && is_seen_inside(bounds, seen, position) {
            return Some(Rect::around(1.0));
        }
        outline(&ways, &mut plane);
    }
    Rect::of(plane.into_iter().map(|p: DVec2| p.clamp(DVec2::NEG_ONE, DVec2::ONE)))
}

fn is_seen_inside(bounds: &Bounds, seen: &Frustum, point: DVec3) -> bool {
    let inside = bounds.min.cmple(point).all() && bounds.max.cmpge(point).all();
    inside && seen.holds(&Bounds { min: point, max: point })
}

fn plane_from(way: DVec3) -> DVec2 {
    way.truncate() / (way.length() + way.z)
}

/// Appends points of the plane that have as many to all four sides of them as what lies between the
/// unit ways: these themselves, and where an arc between two of them bulges farthest.
fn outline(ways: &[DVec3], plane: &mut Vec<DVec2>) {
    for (i, &a) in ways.iter().enumerate() {
        plane.push(plane_from(a));
        for &b in &ways[i + 1..] {
            bulges(a, b, plane);
        }
    }
}

/// The great circle through both with the unit normal m is the circle around m.xy / m.z with radius
/// 1 / |m.z|.
fn bulges(a: DVec3, b: DVec3, plane: &mut Vec<DVec2>) {
    let Some(normal) = a.cross(b).try_normalize() else { return };
    let (middle, radius) = (normal.truncate() / normal.z, 1.0 / normal.z.abs());
    for side in [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y] {
        let q = middle + side * radius;
        let way = (2.0 * q).extend(1.0 - q.length_squared());
        if q.is_finite() && normal.dot(a.cross(way)) > 0.0 && normal.dot(way.cross(b)) > 0.0 {
            plane.push(q);
        }
    }
}

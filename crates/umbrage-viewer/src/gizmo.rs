//! A light as lines in the scene, and the handles that it is moved by.

use std::f64::consts::TAU;
use umbrage_core::LightShape;
use umbrage_core::glam::{DQuat, DVec3};

/// What a handle does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Handle {
    /// Moves the light along x, y or z.
    Move(usize),
    /// Turns it.
    Aim,
    /// Makes it larger or smaller, along its axis of this number.
    Size(usize),
    /// Moves one of the two ends of a line.
    End(usize),
}

/// A handle and the line that leads to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grip {
    pub handle: Handle,
    pub from: DVec3,
    pub at: DVec3,
}

/// A light as it is drawn.
pub(crate) struct Gizmo {
    /// Strips of lines that show its shape.
    pub lines: Vec<Vec<DVec3>>,
    pub grips: Vec<Grip>,
}

/// Segments of a circle.
const SEGMENTS: u32 = 48;
/// The handle for the aim is so many arms away.
const AIM: f64 = 1.6;
/// That for the width of parallel light is at this share of the way to the aim, for a hard light,
const HARD_SUN: f64 = 0.25;
/// and goes one more such way in so many degrees: the sun itself would be too small to be taken.
const SUN_DEG: f64 = 20.0;
/// Smallest size that hands can give, arms.
const SMALLEST: f64 = 1e-3;

impl Gizmo {
    /// Of `shape`, with arms of this length in metres. Parallel light is drawn at `middle`; `right`
    /// is where spheres have their handle.
    pub fn of(shape: &LightShape, middle: DVec3, arm: f64, right: DVec3) -> Self {
        let mut gizmo = Self { lines: Vec::new(), grips: Vec::new() };
        let center = anchor(shape, middle);
        if !matches!(shape, LightShape::Directional { .. }) {
            for (axis, along) in DVec3::AXES.into_iter().enumerate() {
                gizmo.grip(Handle::Move(axis), center, center + along * arm);
            }
        }
        match *shape {
            LightShape::Point { .. } => {
                let star = DVec3::AXES.map(|axis| axis * (arm * 0.15));
                gizmo.lines.extend(star.map(|by| vec![center - by, center + by]));
            }
            LightShape::Spot { direction, inner_angle_deg, outer_angle_deg, .. } => {
                let end = gizmo.aim(center, direction, arm);
                let reach = arm * AIM;
                let side = direction.any_orthonormal_vector();
                let up = direction.cross(side);
                let rim = |angle: f64| reach * angle.to_radians().tan();
                for radius in [rim(inner_angle_deg), rim(outer_angle_deg)] {
                    gizmo.ring(end, side * radius, up * radius);
                }
                let outer = rim(outer_angle_deg);
                let edges = [side, up, -side, -up].map(|by| vec![center, end + by * outer]);
                gizmo.lines.extend(edges);
                gizmo.grip(Handle::Size(0), end, end + side * outer);
            }
            LightShape::Directional { direction, angle_deg } => {
                let end = gizmo.aim(center, -direction, arm);
                let reach = arm * AIM;
                let side = direction.any_orthonormal_vector();
                let up = direction.cross(side);
                let radius = reach * (angle_deg * 0.5).to_radians().tan();
                gizmo.ring(end, side * radius, up * radius);
                gizmo.lines.extend([side, up, -side, -up].map(|by| vec![center, end + by * radius]));
                let rest = reach * (HARD_SUN + angle_deg / SUN_DEG);
                gizmo.grip(Handle::Size(0), end, end + side * rest);
            }
            LightShape::Sphere { radius, .. } => {
                let [x, y, z] = DVec3::AXES.map(|axis| axis * radius);
                [(x, y), (y, z), (z, x)].into_iter().for_each(|(a, b)| gizmo.ring(center, a, b));
                gizmo.grip(Handle::Size(0), center, center + right * radius);
            }
            LightShape::Ellipsoid { radii, rotation, .. } => {
                let axes = [0, 1, 2].map(|i| rotation.col(i) * radii[i]);
                let [x, y, z] = axes;
                [(x, y), (y, z), (z, x)].into_iter().for_each(|(a, b)| gizmo.ring(center, a, b));
                axes.into_iter().enumerate().for_each(|(i, by)| gizmo.grip(Handle::Size(i), center, center + by));
            }
            LightShape::Disc { direction, radius, .. } => {
                gizmo.aim(center, direction, arm);
                let side = direction.any_orthonormal_vector();
                gizmo.ring(center, side * radius, direction.cross(side) * radius);
                gizmo.grip(Handle::Size(0), center, center + side * radius);
            }
            LightShape::Rect { direction, up, size, .. } => {
                gizmo.aim(center, direction, arm);
                let (x, y) = (up.cross(direction) * (size.x * 0.5), up * (size.y * 0.5));
                gizmo.lines.push([x + y, y - x, -x - y, x - y, x + y].map(|by| center + by).to_vec());
                gizmo.grip(Handle::Size(0), center, center + x);
                gizmo.grip(Handle::Size(1), center, center + y);
            }
            LightShape::Line { from, to } => {
                gizmo.lines.push(vec![from, to]);
                gizmo.grip(Handle::End(0), center, from);
                gizmo.grip(Handle::End(1), center, to);
            }
            // A sky has no place.
            LightShape::Environment(_) => {}
        }
        gizmo
    }

    fn grip(&mut self, handle: Handle, from: DVec3, at: DVec3) {
        self.grips.push(Grip { handle, from, at });
    }

    /// Where the handle for the aim is.
    fn aim(&mut self, center: DVec3, along: DVec3, arm: f64) -> DVec3 {
        let end = center + along * (arm * AIM);
        self.grip(Handle::Aim, center, end);
        end
    }

    /// An ellipse with these half axes.
    fn ring(&mut self, center: DVec3, a: DVec3, b: DVec3) {
        let at = |i: u32| {
            let (sin, cos) = (f64::from(i) / f64::from(SEGMENTS) * TAU).sin_cos();
            center + a * cos + b * sin
        };
        self.lines.push((0..=SEGMENTS).map(at).collect());
    }
}

/// Where a light's gizmo is.
pub(crate) fn anchor(shape: &LightShape, middle: DVec3) -> DVec3 {
    let center = shape.center();
    if center.w == 0.0 { middle } else { center.truncate() }
}

/// Changes `shape` as its handle says that was taken at `grip` and brought to `to`; arms are as
/// long as when it was drawn.
pub(crate) fn drag(shape: &mut LightShape, grip: &Grip, to: DVec3, arm: f64) {
    let by = to - grip.at;
    if !by.is_finite() {
        return;
    }
    match grip.handle {
        Handle::Move(_) => shape.shift(by),
        Handle::Aim => turn(shape, grip, to),
        Handle::Size(axis) => resize(shape, axis, grip, to, arm),
        Handle::End(end) => {
            if let LightShape::Line { from, to } = shape {
                let old = (*from, *to);
                *(if end == 0 { &mut *from } else { &mut *to }) += by;
                if from.distance(*to) < arm * SMALLEST {
                    (*from, *to) = old;
                }
            }
        }
    }
}

/// Turns a light with the arm that its aim is at the end of.
fn turn(shape: &mut LightShape, grip: &Grip, to: DVec3) {
    let arms = [grip.at - grip.from, to - grip.from].map(DVec3::try_normalize);
    let [Some(old), Some(new)] = arms else { return };
    let round = DQuat::from_rotation_arc(old, new);
    match shape {
        LightShape::Spot { direction, .. }
        | LightShape::Directional { direction, .. }
        | LightShape::Disc { direction, .. } => *direction = (round * *direction).normalize(),
        LightShape::Rect { direction, up, .. } => {
            *direction = (round * *direction).normalize();
            let turned = (round * *up).reject_from_normalized(*direction);
            *up = turned.try_normalize().unwrap_or_else(|| direction.any_orthonormal_vector());
        }
        _ => {}
    }
}

fn resize(shape: &mut LightShape, axis: usize, grip: &Grip, to: DVec3, arm: f64) {
    let along = (grip.at - grip.from).normalize_or_zero();
    let length = (to - grip.from).dot(along);
    let size = length.max(arm * SMALLEST);
    let reach = arm * AIM;
    match shape {
        LightShape::Spot { inner_angle_deg, outer_angle_deg, .. } => {
            let outer = (size / reach).atan().to_degrees().clamp(0.5, 89.0);
            *inner_angle_deg = (*inner_angle_deg * outer / *outer_angle_deg).min(outer);
            *outer_angle_deg = outer;
        }
        LightShape::Directional { angle_deg, .. } => {
            *angle_deg = ((length / reach - HARD_SUN) * SUN_DEG).clamp(0.0, SUN_DEG);
        }
        LightShape::Sphere { radius, .. } | LightShape::Disc { radius, .. } => *radius = size,
        LightShape::Ellipsoid { radii, .. } => radii[axis] = size,
        LightShape::Rect { size: sides, .. } => sides[axis] = 2.0 * size,
        LightShape::Point { .. } | LightShape::Line { .. } | LightShape::Environment(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinds;
    use umbrage_core::{Light, LightKind};

    fn gizmo(shape: &LightShape) -> Gizmo {
        Gizmo::of(shape, DVec3::ZERO, 1.0, DVec3::X)
    }

    fn grip(shape: &LightShape, handle: Handle) -> Grip {
        *gizmo(shape).grips.iter().find(|grip| grip.handle == handle).unwrap()
    }

    /// Drags the handle by this much; it has to be where it was brought.
    #[track_caller]
    fn follows(shape: &mut LightShape, handle: Handle, by: DVec3) {
        let taken = grip(shape, handle);
        drag(shape, &taken, taken.at + by, 1.0);
        let now = grip(shape, handle).at;
        let off = now.distance(taken.at + by);
        assert!(off < 1e-6, "{handle:?} of {shape:?}: {off}");
    }

    #[test]
    fn every_handle_of_every_kind_goes_where_it_is_brought() {
        for kind in LightKind::ALL {
            let mut shape = kinds::changed(&LightShape::Point { position: DVec3::new(1.0, 3.0, 2.0) }, kind, 9.0);
            if let LightShape::Directional { angle_deg, .. } = &mut shape {
                *angle_deg = 2.0;
            }
            let handles: Vec<Handle> = gizmo(&shape).grips.iter().map(|grip| grip.handle).collect();
            assert!(!handles.is_empty(), "{}", kind.name());
            for handle in handles {
                let taken = grip(&shape, handle);
                let along = (taken.at - taken.from).normalize();
                match handle {
                    Handle::Move(_) | Handle::Size(_) => follows(&mut shape, handle, along * 0.2),
                    Handle::End(_) => follows(&mut shape, handle, DVec3::new(0.3, -0.1, 0.2)),
                    Handle::Aim => {
                        let to = taken.from + (along + DVec3::new(0.2, 0.1, -0.3)).normalize() * AIM;
                        follows(&mut shape, handle, to - taken.at);
                    }
                }
                assert!(Light::new(shape.clone()).usable().is_ok(), "{shape:?}");
            }
        }
    }

    #[test]
    fn nothing_gets_smaller_than_nothing() {
        for kind in LightKind::ALL {
            let mut shape = kinds::changed(&LightShape::Point { position: DVec3::Y }, kind, 9.0);
            for taken in gizmo(&shape).grips {
                drag(&mut shape, &taken, taken.at - (taken.at - taken.from) * 3.0, 1.0);
                drag(&mut shape, &taken, DVec3::NAN, 1.0);
                assert!(Light::new(shape.clone()).usable().is_ok(), "{shape:?}");
            }
        }
    }
}

//! What the camera sees, at a few places of the picture: what texels are measured on.

use crate::{bounds::Bounds, camera::CameraView, frustum::Frustum, view_body::ViewBody};
use glam::DVec3;

/// A place in the picture: where its ray meets the first of the receivers' boxes, or leaves one
/// that the eye is in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Surface {
    pub point: DVec3,
    /// Towards the camera.
    pub normal: DVec3,
}

/// Places across and down.
const ACROSS: u32 = 16;
const DOWN: u32 = 12;

/// What a grid of rays meets.
pub(super) fn surfaces(camera: &CameraView, seen: &Frustum, receivers: &[Bounds]) -> Vec<Surface> {
    let view = ViewBody::of(camera);
    let boxes: Vec<Bounds> = receivers
        .iter()
        .filter(|b| seen.may_see(b))
        .map(|b| Bounds { min: b.min - camera.eye, max: b.max - camera.eye })
        .collect();
    let start = if view.near.is_finite() { view.near } else { 0.0 };
    let (near, farther) = (view.at(start), view.at(start + 1.0));
    let mut surfaces = Vec::with_capacity((ACROSS * DOWN) as usize);
    for i in 0..ACROSS * DOWN {
        let x = (f64::from(i % ACROSS) + 0.5) / f64::from(ACROSS);
        let y = (f64::from(i / ACROSS) + 0.5) / f64::from(DOWN);
        let between = |c: &[DVec3; 4]| c[0].lerp(c[1], x).lerp(c[2].lerp(c[3], x), y);
        let (from, way) = (between(&near), between(&farther) - between(&near));
        let hits = boxes.iter().filter_map(|b| hit(from, way, b));
        if let Some((distance, normal)) = hits.min_by(|a, b| a.0.total_cmp(&b.0)) {
            surfaces.push(Surface { point: camera.eye + from + way * distance, normal });
        }
    }
    surfaces.retain(|s| s.point.is_finite());
    surfaces
}

/// Where a ray enters a box, or leaves it where it starts inside, and the normal of that side
/// towards where it comes from.
fn hit(from: DVec3, way: DVec3, bounds: &Bounds) -> Option<(f64, DVec3)> {
    let (mut enter, mut leave) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
    for axis in 0..3 {
        let (a, b) = ((bounds.min[axis] - from[axis]) / way[axis], (bounds.max[axis] - from[axis]) / way[axis]);
        if way[axis] == 0.0 {
            if !(bounds.min[axis]..=bounds.max[axis]).contains(&from[axis]) {
                return None;
            }
            continue;
        }
        if a.min(b) > enter.0 {
            enter = (a.min(b), axis);
        }
        if a.max(b) < leave.0 {
            leave = (a.max(b), axis);
        }
    }
    let (distance, axis) = if enter.0 >= 0.0 { enter } else { leave };
    let normal = DVec3::AXES[axis] * -way[axis].signum();
    (enter.0 <= leave.0 && distance >= 0.0).then_some((distance, normal))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;

    #[test]
    fn rays_meet_the_first_box_and_leave_the_one_around_the_eye() {
        let camera = Camera { eye: DVec3::ZERO, target: DVec3::NEG_Z, fov_y_deg: 60.0, near: 0.1, ..Camera::default() };
        let view = camera.view(4, 3);
        let wall = |z: f64| Bounds { min: DVec3::new(-50.0, -50.0, z - 1.0), max: DVec3::new(50.0, 50.0, z) };
        let seen = surfaces(&view, &view.frustum(), &[wall(-9.0), wall(-5.0), wall(5.0)]);
        assert_eq!(seen.len(), (ACROSS * DOWN) as usize);
        assert!(seen.iter().all(|s| (s.point.z + 5.0).abs() < 1e-9 && s.normal == DVec3::Z));
        let room = Bounds { min: DVec3::splat(-3.0), max: DVec3::splat(3.0) };
        let seen = surfaces(&view, &view.frustum(), &[room]);
        assert!(seen.iter().all(|s| (s.point.abs().max_element() - 3.0).abs() < 1e-9 && s.normal.dot(s.point) < 0.0));
        assert!(surfaces(&view, &view.frustum(), &[]).is_empty());
    }
}

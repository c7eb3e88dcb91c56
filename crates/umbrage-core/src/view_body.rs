//! What a camera sees, relative to its eye, so that a scene far from the origin loses nothing to
//! rounding.

use crate::{bounds::Bounds, camera::CameraView};
use glam::{DAffine3, DMat4, DVec3, DVec4};

pub(crate) struct ViewBody {
    /// From world coordinates less the eye's.
    pub clip_from_relative: DMat4,
    /// Two homogeneous points on each of the four edges between the side planes.
    edges: [[DVec4; 2]; 4],
    /// The way the camera looks, unit length.
    pub forward: DVec3,
    /// Distance along the view of the nearest and farthest point seen; infinite where there is no
    /// far plane.
    pub near: f64,
    pub far: f64,
    /// The smallest `w` in clip space of what is seen.
    pub near_w: f64,
    eye: DVec3,
}

/// A far plane beyond this many times the distance of the near plane is taken to be at infinity:
/// the inverse of the projection no longer tells them apart.
const FARTHEST: f64 = 1e9;

impl ViewBody {
    pub fn of(camera: &CameraView) -> Self {
        let view_from_relative = DAffine3 {
            matrix3: camera.view_from_world.matrix3,
            translation: camera.view_from_world.transform_point3(camera.eye),
        };
        let clip_from_relative = camera.clip_from_view * DMat4::from(view_from_relative);
        let relative_from_clip = DMat4::from(view_from_relative.inverse()) * camera.clip_from_view.inverse();
        let edges = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)]
            .map(|(x, y)| [0.0, 1.0].map(|depth| relative_from_clip * DVec4::new(x, y, depth, 1.0)));
        let forward = -view_from_relative.matrix3.row(2).normalize_or(DVec3::Z);
        let corners = edges.as_flattened();
        // Points at clip w have 1 / w here.
        let nearest = corners.iter().map(|c| c.w).fold(0.0, f64::max);
        let is_finite = |c: &DVec4| c.w * FARTHEST > nearest;
        let depth = |c: &DVec4| forward.dot(c.truncate()) / c.w;
        let near = corners.iter().filter(|c| is_finite(c)).map(depth).fold(f64::INFINITY, f64::min);
        let far = corners.iter().map(|c| if is_finite(c) { depth(c) } else { f64::INFINITY });
        let far = far.fold(f64::NEG_INFINITY, f64::max);
        // The inverse is good to about this much where the planes are far apart.
        let far = far + 1e-6 * far.abs();
        Self { clip_from_relative, edges, forward, near, far, near_w: 1.0 / nearest, eye: camera.eye }
    }

    /// The four corners of what is seen at a distance along the view, relative to the eye.
    pub fn at(&self, depth: f64) -> [DVec3; 4] {
        self.edges.map(|[a, b]| {
            // The point of the line through both, either of which may be at infinity, that is in
            // the plane.
            let beyond = |p: DVec4| self.forward.dot(p.truncate()) - depth * p.w;
            let point = a * beyond(b) - b * beyond(a);
            point.truncate() / point.w
        })
    }

    /// The corners, relative to the eye: four near ones, and four far ones or the directions to
    /// them.
    pub fn corners(&self) -> [DVec4; 8] {
        let near = self.at(self.near);
        let far = if self.far.is_finite() {
            self.at(self.far).map(|p| p.extend(1.0))
        } else {
            let farther = self.at(2.0 * self.near);
            std::array::from_fn(|i| (farther[i] - near[i]).extend(0.0))
        };
        std::array::from_fn(|i| if i < 4 { near[i].extend(1.0) } else { far[i - 4] })
    }

    /// A point or direction of the world, relative to the eye.
    pub fn relative(&self, point: DVec4) -> DVec4 {
        (point.truncate() - self.eye * point.w).extend(point.w)
    }

    /// A box of the world, relative to the eye and larger by what that rounds.
    pub fn relative_box(&self, bounds: &Bounds) -> Bounds {
        let rounding = 8.0 * f64::EPSILON * bounds.largest_coordinate().max(self.eye.abs().max_element());
        Bounds { min: bounds.min - self.eye, max: bounds.max - self.eye }.grown(rounding)
    }

    /// Distances along the view of the nearest and the farthest point of a relative box.
    pub fn depths(&self, relative: &Bounds) -> [f64; 2] {
        let depths = relative.corners().map(|c| self.forward.dot(c));
        [depths.into_iter().fold(f64::INFINITY, f64::min), depths.into_iter().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// The corners of a relative box in clip space; `None` where they are all beyond one plane of
    /// the view.
    pub fn clip_corners(&self, relative: &Bounds) -> Option<[DVec4; 8]> {
        let corners = relative.corners().map(|c| self.clip_from_relative * c.extend(1.0));
        let planes: [fn(&DVec4) -> f64; 6] =
            [|c| c.w + c.x, |c| c.w - c.x, |c| c.w + c.y, |c| c.w - c.y, |c| c.z, |c| c.w - c.z];
        let beyond = |inside: &fn(&DVec4) -> f64| corners.iter().all(|c| inside(c) < 0.0);
        (!relative.is_empty() && !planes.iter().any(beyond)).then_some(corners)
    }
}

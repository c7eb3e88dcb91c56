//! The camera: where it is, and its reversed projection, infinite but for parallel lines of sight.
//!
//! View space looks along −Z with +Y up. Clip space is that of WebGPU: x and y in [−w, w], z in [0,
//! w]; depth is 1 at the near plane and falls to 0 at infinity.

use crate::frustum::Frustum;
use glam::{DAffine3, DMat3, DMat4, DVec2, DVec3, DVec4};

/// A pinhole camera with an infinite far plane, or one whose lines of sight are parallel.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Where rays start, metres.
    pub eye: DVec3,
    /// A point in the middle of the picture.
    pub target: DVec3,
    /// A direction that points up in the picture; not along `target - eye`.
    pub up: DVec3,
    /// Full vertical angle of view, degrees, in (0, 180); not used with `parallel`.
    pub fov_y_deg: f64,
    /// Distance of the near plane, metres, over 0.
    pub near: f64,
    /// Lines of sight are parallel.
    pub parallel: Option<Parallel>,
}

/// What a camera with parallel lines of sight sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parallel {
    /// How much of the scene fits into the picture from bottom to top, metres.
    pub height: f64,
    /// Distance of the far plane, metres, beyond the near plane.
    pub far: f64,
}

impl Default for Camera {
    fn default() -> Self {
        let eye = DVec3::new(0.0, 1.0, 5.0);
        Self { eye, target: DVec3::ZERO, up: DVec3::Y, fov_y_deg: 45.0, near: 0.05, parallel: None }
    }
}

impl Camera {
    /// Unit vectors to the right, up and forward. An `up` along the line of sight is replaced by
    /// another one.
    pub fn axes(&self) -> [DVec3; 3] {
        let forward = (self.target - self.eye).normalize_or(DVec3::NEG_Z);
        let side = forward.cross(self.up);
        let right = if side.length_squared() > 1e-20 { side.normalize() } else { forward.any_orthonormal_vector() };
        [right, right.cross(forward), forward]
    }

    /// Takes world points to view space.
    pub fn view_from_world(&self) -> DAffine3 {
        let [right, up, forward] = self.axes();
        let rotation = DMat3::from_cols(right, up, -forward).transpose();
        DAffine3::from_mat3_translation(rotation, -(rotation * self.eye))
    }

    /// With parallel lines of sight, `height` metres of picture, between two planes at distances
    /// from `eye` that may be negative: then what is behind it is seen. The camera that is made
    /// stands back so far that its own near plane is before it.
    pub fn with_parallel(mut self, height: f64, near: f64, far: f64) -> Self {
        let back = (Self::default().near - near).max(0.0);
        let by = self.axes()[2] * back;
        (self.eye, self.target) = (self.eye - by, self.target - by);
        self.near = near.max(Self::default().near);
        self.parallel = Some(Parallel { height, far: far + back });
        self
    }

    /// The reversed projection for a picture of `aspect` = width / height; infinite, but for
    /// parallel lines of sight.
    pub fn clip_from_view(&self, aspect: f64) -> DMat4 {
        if let Some(Parallel { height, far }) = self.parallel {
            let depth = 1.0 / (far - self.near);
            return DMat4::from_cols(
                DVec4::X * (2.0 / (height * aspect)),
                DVec4::Y * (2.0 / height),
                DVec4::Z * depth,
                DVec4::new(0.0, 0.0, far * depth, 1.0),
            );
        }
        let f = 1.0 / (self.fov_y_deg.to_radians() * 0.5).tan();
        DMat4::from_cols(
            DVec4::new(f / aspect, 0.0, 0.0, 0.0),
            DVec4::new(0.0, f, 0.0, 0.0),
            DVec4::new(0.0, 0.0, 0.0, -1.0),
            DVec4::new(0.0, 0.0, self.near, 0.0),
        )
    }

    /// Direction (not normalised: its share along `forward` is 1) of the ray through pixel (`x`,
    /// `y`) of a `width` × `height` picture; whole numbers are pixel corners, the centre of the
    /// first pixel is (0.5, 0.5).
    pub fn ray(&self, pixel: DVec2, width: u32, height: u32) -> DVec3 {
        let forward = self.axes()[2];
        if self.parallel.is_some() {
            return forward;
        }
        let t = (self.fov_y_deg.to_radians() * 0.5).tan();
        forward + self.across(pixel, width, height) * t
    }

    /// Where that ray starts: at distance 0 along the view.
    pub fn start(&self, pixel: DVec2, width: u32, height: u32) -> DVec3 {
        let by = |parallel: Parallel| self.across(pixel, width, height) * (0.5 * parallel.height);
        self.eye + self.parallel.map_or(DVec3::ZERO, by)
    }

    /// From the middle of the picture to a pixel, in halves of its height.
    fn across(&self, pixel: DVec2, width: u32, height: u32) -> DVec3 {
        let [right, up, _] = self.axes();
        let size = DVec2::new(width as f64, height as f64);
        right * ((2.0 * pixel.x / size.x - 1.0) * size.x / size.y) + up * (1.0 - 2.0 * pixel.y / size.y)
    }

    /// What a technique needs of this camera for a picture of `width` × `height`.
    pub fn view(&self, width: u32, height: u32) -> CameraView {
        CameraView::from_matrices(self.view_from_world(), self.clip_from_view(width as f64 / height as f64))
    }
}

/// A camera as matrices: what techniques work with, and what a host engine hands over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraView {
    /// Where rays start, metres.
    pub eye: DVec3,
    /// World to view space.
    pub view_from_world: DAffine3,
    /// View to clip space; any projection with WebGPU's clip volume, reversed or not, finite or
    /// not.
    pub clip_from_view: DMat4,
}

impl CameraView {
    /// From a rigid view transform and any projection.
    pub fn from_matrices(view_from_world: DAffine3, clip_from_view: DMat4) -> Self {
        Self { eye: view_from_world.inverse().translation, view_from_world, clip_from_view }
    }

    /// True where lines of sight are parallel.
    pub fn is_parallel(&self) -> bool {
        self.clip_from_view.row(3).truncate() == DVec3::ZERO
    }

    /// True where the picture is mirrored: front faces are wound clockwise in it.
    pub fn is_mirrored(&self) -> bool {
        let m = self.clip_from_world();
        let [x, y, w] = [0, 1, 3].map(|i| m.row(i).truncate());
        let away = if self.is_parallel() { self.forward() } else { w };
        DMat3::from_cols(x, y, away).determinant() > 0.0
    }

    /// The volume that is seen.
    pub fn frustum(&self) -> Frustum {
        Frustum::of(&self.clip_from_world())
    }

    /// Unit vector along the view.
    pub fn forward(&self) -> DVec3 {
        -self.view_from_world.matrix3.row(2)
    }

    /// World to clip space.
    pub fn clip_from_world(&self) -> DMat4 {
        self.clip_from_view * DMat4::from(self.view_from_world)
    }

    /// The depth that the buffer holds where nothing was drawn: that of a point infinitely far
    /// along the view.
    pub fn background_depth(&self) -> f32 {
        let far = self.clip_from_view * DVec4::new(0.0, 0.0, -1.0, 0.0);
        // A reversed projection has its far end at 0, finite or not; others at 1.
        let near = self.clip_from_view * DVec4::new(0.0, 0.0, -1e-3, 1.0);
        let (far, near) = (far.z / far.w, near.z / near.w);
        if far < near { 0.0 } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera { eye: DVec3::new(1.0, 2.0, 3.0), target: DVec3::new(-4.0, 0.5, 1.0), ..Camera::default() }
    }

    #[test]
    fn depth_is_one_at_the_near_plane_and_zero_at_infinity() {
        let c = camera();
        let m = c.view(640, 480).clip_from_world();
        let at = |d: f64| {
            let p = m * (c.eye + c.axes()[2] * d).extend(1.0);
            p.z / p.w
        };
        assert!((at(c.near) - 1.0).abs() < 1e-9);
        assert!((at(10.0) - c.near / 10.0).abs() < 1e-9);
        assert!(at(1e12) < 1e-9);
        assert_eq!(c.view(4, 3).background_depth(), 0.0);
    }

    #[test]
    fn the_ray_of_a_pixel_projects_back_to_it() {
        let c = camera();
        let m = c.view(640, 480).clip_from_world();
        let pixel = DVec2::new(17.5, 401.5);
        let p = m * (c.eye + c.ray(pixel, 640, 480) * 7.0).extend(1.0);
        let ndc = p / p.w;
        assert!(((ndc.x * 0.5 + 0.5) * 640.0 - pixel.x).abs() < 1e-9);
        assert!(((0.5 - ndc.y * 0.5) * 480.0 - pixel.y).abs() < 1e-9);
    }

    #[test]
    fn parallel_lines_of_sight_project_back_too() {
        let c = camera().with_parallel(21.6, -500.0, 1000.0);
        assert!(c.near > 0.0);
        let m = c.view(640, 480).clip_from_world();
        let pixel = DVec2::new(17.5, 401.5);
        for (distance, depth) in [(-500.0, 1.0), (1000.0, 0.0), (250.0, 0.5)] {
            let along = distance + c.near + 500.0;
            let p = c.start(pixel, 640, 480) + c.ray(pixel, 640, 480) * along;
            let ndc = m * p.extend(1.0);
            assert!(((ndc.x * 0.5 + 0.5) * 640.0 - pixel.x).abs() < 1e-9);
            assert!(((0.5 - ndc.y * 0.5) * 480.0 - pixel.y).abs() < 1e-9);
            assert!((ndc.z - depth).abs() < 1e-9 && ndc.w == 1.0, "{ndc}");
        }
        let view = c.view(640, 480);
        assert!(view.is_parallel() && !camera().view(4, 3).is_parallel());
        for view in [view, camera().view(4, 3)] {
            let flipped = |x, y| DMat4::from_scale(DVec3::new(x, y, 1.0)) * view.clip_from_view;
            let is = |x, y| CameraView { clip_from_view: flipped(x, y), ..view }.is_mirrored();
            assert_eq!([is(1.0, 1.0), is(-1.0, 1.0), is(1.0, -1.0), is(-1.0, -1.0)], [false, true, true, false]);
        }
        assert_eq!(view.background_depth(), 0.0);
    }

    #[test]
    fn looking_straight_up_is_no_singularity() {
        let c = Camera { eye: DVec3::ZERO, target: DVec3::Y, ..Camera::default() };
        assert!(c.view_from_world().is_finite());
    }

    #[test]
    fn a_standard_projection_has_its_background_at_one() {
        let (n, f) = (0.1, 100.0);
        let finite = DMat4::from_cols(
            DVec4::X,
            DVec4::Y,
            DVec4::new(0.0, 0.0, f / (n - f), -1.0),
            DVec4::new(0.0, 0.0, n * f / (n - f), 0.0),
        );
        let view = CameraView::from_matrices(DAffine3::IDENTITY, finite);
        assert_eq!(view.background_depth(), 1.0);
    }
}

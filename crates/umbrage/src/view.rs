//! One light seen from one camera: all that a technique works on.

use crate::{casters::Casters, receivers::Receivers};
use umbrage_core::glam::{DMat4, DVec3, DVec4};
use umbrage_core::{Bounds, CameraView, Frustum, Light, LitPart, Texture, lit_part};

/// Camera, receivers, casters and the one light whose visibility is asked for.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// The camera that made the receivers.
    pub camera: CameraView,
    /// Depth and normals of the visible surfaces.
    pub receivers: &'a Receivers,
    /// What casts shadows.
    pub casters: &'a Casters,
    /// The light.
    pub light: &'a Light,
    /// Pictures that textured lights refer to; may be empty where there are none.
    pub textures: &'a [Texture],
}

impl View<'_> {
    /// Camera-relative space to clip space: the camera's rotation and projection without its place.
    /// Working relative to the eye keeps single precision exact near the camera, however far that
    /// is from the origin.
    pub fn clip_from_eye(&self) -> DMat4 {
        clip_from_eye(&self.camera)
    }

    /// The part of the picture in which the light can light anything, as far as its range, its cone
    /// and the instances tell. `None` where it lights nothing that is seen: a host may leave out
    /// such a light altogether, and shade no more than this part under others.
    ///
    /// What is no instance counts only where the casters know of it.
    pub fn lit_part(&self) -> Option<LitPart> {
        lit_part(self.light, &self.camera, &self.casters.all_bounds())
    }

    /// The same as pixels: the first across and down, and how many of each.
    pub(crate) fn lit_pixels(&self) -> [u32; 4] {
        self.lit_part().map_or([0; 4], |part| part.pixels(self.receivers.size))
    }

    /// A box around what the camera sees of the receivers.
    pub(crate) fn seen(&self) -> Bounds {
        let mut corners = Vec::with_capacity(32);
        Frustum::of(&self.camera.clip_from_world()).clip_box(&self.casters.receivers_bounds(), &mut corners);
        Bounds::of(corners)
    }

    /// How far single precision moves things in shaders, metres.
    pub(crate) fn rounding(&self) -> f64 {
        let origin = self.casters.origin();
        let light = self.light.shape.center();
        let scene = self.casters.all_bounds();
        let scene = Bounds { min: scene.min - origin, max: scene.max - origin }.largest_coordinate();
        let points = [self.camera.eye - origin, (light.truncate() - origin) * light.w];
        4e-6 * points.iter().map(|p| p.abs().max_element()).fold(scene, f64::max)
    }

    /// See [`around_eye`].
    pub(crate) fn around_eye(&self) -> Bounds {
        around_eye(&self.camera)
    }
}

/// A box around the eye and the near rectangle: only what touches it can be cut open by the near
/// plane, or hold the eye.
pub(crate) fn around_eye(camera: &CameraView) -> Bounds {
    let eye_from_clip = clip_from_eye(camera).inverse();
    let near_depth = if camera.background_depth() == 0.0 { 1.0 } else { 0.0 };
    let near = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)].map(|(x, y)| {
        let p = eye_from_clip * DVec4::new(x, y, near_depth, 1.0);
        camera.eye + p.truncate() / p.w
    });
    Bounds::of(near).with(camera.eye)
}

/// As [`View::clip_from_eye`].
pub(crate) fn clip_from_eye(camera: &CameraView) -> DMat4 {
    camera.clip_from_view * DMat4::from_mat3(camera.view_from_world.matrix3)
}

/// A light at exactly the place of a vertex has no direction to cast it in. Moved by less than
/// anybody sees, and along no axis, it has.
pub(crate) fn off_ties(light: DVec4, rounding: f64) -> DVec4 {
    light + DVec3::new(0.1, 0.073, 0.087).extend(0.0) * (rounding * light.w)
}

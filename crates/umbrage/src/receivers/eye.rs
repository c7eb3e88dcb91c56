//! The camera as shaders need it that start from visible surfaces.

use crate::shader::shader_struct;
use crate::view::{View, clip_from_eye};
use umbrage_core::{CameraView, glam::DVec4};

shader_struct! {
    /// How to get from a pixel to the surface it shows, see `eye.wgsl`.
    pub struct Eye {
        /// The camera's normalised device coordinates to space relative to the eye, homogeneous.
        eye_from_ndc: [[f32; 4]; 4],
        /// What a pixel is across and down.
        ndc_from_pixel: [f32; 2],
        /// What the depth buffer holds where nothing was drawn.
        background_depth: f32,
        /// The largest |x| + |y| + |z| of `eye_from_ndc` in the picture, before the division by w,
        /// times the steps of single precision by which depth may be off.
        rounding: f32,
        /// How far the rasteriser that made the depth buffer may shift surfaces to the right, in
        /// space relative to the eye, times w.
        shift_right: [f32; 3],
        /// −1 where the picture is mirrored, else 1.
        handed: f32,
        /// The same downwards.
        shift_down: [f32; 3],
        /// Nothing.
        pad: f32,
    }
}

impl Eye {
    /// For the camera and size of `view`.
    pub fn new(view: &View<'_>) -> Self {
        let seen = view.receivers;
        Self::of(&view.camera, seen.size, seen.snapping.max(seen.bend), seen.coarseness)
    }

    /// For a camera whose picture has `size`; depth may be shifted by `snapping` pixels and rounded
    /// to `coarseness` steps of single precision.
    pub(crate) fn of(camera: &CameraView, size: (u32, u32), snapping: f32, coarseness: f32) -> Self {
        let (width, height) = size;
        let eye_from_ndc = clip_from_eye(camera).inverse();
        let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
        let ends = corners.into_iter().flat_map(|(x, y)| [0.0, 1.0].map(|z| eye_from_ndc * DVec4::new(x, y, z, 1.0)));
        let reach = ends.map(|p| p.truncate().abs().element_sum()).fold(0.0, f64::max) as f32;
        let [shift_right, shift_down] = [(eye_from_ndc.x_axis, width), (eye_from_ndc.y_axis, height)]
            .map(|(axis, pixels)| (axis.truncate() * f64::from(2.0 * snapping / pixels as f32)).as_vec3().to_array());
        Self {
            rounding: coarseness * reach,
            eye_from_ndc: eye_from_ndc.as_mat4().to_cols_array_2d(),
            ndc_from_pixel: [2.0 / width as f32, -2.0 / height as f32],
            background_depth: camera.background_depth(),
            shift_right,
            handed: if camera.is_mirrored() { -1.0 } else { 1.0 },
            shift_down,
            pad: 0.0,
        }
    }
}

//! A light's form as shaders read it, see `area_light.wgsl`.

use super::form::Form;
use crate::shader::shader_struct;
use crate::view::View;
use umbrage_core::coverage::Cell;
use umbrage_core::glam::{DMat3, DMat4, DVec3, DVec4};

shader_struct! {
    /// See `area_light.wgsl`.
    pub(crate) struct AreaLight {
        clip_from_eye: [[f32; 4]; 4],
        to_light: [[f32; 4]; 3],
        from_light: [[f32; 4]; 3],
        corners: [[f32; 4]; 4],
        low: [f32; 4],
        high: [f32; 4],
        center: [f32; 3],
        radius: f32,
        eye_from_origin: [f32; 3],
        parallel: u32,
        rounding: f32,
        cap_chunks: u32,
        scale: u32,
        handed: f32,
        first_wedge: u32,
        most_wedges: u32,
        pad: [u32; 2],
        cell: [f32; 4],
        cell_sides: [f32; 4],
        cell_arc: [f32; 4],
        toward_eye: [f32; 3],
        eye_w: f32,
    }
}

shader_struct! {
    /// See `area_light.wgsl`.
    pub(crate) struct Anchor {
        place: [f32; 3],
        pad_a: f32,
        axis: [f32; 3],
        pad_b: f32,
    }
}

/// How a frame is drawn, for the shaders.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    /// The share of coordinates that single precision is off by.
    pub rounding: f64,
    /// Chunks of triangles whose caps are made.
    pub cap_chunks: u32,
    /// Pixels of the picture to one of the buffer of shares, along each side.
    pub scale: u32,
    /// The first of the wedges that are built, and how many they are at most.
    pub wedges: [u32; 2],
}

impl Form {
    /// For the shaders.
    pub fn uniform(&self, view: &View<'_>, frame: &Frame) -> AreaLight {
        let rounding = frame.rounding;
        let eye = view.camera.eye;
        let center = (self.center.truncate() - eye) * self.center.w;
        let rows = |m: DMat3| [0, 1, 2].map(|i| m.row(i).extend(0.0).as_vec4().to_array());
        let seen = view.seen();
        let seen = seen.grown(4.0 * rounding * seen.largest_coordinate());
        let corner = |p: DVec3| p.extend(0.0).as_vec4().to_array();
        let clip = raster(view.receivers.size, frame.scale) * view.clip_from_eye();
        let cell = self.cell.unwrap_or_else(|| Cell::grid(1)[0]);
        let is_parallel = view.camera.is_parallel();
        let start = if is_parallel { (-view.camera.forward()).extend(0.0) } else { DVec4::W };
        let singles = |v: [f64; 4]| v.map(|c| c as f32);
        AreaLight {
            clip_from_eye: clip.as_mat4().to_cols_array_2d(),
            to_light: rows(self.to_light),
            from_light: rows(self.to_light.inverse()),
            corners: self.corners.map(corner),
            low: corner(seen.min - eye),
            high: corner(seen.max - eye),
            center: center.as_vec3().to_array(),
            radius: self.radius as f32,
            eye_from_origin: (view.casters.origin() - eye).as_vec3().to_array(),
            parallel: u32::from(self.center.w == 0.0),
            rounding: rounding as f32,
            cap_chunks: frame.cap_chunks,
            scale: frame.scale,
            handed: self.to_light.determinant().signum() as f32,
            first_wedge: frame.wedges[0],
            most_wedges: frame.wedges[1],
            pad: [0; 2],
            cell: singles([cell.low[0], cell.low[1], cell.high[0], cell.high[1]]),
            cell_sides: singles(cell.sides),
            cell_arc: singles([cell.arc_middle[0], cell.arc_middle[1], cell.arc, cell.around]),
            toward_eye: start.truncate().as_vec3().to_array(),
            eye_w: start.w as f32,
        }
    }
}

/// Size of a buffer that has one place for `scale` pixels along each side, of those whose pixel is
/// in the picture.
pub(crate) fn scaled((width, height): (u32, u32), scale: u32) -> (u32, u32) {
    let of = |pixels: u32| pixels.saturating_sub(1 + scale / 2) / scale + 1;
    (of(width), of(height))
}

/// Takes the picture's clip space to that of such a buffer, so that the middle of a place is that
/// of the pixel it stands for.
fn raster(size: (u32, u32), scale: u32) -> DMat4 {
    let (width, height) = scaled(size, scale);
    let of = |pixels: u32, places: u32| {
        let share = f64::from(pixels) / f64::from(places * scale);
        let moved = 0.5 - (f64::from(scale / 2) + 0.5) / f64::from(scale);
        (share, share - 1.0 + 2.0 * moved / f64::from(places))
    };
    let ((x, right), (y, down)) = (of(size.0, width), of(size.1, height));
    DMat4::from_cols(DVec4::X * x, DVec4::Y * y, DVec4::Z, DVec4::new(right, -down, 0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_of_smaller_buffers_are_pixels() {
        for (size, scale) in [((512, 384), 1), ((512, 384), 2), ((511, 383), 2), ((640, 479), 4), ((9, 7), 4)] {
            let (width, height) = scaled(size, scale);
            let raster = raster(size, scale);
            let ndc = |pixel: u32, of: u32| 2.0 * (f64::from(pixel) + 0.5) / f64::from(of) - 1.0;
            for (x, y) in [(0, 0), (width - 1, height - 1), (width / 2, height / 3)] {
                let (full_x, full_y) = (x * scale + scale / 2, y * scale + scale / 2);
                assert!(full_x < size.0 && full_y < size.1, "{size:?} {scale}");
                let got = raster * DVec4::new(ndc(full_x, size.0), -ndc(full_y, size.1), 0.0, 1.0);
                assert!(
                    (got.x - ndc(x, width)).abs() < 1e-12 && (got.y + ndc(y, height)).abs() < 1e-12,
                    "{size:?} {scale}"
                );
            }
        }
    }
}

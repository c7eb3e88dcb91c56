//! ꟻLIP of visibility and of colour pictures.

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageFloat, FlipImageRgb8};
use umbrage_core::Image;

/// Mean ꟻLIP over the scored pixels of two visibility pictures of one size, shown as light: linear
/// grey in sRGB.
///
/// Pixels that are not scored are made equal in both, so that they do not count either for their
/// neighbours. A produced value that is not finite is shown as the opposite of the reference. 0
/// without any scored pixel.
pub fn of_visibility(produced: &Image<f32>, reference: &Image<f32>, mask: &Image<bool>) -> f64 {
    let map = visibility_map(produced, reference, mask);
    let scored: Vec<f32> = map.into_iter().zip(&mask.data).filter(|(_, scored)| **scored).map(|(e, _)| e).collect();
    mean(&scored)
}

/// Where that is, in sRGB: from black, no difference, over violet and orange to white, the largest;
/// the map of colours that ꟻLIP is published with.
pub fn flip_colors(produced: &Image<f32>, reference: &Image<f32>, mask: &Image<bool>) -> Image<[u8; 3]> {
    let (width, height) = reference.size();
    let map = FlipImageFloat::with_data(width, height, &visibility_map(produced, reference, mask));
    if reference.data.is_empty() {
        return Image::filled(width, height, [0; 3]);
    }
    let colors = map.apply_color_lut(&nv_flip::magma_lut()).to_vec();
    Image { width, height, data: colors.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect() }
}

fn visibility_map(produced: &Image<f32>, reference: &Image<f32>, mask: &Image<bool>) -> Vec<f32> {
    let shown: Vec<f32> = (produced.data.iter().zip(&reference.data).zip(&mask.data))
        .map(|((&p, &r), &scored)| match (scored, p.is_finite()) {
            (false, _) => r,
            (true, true) => p,
            (true, false) => 1.0 - r.round(),
        })
        .collect();
    let grey = |values: &[f32]| values.iter().flat_map(|&v| [srgb(v); 3]).collect::<Vec<u8>>();
    map(reference.size(), &grey(&reference.data), &grey(&shown))
}

/// Mean ꟻLIP of two sRGB pictures of one size.
pub fn of_colors(produced: &Image<[u8; 3]>, reference: &Image<[u8; 3]>) -> f64 {
    mean(&map(reference.size(), reference.data.as_flattened(), produced.data.as_flattened()))
}

fn map((width, height): (u32, u32), reference: &[u8], produced: &[u8]) -> Vec<f32> {
    if reference.is_empty() {
        return Vec::new();
    }
    let image = |rgb: &[u8]| FlipImageRgb8::with_data(width, height, rgb);
    nv_flip::flip(image(reference), image(produced), DEFAULT_PIXELS_PER_DEGREE).to_vec()
}

fn mean(errors: &[f32]) -> f64 {
    let sum: f64 = errors.iter().map(|&e| f64::from(e)).sum();
    sum / errors.len().max(1) as f64
}

/// A linear value as 8-bit sRGB (IEC 61966-2-1).
fn srgb(linear: f32) -> u8 {
    let v = linear.clamp(0.0, 1.0);
    let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_has_its_fixed_points() {
        assert_eq!([0.0, 0.215_861, 1.0, 7.0].map(srgb), [0, 128, 255, 255]);
    }

    #[test]
    fn white_instead_of_black_is_the_largest_error() {
        let picture = |v: u8| Image::filled(64, 48, [v; 3]);
        let error = of_colors(&picture(255), &picture(0));
        assert!(error > 0.9 && error <= 1.0, "{error}");
        assert_eq!(of_colors(&picture(9), &picture(9)), 0.0);
    }

    #[test]
    fn where_two_differ_is_bright_and_the_rest_black() {
        let reference = Image::filled(64, 16, 0.0);
        let produced = Image::from_fn(64, 16, |x, _| if x < 32 { 1.0 } else { 0.0 });
        let colors = flip_colors(&produced, &reference, &Image::filled(64, 16, true));
        let [bright, dark] = [colors[(8, 8)], colors[(60, 8)]];
        assert!(bright[0] > 200 && dark.iter().all(|c| *c < 10), "{bright:?} {dark:?}");
    }

    #[test]
    fn one_pixel_is_a_picture_and_none_is_one_too() {
        assert!(of_colors(&Image::filled(1, 1, [255; 3]), &Image::filled(1, 1, [0; 3])) > 0.5);
        assert_eq!(of_colors(&Image::filled(0, 3, [255; 3]), &Image::filled(0, 3, [0; 3])), 0.0);
    }
}

//! Where the errors are, as a picture.

use crate::score::difference;
use umbrage_core::Image;

/// Errors are shown this many times as strong as they are.
const GAIN: f64 = 4.0;
const LEAK: [f64; 3] = [255.0, 40.0, 20.0];
const FALSE_SHADOW: [f64; 3] = [30.0, 90.0, 255.0];
const NOT_SCORED: [u8; 3] = [18, 18, 26];

/// A signed error map in sRGB: red where light leaks in, blue where there is false shadow, at full
/// strength from an error of 0.25; grey by the reference where the pixel is right, so that one sees
/// where one is; almost black where it is not scored.
///
/// The picture has the size of the reference; pixels outside the others are not scored.
pub fn heat(produced: &Image<f32>, reference: &Image<f32>, mask: &Image<bool>) -> Image<[u8; 3]> {
    Image::from_fn(reference.width, reference.height, |x, y| {
        let place = (i64::from(x), i64::from(y));
        let scored = mask.get(place.0, place.1) == Some(&true);
        match produced.get(place.0, place.1) {
            Some(&value) if scored => color(difference(value, reference[(x, y)]), reference[(x, y)]),
            _ => NOT_SCORED,
        }
    })
}

fn color(error: f64, reference: f32) -> [u8; 3] {
    let grey = 70.0 + 130.0 * f64::from(reference.clamp(0.0, 1.0));
    let strength = (GAIN * error.abs()).min(1.0);
    let full = if error > 0.0 { LEAK } else { FALSE_SHADOW };
    full.map(|c| (grey + (c - grey) * strength).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sign_chooses_the_colour_and_right_pixels_are_grey() {
        let reference = Image::filled(4, 1, 0.5);
        let produced = Image { width: 4, height: 1, data: vec![0.9, 0.1, 0.5, 0.0] };
        let mask = Image { width: 4, height: 1, data: vec![true, true, true, false] };
        let [leak, shadow, right, unscored] = heat(&produced, &reference, &mask).data[..] else {
            panic!("four pixels expected")
        };
        assert!(leak[0] > 200 && leak[2] < 100, "{leak:?}");
        assert!(shadow[2] > 200 && shadow[0] < 100, "{shadow:?}");
        assert!(right[0] == right[1] && right[1] == right[2], "{right:?}");
        assert_eq!(unscored, NOT_SCORED);
    }

    #[test]
    fn nan_is_as_red_as_can_be() {
        let one = |v| Image::filled(1, 1, v);
        assert_eq!(heat(&one(f32::NAN), &one(0.0), &Image::filled(1, 1, true)).data[0][0], 255);
    }
}

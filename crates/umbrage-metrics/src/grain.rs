//! What the eye sees first in soft shadows: grain in penumbras, and single wrong pixels.

use crate::score::difference;
use umbrage_core::Image;

/// Half the side of the square whose mean is taken off a pixel's error, pixels.
const REACH: i64 = 2;

/// A penumbra is smooth where the reference changes by no more than this from pixel to pixel.
const SMOOTH: f32 = 0.1;

/// Visibility nearer to 0 or 1 than this is umbra or light.
const PARTLY: f32 = 0.02;

/// A speckle differs from all its neighbours by more than this.
const SPECKLE: f32 = 0.3;

/// The eight neighbours of a pixel.
const AROUND: [(i64, i64); 8] = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];

/// The standard deviation of what is grainy in the error of smooth penumbras; `None` where there is
/// no smooth penumbra.
///
/// Of the signed error at a pixel the mean over the 5×5 pixels around it is taken off, so that a
/// penumbra too wide or too dark is no noise, and what changes from pixel to pixel is. The root of
/// the mean square of the rest is scaled so that independent errors of standard deviation σ have
/// noise σ. A pixel counts where the reference is over 0.02 and under 0.98 and all 25 pixels are
/// scored and change by at most 0.1 from one to the next.
pub(crate) fn noise(produced: &Image<f32>, reference: &Image<f32>, mask: &Image<bool>) -> Option<f64> {
    let smooth = smooth(reference, mask);
    let side = (2 * REACH + 1) as f64;
    let (mut sum, mut count) = (0.0, 0_usize);
    for (x, y) in pixels(reference) {
        let value = reference[(x as u32, y as u32)];
        if !(PARTLY..=1.0 - PARTLY).contains(&value) {
            continue;
        }
        let around = || (-REACH..=REACH).flat_map(|j| (-REACH..=REACH).map(move |i| (x + i, y + j)));
        if !around().all(|(i, j)| smooth.get(i, j) == Some(&true)) {
            continue;
        }
        let error = |(i, j): (i64, i64)| {
            let at = (i as u32, j as u32);
            difference(produced[at], reference[at])
        };
        let rest = error((x, y)) - around().map(error).sum::<f64>() / (side * side);
        sum += rest * rest;
        count += 1;
    }
    let of_white = 1.0 - 1.0 / (side * side);
    (count > 0).then(|| (sum / count as f64 / of_white).sqrt())
}

/// Scored pixels whose neighbours to the right and below, as far as they are scored, differ little.
fn smooth(reference: &Image<f32>, mask: &Image<bool>) -> Image<bool> {
    let scored = |x: i64, y: i64| mask.get(x, y) == Some(&true);
    let value = |x: i64, y: i64| reference.get(x, y).copied().filter(|_| scored(x, y));
    Image::from_fn(reference.width, reference.height, |x, y| {
        let (x, y) = (i64::from(x), i64::from(y));
        let Some(here) = value(x, y) else { return false };
        [(1, 0), (0, 1)].iter().all(|(i, j)| value(x + i, y + j).is_none_or(|next| (next - here).abs() <= SMOOTH))
    })
}

/// How many scored pixels differ from all their eight neighbours by more than 0.3, all of them
/// scored, where the reference has no such pixel within one pixel. What is not finite differs from
/// everything.
pub(crate) fn speckles(produced: &Image<f32>, reference: &Image<f32>, mask: &Image<bool>) -> usize {
    let alone = |picture: &Image<f32>, x: i64, y: i64| {
        let apart = |a: f32, b: f32| (a - b).abs() > SPECKLE || !(a - b).is_finite();
        picture.get(x, y).is_some_and(|&here| {
            AROUND.iter().all(|(i, j)| {
                let scored = mask.get(x + i, y + j) == Some(&true);
                scored && picture.get(x + i, y + j).is_some_and(|&next| apart(here, next))
            })
        })
    };
    let is_speckle = |&(x, y): &(i64, i64)| {
        let near = || AROUND.iter().chain(&[(0, 0)]).map(|(i, j)| (x + i, y + j));
        mask.get(x, y) == Some(&true) && alone(produced, x, y) && !near().any(|(i, j)| alone(reference, i, j))
    };
    pixels(reference).filter(is_speckle).count()
}

fn pixels<T>(picture: &Image<T>) -> impl Iterator<Item = (i64, i64)> + use<T> {
    let (width, height) = (i64::from(picture.width), i64::from(picture.height));
    (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (96, 64);

    fn picture(of: impl Fn(u32, u32) -> f32) -> Image<f32> {
        Image::from_fn(SIZE.0, SIZE.1, of)
    }

    /// A penumbra over the whole width.
    fn ramp(x: u32) -> f32 {
        x as f32 / SIZE.0 as f32
    }

    /// Independent numbers, 0…1.
    fn random(x: u32, y: u32) -> f32 {
        let mut h = u64::from(x) << 32 | u64::from(y);
        for _ in 0..3 {
            h = (h ^ (h >> 29)).wrapping_add(0x9e37_79b9).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        }
        (h >> 40) as f32 / (1 << 24) as f32
    }

    fn noise_of(produced: &Image<f32>, reference: &Image<f32>) -> Option<f64> {
        noise(produced, reference, &Image::filled(SIZE.0, SIZE.1, true))
    }

    #[test]
    fn independent_errors_have_the_noise_of_their_standard_deviation() {
        let reference = picture(|x, _| ramp(x));
        for half in [0.05, 0.2] {
            // Uniform within ±half: the standard deviation is half / √3.
            let grainy = picture(|x, y| ramp(x) + (2.0 * random(x, y) - 1.0) * half);
            let (found, sigma) = (noise_of(&grainy, &reference).expect("a penumbra"), f64::from(half) / 3_f64.sqrt());
            assert!((found / sigma - 1.0).abs() < 0.03, "{found} for {sigma}");
        }
    }

    #[test]
    fn a_penumbra_that_is_too_wide_or_too_dark_is_no_noise() {
        let reference = picture(|x, _| ramp(x));
        for wrong in [picture(|x, _| ramp(x) * 0.7 + 0.1), picture(|x, y| ramp(x) - 0.002 * y as f32)] {
            assert!(noise_of(&wrong, &reference).is_some_and(|found| found < 1e-6));
        }
        // Stripes of ±0.1 in turn are: the mean over five columns is ±0.02, so 0.08 is left.
        let stripes = picture(|x, _| ramp(x) + if x % 2 == 0 { 0.1 } else { -0.1 });
        let found = noise_of(&stripes, &reference).expect("a penumbra");
        assert!((found - 0.08 / 0.96_f64.sqrt()).abs() < 1e-6, "{found}");
    }

    #[test]
    fn noise_outside_of_smooth_penumbras_does_not_count() {
        let hard = picture(|x, _| if x < 48 { 0.0 } else { 1.0 });
        assert_eq!(noise_of(&picture(random), &hard), None);
        let half = picture(|x, _| if x < 48 { 0.0 } else { 0.5 + ramp(x) * 0.4 });
        let grainy = picture(|x, y| if x < 48 { random(x, y) } else { half[(x, y)] });
        assert_eq!(noise_of(&grainy, &half), Some(0.0), "two columns beside the edge see it");
    }

    #[test]
    fn single_pixels_are_speckles_and_pairs_and_true_ones_are_not() {
        let flat = picture(|_, _| 0.5);
        let all = Image::filled(SIZE.0, SIZE.1, true);
        let with = |spots: &[(u32, u32, f32)]| {
            let mut spotted = flat.clone();
            spots.iter().for_each(|&(x, y, v)| spotted[(x, y)] = v);
            spotted
        };
        assert_eq!(speckles(&with(&[(9, 9, 0.0), (20, 9, 1.0), (30, 9, f32::NAN)]), &flat, &all), 3);
        assert_eq!(speckles(&with(&[(9, 9, 0.79)]), &flat, &all), 0, "it differs too little");
        assert_eq!(speckles(&with(&[(9, 9, 0.0), (10, 10, 0.0)]), &flat, &all), 0, "two together");
        assert_eq!(speckles(&with(&[(0, 9, 0.0)]), &flat, &all), 0, "at the border not all neighbours are known");
        assert_eq!(speckles(&with(&[(9, 9, 0.0)]), &with(&[(10, 9, 0.0)]), &all), 0, "the truth has one beside it");
        let mut mask = all.clone();
        mask[(8, 8)] = false;
        assert_eq!(speckles(&with(&[(9, 9, 0.0)]), &flat, &mask), 0, "a neighbour is not scored");
    }
}

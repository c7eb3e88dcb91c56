//! Errors of a picture of radiance against a reference.

use crate::error::{Error, same_size};
use umbrage_core::Image;

/// Luminance of linear colours, Rec. 709.
pub fn luminance(color: &[f32; 3]) -> f64 {
    let [r, g, b] = color.map(f64::from);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// What to compare: pictures of one size, linear red, green and blue.
#[derive(Clone, Copy, Debug)]
pub struct RadianceComparison<'a> {
    /// The radiance to judge; a value that is not finite counts as black.
    pub produced: &'a Image<[f32; 3]>,
    /// The true radiance.
    pub reference: &'a Image<[f32; 3]>,
    /// True where a pixel counts.
    pub mask: &'a Image<bool>,
}

/// Errors of luminance over the scored pixels, as shares of the reference's mean luminance: how
/// bright the light is does not matter. With d = produced − reference:
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadianceScores {
    /// Mean of |d|. `None` where the reference is black.
    pub relative_mae: Option<f64>,
    /// Square root of the mean of d². `None` where the reference is black.
    pub relative_rmse: Option<f64>,
    /// Mean of d: over 0 where the picture is too bright. `None` where the reference is black.
    pub relative_bias: Option<f64>,
    /// Percentage of pixels with a channel under 0, which no light can be: a basis rings there.
    pub negative_pct: f64,
    /// How many pixels were compared.
    pub scored_pixels: usize,
    /// How many of them were NaN or infinite.
    pub not_finite: usize,
}

/// Compares a picture of radiance with a reference.
///
/// # Errors
/// Pictures of different sizes, and a mask without any pixel.
pub fn score_radiance(comparison: &RadianceComparison<'_>) -> Result<RadianceScores, Error> {
    let RadianceComparison { produced, reference, mask } = *comparison;
    same_size("produced", produced, reference)?;
    same_size("mask", mask, reference)?;
    let pairs = produced.data.iter().zip(&reference.data).zip(&mask.data);
    let scored: Vec<_> = pairs.filter(|(_, scored)| **scored).map(|(pair, _)| pair).collect();
    if scored.is_empty() {
        return Err(Error::NothingScored);
    }
    let is_finite = |p: &[f32; 3]| p.iter().all(|channel| channel.is_finite());
    let difference =
        |(p, r): &(&[f32; 3], &[f32; 3])| if is_finite(p) { luminance(p) - luminance(r) } else { -luminance(r) };
    let count = scored.len() as f64;
    let mean = |of: &dyn Fn(f64) -> f64| scored.iter().map(|pair| of(difference(pair))).sum::<f64>() / count;
    let brightness = scored.iter().map(|(_, r)| luminance(r)).sum::<f64>() / count;
    let relative = |error: f64| (brightness > 0.0).then(|| error / brightness);
    let negative = scored.iter().filter(|(p, _)| p.iter().any(|channel| *channel < 0.0)).count();
    Ok(RadianceScores {
        relative_mae: relative(mean(&f64::abs)),
        relative_rmse: relative(mean(&|d| d * d).sqrt()),
        relative_bias: relative(mean(&|d| d)),
        negative_pct: 100.0 * negative as f64 / count,
        scored_pixels: scored.len(),
        not_finite: scored.iter().filter(|(p, _)| !is_finite(p)).count(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scores(produced: [f32; 3], reference: [f32; 3]) -> RadianceScores {
        let [produced, reference] = [produced, reference].map(|color| Image::filled(4, 2, color));
        let mask = Image::filled(4, 2, true);
        score_radiance(&RadianceComparison { produced: &produced, reference: &reference, mask: &mask })
            .expect("comparable pictures")
    }

    #[test]
    fn an_even_error_is_a_share_of_the_reference_whatever_its_brightness() {
        for light in [0.01, 1.0, 100.0] {
            let found = scores([1.25 * light; 3], [light; 3]);
            for error in [found.relative_mae, found.relative_rmse, found.relative_bias] {
                assert!(error.is_some_and(|e| (e - 0.25).abs() < 1e-6), "{found:?}");
            }
            assert!(scores([0.5 * light; 3], [light; 3]).relative_bias.is_some_and(|e| (e + 0.5).abs() < 1e-6));
            assert_eq!(scores([light; 3], [light; 3]).relative_rmse, Some(0.0));
        }
    }

    #[test]
    fn errors_that_cancel_are_no_bias_and_large_ones_weigh_more() {
        let reference = Image::filled(4, 1, [1.0; 3]);
        let produced = Image { width: 4, height: 1, data: vec![[3.0; 3], [-1.0; 3], [1.0; 3], [1.0; 3]] };
        let mask = Image::filled(4, 1, true);
        let found = score_radiance(&RadianceComparison { produced: &produced, reference: &reference, mask: &mask })
            .expect("comparable pictures");
        let numbers = [found.relative_mae, found.relative_rmse, found.relative_bias].map(|n| n.expect("light"));
        for (number, expected) in numbers.into_iter().zip([1.0, 2.0_f64.sqrt(), 0.0]) {
            assert!((number - expected).abs() < 1e-9, "{found:?}");
        }
        assert_eq!(found.negative_pct, 25.0);
    }

    #[test]
    fn black_references_and_broken_values_are_told() {
        let black = scores([0.1; 3], [0.0; 3]);
        assert_eq!((black.relative_mae, black.relative_rmse, black.relative_bias), (None, None, None));
        let broken = scores([f32::NAN, 0.0, 0.0], [1.0; 3]);
        assert_eq!((broken.not_finite, broken.scored_pixels), (8, 8));
        assert!(broken.relative_mae.is_some_and(|e| (e - 1.0).abs() < 1e-9), "{broken:?}");
        assert_eq!(scores([0.0, -0.1, 5.0], [1.0; 3]).negative_pct, 100.0, "one channel is enough");
    }

    #[test]
    fn what_is_not_scored_does_not_count() {
        let reference = Image::filled(2, 1, [1.0; 3]);
        let produced = Image { width: 2, height: 1, data: vec![[1.0; 3], [-9.0; 3]] };
        let mask = Image { width: 2, height: 1, data: vec![true, false] };
        let with = RadianceComparison { produced: &produced, reference: &reference, mask: &mask };
        let found = score_radiance(&with).expect("comparable pictures");
        assert_eq!((found.relative_mae, found.negative_pct, found.scored_pixels), (Some(0.0), 0.0, 1));
        let none = Image::filled(2, 1, false);
        assert_eq!(score_radiance(&RadianceComparison { mask: &none, ..with }), Err(Error::NothingScored));
        let small = Image::filled(1, 1, true);
        let wrong = score_radiance(&RadianceComparison { mask: &small, ..with });
        assert!(matches!(wrong, Err(Error::Size { name: "mask", .. })), "{wrong:?}");
    }
}

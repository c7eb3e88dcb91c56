//! Errors of a visibility picture against a reference.

use crate::error::{Error, same_size};
#[cfg(feature = "flip")]
use crate::flip;
use crate::{
    contact::contact_gap,
    contour::{EdgeOffset, edge_offset},
    grain,
    interior::interior,
    ssim,
};
use umbrage_core::Image;

/// A pixel is correct where its visibility is off by no more than this.
pub const TOLERANCE: f64 = 0.02;

/// What to compare: pictures of one size.
#[derive(Clone, Copy, Debug)]
pub struct Comparison<'a> {
    /// The visibility to judge, 0…1; a value that is not finite counts as an error of 1.
    pub produced: &'a Image<f32>,
    /// The true visibility, 0…1.
    pub reference: &'a Image<f32>,
    /// True where a pixel counts.
    pub mask: &'a Image<bool>,
    /// The perfect hard shadow, one ray to the light's centre, that [`Scores::vs_hard`] compares
    /// with.
    pub hard: Option<&'a Image<f32>>,
    /// How far from a shadow edge a pixel must be to count for [`Scores::interior_pct`], see
    /// [`interior()`].
    pub reach: Option<&'a Image<f32>>,
    /// Where surfaces touch, see [`contacts`](crate::contacts()), for [`Scores::contact_gap`].
    pub contacts: Option<&'a Image<bool>>,
}

/// Errors over the scored pixels. With d = produced − reference:
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scores {
    /// Mean of |d|, 0…1.
    pub mae: f64,
    /// Square root of the mean of d².
    pub rmse: f64,
    /// 99th percentile of |d|, interpolated linearly.
    pub p99: f64,
    /// Structural similarity, 1 = the same: Wang et al., "Image quality assessment", 2004, with
    /// only the scored pixels of every window.
    pub ssim: f64,
    /// Mean of ꟻLIP, the difference that somebody sees who flips between the two as sRGB pictures,
    /// 0…1: Andersson et al., "ꟻLIP: A Difference Evaluator for Alternating Images", 2020, 67
    /// pixels a degree. It needs the feature `flip` of the crate, and with it a C++ compiler.
    #[cfg(feature = "flip")]
    pub flip: f64,
    /// Percentage of pixels with |d| ≤ [`TOLERANCE`].
    pub correct_pct: f64,
    /// Percentage correct among the pixels far from every shadow edge, where acne and peter-panning
    /// show and nothing else; `None` where there is no such pixel.
    pub interior_pct: Option<f64>,
    /// Mean of d where it is over 0: light in the shadow.
    pub leak: f64,
    /// Mean of −d where d is under 0: shadow in the light.
    pub false_shadow: f64,
    /// `mae` as a share of that of the perfect hard shadow: 1 = no better than hard, 0 = the truth.
    /// `None` where the hard shadow is not given or is the truth itself.
    pub vs_hard: Option<f64>,
    /// Grain: the standard deviation of what changes from pixel to pixel in the error of smooth
    /// penumbras, less the mean over 5×5 pixels. `None` where there is no smooth penumbra.
    pub noise: Option<f64>,
    /// Pixels that differ from all their eight neighbours by more than 0.3 where the reference has
    /// none such.
    pub speckles: usize,
    /// How far the outlines of shadows, where visibility is one half, lie from the reference's,
    /// pixels. `None` where there is no outline.
    pub edge_offset: Option<EdgeOffset>,
    /// Mean width of the light between casters and the shadows that should touch them, pixels.
    /// `None` where contacts are not given, and where none is dark.
    pub contact_gap: Option<f64>,
    /// How many pixels were compared.
    pub scored_pixels: usize,
    /// How many of them were NaN or infinite.
    pub not_finite: usize,
}

/// Compares a visibility picture with a reference.
///
/// # Errors
/// Pictures of different sizes, and a mask without any pixel.
pub fn score(comparison: &Comparison<'_>) -> Result<Scores, Error> {
    let Comparison { produced, reference, mask, hard, reach, contacts } = *comparison;
    same_size("produced", produced, reference)?;
    same_size("mask", mask, reference)?;
    hard.map_or(Ok(()), |h| same_size("hard shadow", h, reference))?;
    reach.map_or(Ok(()), |r| same_size("reach", r, reference))?;
    contacts.map_or(Ok(()), |c| same_size("contacts", c, reference))?;

    let errors = differences(produced, reference, mask);
    if errors.is_empty() {
        return Err(Error::NothingScored);
    }
    let mean = |f: &dyn Fn(f64) -> f64| errors.iter().map(|&d| f(d)).sum::<f64>() / errors.len() as f64;
    let mae = mean(&f64::abs);
    let hard_mae = hard.map_or(0.0, |hard| {
        let errors = differences(hard, reference, mask);
        errors.iter().map(|d| d.abs()).sum::<f64>() / errors.len() as f64
    });
    let inside = differences(produced, reference, &interior(reference, mask, reach));
    Ok(Scores {
        mae,
        rmse: mean(&|d| d * d).sqrt(),
        p99: percentile(&sorted(errors.iter().map(|d| d.abs())), 0.99),
        ssim: ssim::ssim(produced, reference, mask),
        #[cfg(feature = "flip")]
        flip: flip::of_visibility(produced, reference, mask),
        correct_pct: correct_pct(&errors).unwrap_or(0.0),
        interior_pct: correct_pct(&inside),
        leak: mean(&|d| d.max(0.0)),
        false_shadow: mean(&|d| (-d).max(0.0)),
        vs_hard: (hard_mae > 0.0).then(|| mae / hard_mae),
        noise: grain::noise(produced, reference, mask),
        speckles: grain::speckles(produced, reference, mask),
        edge_offset: edge_offset(produced, reference, mask),
        contact_gap: contacts.and_then(|contacts| contact_gap(produced, reference, mask, contacts)),
        scored_pixels: errors.len(),
        not_finite: produced.data.iter().zip(&mask.data).filter(|(v, scored)| **scored && !v.is_finite()).count(),
    })
}

/// What the randomness of a reference of `samples` rays a pixel is about: the mean, over the scored
/// pixels, of the standard error of rays that are spread evenly over the light, one to each of as
/// many equal parts, where one edge cuts it. The edge cuts about 1.4 √n of n parts, and whether the
/// ray of a cut part is seen has a variance of about 1/8: in all 0.42 n^(−¾). Where that is more
/// than √(v (1 − v) / n) of independent rays, theirs counts. Many edges over one light make it
/// larger. 0 where nothing is scored.
///
/// A smaller difference between two errors says nothing.
pub fn standard_error(reference: &Image<f32>, mask: &Image<bool>, samples: u32) -> f64 {
    let samples = f64::from(samples.max(1));
    let spread = 0.42 * samples.powf(-0.75);
    let scored = reference.data.iter().zip(&mask.data).filter(|(_, scored)| **scored);
    let errors = scored.map(|(&v, _)| (f64::from(v * (1.0 - v)).max(0.0) / samples).sqrt().min(spread));
    let (sum, count) = errors.fold((0.0, 0_usize), |(sum, count), error| (sum + error, count + 1));
    sum / count.max(1) as f64
}

/// Produced − reference; 1 where the produced value is not finite.
pub(crate) fn difference(produced: f32, reference: f32) -> f64 {
    if produced.is_finite() { f64::from(produced) - f64::from(reference) } else { 1.0 }
}

fn differences(produced: &Image<f32>, reference: &Image<f32>, mask: &Image<bool>) -> Vec<f64> {
    let pairs = produced.data.iter().zip(&reference.data).zip(&mask.data);
    pairs.filter(|(_, scored)| **scored).map(|((&p, &r), _)| difference(p, r)).collect()
}

fn correct_pct(errors: &[f64]) -> Option<f64> {
    let correct = errors.iter().filter(|d| d.abs() <= TOLERANCE).count();
    (!errors.is_empty()).then(|| 100.0 * correct as f64 / errors.len() as f64)
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The value at `share` (0…1) of sorted values, interpolated linearly between its neighbours; 0 of
/// nothing.
pub(crate) fn percentile(values: &[f64], share: f64) -> f64 {
    let place = values.len().saturating_sub(1) as f64 * share;
    let at = |i: f64| values.get(i as usize).copied().unwrap_or(0.0);
    let (low, high, share) = (at(place.floor()), at(place.ceil()), place.fract());
    if share > 0.0 { low + (high - low) * share } else { low }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A penumbra from lit on the left to umbra on the right.
    fn ramp() -> Image<f32> {
        Image::from_fn(48, 32, |x, _| (1.5 - x as f32 / 24.0).clamp(0.0, 1.0))
    }

    fn all(produced: &Image<f32>) -> Scores {
        let mask = Image::filled(48, 32, true);
        let hard = ramp().map(|v| v.round());
        let reference = ramp();
        let comparison =
            Comparison { produced, reference: &reference, mask: &mask, hard: Some(&hard), reach: None, contacts: None };
        score(&comparison).expect("comparable pictures")
    }

    #[test]
    fn a_picture_equals_itself() {
        let same = all(&ramp());
        for error in [same.mae, same.rmse, same.p99, same.leak, same.false_shadow, same.flip] {
            assert_eq!(error, 0.0, "{same:?}");
        }
        assert_eq!((same.correct_pct, same.interior_pct, same.vs_hard), (100.0, Some(100.0), Some(0.0)));
        assert!((same.ssim - 1.0).abs() < 1e-12, "{same:?}");
        assert_eq!((same.scored_pixels, same.not_finite), (48 * 32, 0));
    }

    #[test]
    fn every_number_moves_the_right_way_with_light_that_leaks() {
        let worse = |amount: f32| all(&ramp().map(|v| (v + amount).min(1.0)));
        let (little, much) = (worse(0.05), worse(0.3));
        for (name, number) in [
            ("mae", (|s| s.mae) as fn(&Scores) -> f64),
            ("rmse", |s| s.rmse),
            ("p99", |s| s.p99),
            ("leak", |s| s.leak),
            ("flip", |s| s.flip),
            ("1 - ssim", |s| 1.0 - s.ssim),
            ("vs_hard", |s| s.vs_hard.unwrap_or(0.0)),
        ] {
            assert!(0.0 < number(&little) && number(&little) < number(&much), "{name}: {little:?} {much:?}");
        }
        assert!(much.correct_pct < 50.0 && much.false_shadow == 0.0, "{much:?}");
        // The lit third stays correct, the umbra does not.
        assert!(much.interior_pct.is_some_and(|p| p > 20.0 && p < 80.0), "{much:?}");
    }

    #[test]
    fn shadow_in_the_light_is_no_leak() {
        let dark = all(&ramp().map(|v| (v - 0.5).max(0.0)));
        assert!(dark.leak == 0.0 && (dark.false_shadow - dark.mae).abs() < 1e-15 && dark.mae > 0.1, "{dark:?}");
    }

    #[test]
    fn the_hard_shadow_is_as_good_as_itself() {
        assert_eq!(all(&ramp().map(|v| v.round())).vs_hard, Some(1.0));
    }

    #[test]
    fn acne_shows_in_the_interior() {
        let mut spotted = ramp();
        spotted[(3, 3)] = 0.9;
        let scores = all(&spotted);
        assert!(scores.interior_pct.is_some_and(|p| p < 100.0 && p > 99.0), "{scores:?}");
    }

    #[test]
    fn what_is_not_finite_is_an_error_of_one() {
        let mut broken = ramp();
        (broken[(40, 3)], broken[(1, 1)]) = (f32::NAN, f32::INFINITY);
        let scores = all(&broken);
        assert_eq!(scores.not_finite, 2);
        assert!((scores.mae - 2.0 / (48.0 * 32.0)).abs() < 1e-12, "{scores:?}");
        assert!(scores.ssim < 1.0 && scores.flip > 0.0 && scores.ssim.is_finite() && scores.flip.is_finite());
        assert!(scores.interior_pct.is_some_and(|p| p < 100.0), "{scores:?}");
    }

    #[test]
    fn what_is_not_scored_does_not_count() {
        let mut produced = ramp();
        let mask = Image::from_fn(48, 32, |x, _| x < 30);
        (30..48).for_each(|x| (0..32).for_each(|y| produced[(x, y)] = f32::NAN));
        let reference = ramp();
        let comparison = Comparison {
            produced: &produced,
            reference: &reference,
            mask: &mask,
            hard: None,
            reach: None,
            contacts: None,
        };
        let scores = score(&comparison).expect("comparable pictures");
        assert_eq!((scores.mae, scores.flip, scores.not_finite, scores.vs_hard), (0.0, 0.0, 0, None), "{scores:?}");
        assert!((scores.ssim - 1.0).abs() < 1e-12, "{scores:?}");
    }

    #[test]
    fn pictures_that_do_not_fit_are_errors() {
        let (a, small, mask) = (ramp(), Image::filled(4, 4, 1.0), Image::filled(48, 32, true));
        let with = Comparison { produced: &a, reference: &a, mask: &mask, hard: None, reach: None, contacts: None };
        let wrong = score(&Comparison { produced: &small, ..with });
        assert_eq!(wrong, Err(Error::Size { name: "produced", size: (4, 4), reference: (48, 32) }));
        let wrong = score(&Comparison { hard: Some(&small), ..with });
        assert!(matches!(wrong, Err(Error::Size { name: "hard shadow", .. })));
        let none = Image::filled(48, 32, false);
        assert_eq!(score(&Comparison { mask: &none, ..with }), Err(Error::NothingScored));
    }

    #[test]
    fn the_standard_error_is_that_of_rays_spread_over_a_light_that_an_edge_cuts() {
        let picture = Image { width: 4, height: 1, data: vec![0.0, 0.5, 0.999, 0.5] };
        let mask = Image { width: 4, height: 1, data: vec![true, true, true, false] };
        // 0.42 · 16^(−¾) = 0.0525; √(0.999 · 0.001 / 16) is less, and the umbra is certain.
        let found = standard_error(&picture, &mask, 16);
        assert!((found - (0.0525 + (0.999_f64 * 0.001 / 16.0).sqrt()) / 3.0).abs() < 1e-6, "{found}");
        assert_eq!(standard_error(&picture, &mask.map(|_| false), 16), 0.0);
        // Square lights in 16 × 16 parts, each with a ray at random, half hidden by a turned edge.
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from((state >> 40) as u32) / f64::from(1 << 24)
        };
        let mut seen = |turn: f64| {
            let (sin, cos) = turn.sin_cos();
            let cells = (0..16).flat_map(|j| (0..16).map(move |i| (f64::from(i), f64::from(j))));
            cells.filter(|(i, j)| cos * (i + random() - 8.0) + sin * (j + random() - 8.0) < 0.0).count() as f64 / 256.0
        };
        let turns = (0..2000).map(|turn| f64::from(turn) * 0.37);
        let square = turns.map(|turn| (seen(turn) - 0.5).powi(2)).sum::<f64>() / 2000.0;
        let found = standard_error(&Image::filled(1, 1, 0.5), &Image::filled(1, 1, true), 256);
        assert!((square.sqrt() / found - 1.0).abs() < 0.1, "{} and {found}", square.sqrt());
    }

    #[test]
    fn percentiles_are_interpolated() {
        assert_eq!(percentile(&sorted((0..=10).rev().map(f64::from)), 0.25), 2.5);
        assert_eq!(percentile(&[7.0], 0.99), 7.0);
        assert_eq!(percentile(&[1.0, f64::INFINITY], 0.0), 1.0);
    }
}

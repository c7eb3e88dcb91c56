//! Structural similarity over a mask.

use umbrage_core::Image;

/// Radius of the Gaussian window, pixels: 11 × 11 as in the paper.
const RADIUS: i64 = 5;
/// Standard deviation of the window, pixels.
const SIGMA: f64 = 1.5;
/// The paper's K₁² and K₂² for values in 0…1.
const STABILISERS: [f64; 2] = [0.01 * 0.01, 0.03 * 0.03];

/// Mean structural similarity over the scored pixels (Wang et al. 2004, section III B); 1 = the
/// same.
///
/// Pixels that are not scored have no weight in any window. A produced value that is not finite
/// counts as being off by
/// 1. The pictures are of one size; without any scored pixel the result is 1.
pub fn ssim(produced: &Image<f32>, reference: &Image<f32>, mask: &Image<bool>) -> f64 {
    let moments = Image {
        width: reference.width,
        height: reference.height,
        data: (produced.data.iter().zip(&reference.data).zip(&mask.data))
            .map(
                |((&p, &r), &scored)| {
                    if scored { moments(f64::from(r) + crate::score::difference(p, r), r) } else { [0.0; 6] }
                },
            )
            .collect(),
    };
    let blurred = blur(&blur(&moments, 1, 0), 0, 1);
    let (mut sum, mut count) = (0.0, 0_usize);
    for (m, _) in blurred.data.iter().zip(&mask.data).filter(|(_, scored)| **scored) {
        sum += similarity(m);
        count += 1;
    }
    if count == 0 { 1.0 } else { sum / count as f64 }
}

/// 1, a, b, a², b², ab: weighted means of them make means, variances and covariance.
fn moments(a: f64, b: f32) -> [f64; 6] {
    let b = f64::from(b);
    [1.0, a, b, a * a, b * b, a * b]
}

/// The paper's equation 13 from the sums of [`moments`] over a window.
fn similarity(&[weight, a, b, aa, bb, ab]: &[f64; 6]) -> f64 {
    let [c1, c2] = STABILISERS;
    let (a, b) = (a / weight, b / weight);
    let (variance_a, variance_b, covariance) = (aa / weight - a * a, bb / weight - b * b, ab / weight - a * b);
    (2.0 * a * b + c1) * (2.0 * covariance + c2) / ((a * a + b * b + c1) * (variance_a + variance_b + c2))
}

/// Sums weighted by the Gaussian along (dx, dy).
fn blur(image: &Image<[f64; 6]>, dx: i64, dy: i64) -> Image<[f64; 6]> {
    let kernel: Vec<f64> = (-RADIUS..=RADIUS).map(|k| (-0.5 * (k as f64 / SIGMA).powi(2)).exp()).collect();
    Image::from_fn(image.width, image.height, |x, y| {
        let mut sum = [0.0; 6];
        for (k, weight) in (-RADIUS..=RADIUS).zip(&kernel) {
            if let Some(m) = image.get(i64::from(x) + k * dx, i64::from(y) + k * dy) {
                sum.iter_mut().zip(m).for_each(|(s, m)| *s += weight * m);
            }
        }
        sum
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_differ_by_their_means_alone() {
        // Equation 13 with both variances zero is (2ab + c1) / (a² + b² + c1).
        let (a, b) = (Image::filled(20, 20, 0.25), Image::filled(20, 20, 0.75));
        let got = ssim(&a, &b, &Image::filled(20, 20, true));
        let want = (2.0 * 0.25 * 0.75 + 1e-4) / (0.0625 + 0.5625 + 1e-4);
        assert!((got - want).abs() < 1e-9, "{got} instead of {want}");
    }

    #[test]
    fn a_negative_is_unlike() {
        let stripes = Image::from_fn(32, 32, |x, _| (x / 2 % 2) as f32);
        let negative = stripes.map(|v| 1.0 - v);
        assert!(ssim(&negative, &stripes, &Image::filled(32, 32, true)) < -0.5);
    }
}

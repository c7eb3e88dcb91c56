//! The clamped cosine, whose coefficients have a closed form.

use super::basis::evaluate;
use super::order::{Order, index};
use glam::DVec3;
use std::f64::consts::PI;

/// A_l: a band of light times this is that band of irradiance, ∫ L(s) max(n·s, 0) ds as a function
/// of the normal n. π, 2π/3, π/4, 0, −π/24, …
///
/// Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001,
/// equation 8. The factor 1/π of a diffuse surface is not in it.
pub fn clamped_cosine(l: usize) -> f64 {
    match l {
        0 => PI,
        1 => 2.0 * PI / 3.0,
        _ if l % 2 == 1 => 0.0,
        _ => {
            // l! / (2^l ((l/2)!)²), as a product of factors below 1.
            let binomial: f64 = (1..=l / 2).map(|k| (2.0 * k as f64 - 1.0) / (2.0 * k as f64)).product();
            let sign = if l.is_multiple_of(4) { -1.0 } else { 1.0 };
            sign * 2.0 * PI * binomial / ((l + 2) * (l - 1)) as f64
        }
    }
}

/// The transfer of a white diffuse point with unit normal `normal` that nothing shadows: (A_l / π)
/// y_lm(n), into the first n² places of `into`.
pub fn unshadowed(order: Order, normal: DVec3, into: &mut [f64]) {
    evaluate(order, normal, into);
    for l in 0..order.bands() {
        let factor = clamped_cosine(l) / PI;
        let (from, to) = (index(l, -(l as isize)), index(l, l as isize));
        into.iter_mut().take(to + 1).skip(from).for_each(|value| *value *= factor);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::harmonics::quadrature;

    #[test]
    fn the_bands_of_the_cosine_are_its_integrals() {
        // The cosine is no polynomial: the sum converges with 1 / degree².
        let points = quadrature(600);
        for l in 0..10 {
            let mut values = [0.0; 100];
            let along_z: f64 = points
                .iter()
                .map(|(s, weight)| {
                    evaluate(Order::MAX, *s, &mut values);
                    weight * s.z.max(0.0) * values[index(l, 0)]
                })
                .sum();
            evaluate(Order::MAX, DVec3::Z, &mut values);
            let found = along_z / values[index(l, 0)];
            assert!((found - clamped_cosine(l)).abs() < 1e-4, "band {l}: {found}, not {}", clamped_cosine(l));
        }
        assert!((clamped_cosine(2) - PI / 4.0).abs() < 1e-15 && (clamped_cosine(4) + PI / 24.0).abs() < 1e-15);
    }

    #[test]
    fn under_a_constant_sky_of_1_a_white_point_sends_out_1() {
        // Without 1/π it would be π.
        let mut transfer = [0.0; 25];
        unshadowed(Order::default(), DVec3::new(0.6, 0.0, 0.8), &mut transfer);
        let constant = (4.0 * PI).sqrt();
        assert!((transfer[0] * constant - 1.0).abs() < 1e-14);
    }

    #[test]
    fn three_bands_of_light_give_irradiance_within_one_percent() {
        // Their paper's claim: of a point light's irradiance, any band of which is as strong as
        // possible, three bands keep all but 1 % of the mean square.
        let points = quadrature(200);
        let order = Order::new(3).unwrap();
        let (mut light, mut transfer) = ([0.0; 9], [0.0; 9]);
        evaluate(order, DVec3::Y, &mut light);
        let (mut off, mut all) = (0.0, 0.0);
        for (normal, weight) in points {
            unshadowed(order, normal, &mut transfer);
            let radiance: f64 = light.iter().zip(transfer).map(|(l, t)| l * t).sum();
            let truth = normal.y.max(0.0) / PI;
            off += weight * (radiance - truth) * (radiance - truth);
            all += weight * truth * truth;
        }
        assert!(off / all < 0.01, "{}", off / all);
    }
}

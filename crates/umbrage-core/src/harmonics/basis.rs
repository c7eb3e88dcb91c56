//! The functions themselves.

use super::order::{Order, index};
use glam::DVec3;
use std::f64::consts::{PI, SQRT_2};
use std::sync::OnceLock;

const MOST: usize = 10;

/// What the recurrence over degrees needs, by l and m: q(l, m) = a · (z q(l−1, m) − b q(l−2, m)).
struct Factors {
    a: [[f64; MOST]; MOST],
    b: [[f64; MOST]; MOST],
    /// q(m, m).
    first: [f64; MOST],
}

fn factors() -> &'static Factors {
    static FACTORS: OnceLock<Factors> = OnceLock::new();
    FACTORS.get_or_init(|| {
        let mut factors = Factors { a: [[0.0; MOST]; MOST], b: [[0.0; MOST]; MOST], first: [0.0; MOST] };
        factors.first[0] = (1.0 / (4.0 * PI)).sqrt();
        for m in 1..MOST {
            let doubled = 2.0 * m as f64;
            factors.first[m] = factors.first[m - 1] * ((doubled + 1.0) / doubled).sqrt();
        }
        for l in 1..MOST {
            for m in 0..l {
                let (l2, m2, before) = ((l * l) as f64, (m * m) as f64, ((l - 1) * (l - 1)) as f64);
                factors.a[l][m] = ((4.0 * l2 - 1.0) / (l2 - m2)).sqrt();
                factors.b[l][m] = ((before - m2) / (4.0 * before - 1.0)).max(0.0).sqrt();
            }
        }
        factors
    })
}

/// All functions of an order in a unit `direction`, in the order of their numbers, into the first
/// n² places of `into`; a shorter slice gets those that fit.
///
/// Orthonormal over the sphere: the associated Legendre functions without the Condon–Shortley
/// phase, times √2 cos mφ for m > 0 and √2 sin |m|φ for m < 0. Powers of x + iy take the place of
/// angles, so that there is nothing special about the poles (Sloan, "Efficient Spherical Harmonic
/// Evaluation", 2013).
pub fn evaluate(order: Order, direction: DVec3, into: &mut [f64]) {
    let DVec3 { x, y, z } = direction;
    let (mut cos, mut sin) = (1.0, 0.0);
    for m in 0..order.bands() {
        legendre(order, m, z, |l, q| {
            if m == 0 {
                set(into, index(l, 0), q);
            } else {
                set(into, index(l, m as isize), SQRT_2 * q * cos);
                set(into, index(l, -(m as isize)), SQRT_2 * q * sin);
            }
        });
        (cos, sin) = (x * cos - y * sin, x * sin + y * cos);
    }
}

/// Gives q(l, m) for all l from m: the normalised associated Legendre function at z, divided by
/// (1 − z²)^(m/2).
pub(super) fn legendre(order: Order, m: usize, z: f64, mut give: impl FnMut(usize, f64)) {
    let factors = factors();
    let (mut before, mut q) = (0.0, factors.first[m]);
    give(m, q);
    for l in m + 1..order.bands() {
        (before, q) = (q, factors.a[l][m] * (z * q - factors.b[l][m] * before));
        give(l, q);
    }
}

fn set(into: &mut [f64], at: usize, value: f64) {
    if let Some(place) = into.get_mut(at) {
        *place = value;
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature;
    use super::*;

    fn at(direction: DVec3) -> [f64; 100] {
        let mut values = [0.0; 100];
        evaluate(Order::MAX, direction, &mut values);
        values
    }

    #[test]
    fn the_functions_are_orthonormal() {
        let mut products = vec![0.0; 100 * 100];
        for (direction, weight) in quadrature(18) {
            let values = at(direction);
            for (i, row) in products.chunks_mut(100).enumerate() {
                row.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * values[i] * value);
            }
        }
        for (i, product) in products.iter().enumerate() {
            let want = f64::from(u8::from(i / 100 == i % 100));
            assert!((product - want).abs() < 1e-12, "functions {} and {}: {product}", i / 100, i % 100);
        }
    }

    #[test]
    fn the_first_nine_are_the_published_polynomials() {
        // Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
        // 2001, equation 3. With the Condon–Shortley phase those of odd m would be negative; with
        // another pole, or another order of numbers, they would be exchanged.
        let DVec3 { x, y, z } = DVec3::new(0.36, 0.48, -0.8);
        let want = [
            0.282095,
            0.488603 * y,
            0.488603 * z,
            0.488603 * x,
            1.092548 * x * y,
            1.092548 * y * z,
            0.315392 * (3.0 * z * z - 1.0),
            1.092548 * x * z,
            0.546274 * (x * x - y * y),
        ];
        let found = at(DVec3::new(x, y, z));
        assert!(want.iter().zip(found).all(|(want, found)| (want - found).abs() < 1e-6), "{found:?}");
    }

    #[test]
    fn the_sum_of_squares_of_a_band_is_the_same_everywhere() {
        // Unsöld's theorem: (2l + 1) / 4π; at the poles, too.
        for direction in [DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::new(0.6, -0.64, 0.48)] {
            let values = at(direction);
            for l in 0..10_usize {
                let sum: f64 = values[l * l..(l + 1) * (l + 1)].iter().map(|v| v * v).sum();
                assert!((sum - (2 * l + 1) as f64 / (4.0 * PI)).abs() < 1e-12, "band {l} at {direction}: {sum}");
            }
        }
    }

    #[test]
    fn a_short_slice_gets_what_fits() {
        let mut few = [0.0; 4];
        evaluate(Order::MAX, DVec3::Y, &mut few);
        assert_eq!(few[..], at(DVec3::Y)[..4]);
    }
}

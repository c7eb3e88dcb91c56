//! Directions and weights that integrate polynomials exactly.

use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Directions with weights: the weighted sum over a polynomial in x, y, z of at most `degree` is
/// its integral over the sphere, to rounding. Gauss–Legendre nodes along z, times evenly spaced
/// angles around it. Products of two functions of order n have degree 2 (n − 1).
pub fn quadrature(degree: u32) -> Vec<(DVec3, f64)> {
    let (rings, around) = (degree / 2 + 1, degree + 1);
    let mut points = Vec::with_capacity((rings * around) as usize);
    for ring in 0..rings {
        let (z, weight) = gauss_legendre(rings, ring);
        let radius = (1.0 - z * z).sqrt();
        for step in 0..around {
            let (sin, cos) = (TAU * (f64::from(step) + 0.5) / f64::from(around)).sin_cos();
            points.push((DVec3::new(radius * cos, radius * sin, z), weight * TAU / f64::from(around)));
        }
    }
    points
}

/// Node number `i` of `n` on [−1, 1] and its weight: Newton's iteration from the usual estimate.
fn gauss_legendre(n: u32, i: u32) -> (f64, f64) {
    let n = f64::from(n);
    let mut z = (PI * (f64::from(i) + 0.75) / (n + 0.5)).cos();
    let mut slope = 1.0;
    for _ in 0..8 {
        let (mut before, mut value, mut k) = (0.0, 1.0, 0.0);
        while k < n {
            (before, value) = (value, ((2.0 * k + 1.0) * z * value - k * before) / (k + 1.0));
            k += 1.0;
        }
        slope = n * (z * value - before) / (z * z - 1.0);
        z -= value / slope;
    }
    (z, 2.0 / ((1.0 - z * z) * slope * slope))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_exactly() {
        for degree in 0..=20 {
            let points = quadrature(degree);
            let mean = |f: &dyn Fn(DVec3) -> f64| points.iter().map(|(p, w)| w * f(*p)).sum::<f64>() / (4.0 * PI);
            assert!((mean(&|_| 1.0) - 1.0).abs() < 1e-13, "{degree}");
            for power in 1..=degree as i32 {
                let want = if power % 2 == 0 { 1.0 / f64::from(power + 1) } else { 0.0 };
                for axis in 0..3 {
                    let found = mean(&|p| p[axis].powi(power));
                    assert!((found - want).abs() < 1e-13, "degree {degree}, power {power}, axis {axis}: {found}");
                }
            }
        }
    }
}

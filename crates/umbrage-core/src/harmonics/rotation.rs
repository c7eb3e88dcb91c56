//! Exact rotation.

use super::basis::evaluate;
use super::order::{Order, index};
use super::quadrature::quadrature;
use glam::{DQuat, DVec3};
use std::ops::{Add, Mul};
use std::sync::OnceLock;

const MOST: usize = 10;

/// Turns functions on the sphere: the coefficients of f become those of s ↦ f(R⁻¹ s).
///
/// Band by band, as a turn around z, one around y and one around z. Those around z are sums of two
/// terms; the one around y is a turn around z between two exchanges of the axes, whose matrices do
/// not depend on the angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    order: Order,
    /// Cosine and sine of m times the angles around z, y and z, the first first.
    turns: [[(f64, f64); MOST]; 3],
}

impl Rotation {
    /// By `rotation`, which is a unit quaternion, for coefficients of this order.
    pub fn new(order: Order, rotation: DQuat) -> Self {
        let DQuat { x, y, z, w } = rotation;
        // Of q = turn z by `last` · turn y by `middle` · turn z by `first`; each stays exact where
        // others have no meaning.
        let middle = 2.0 * x.hypot(y).atan2(z.hypot(w));
        let (sum, difference) = (2.0 * z.atan2(w), 2.0 * (-x).atan2(y));
        let turns = [0.5 * (sum - difference), middle, 0.5 * (sum + difference)];
        Self { order, turns: turns.map(|angle| std::array::from_fn(|m| (m as f64 * angle).sin_cos()).map(swapped)) }
    }

    /// Turns coefficients in the order of their numbers. A slice that is shorter than n² keeps what
    /// it has of a band that is not whole; what is beyond n² stays.
    pub fn apply<T: Copy + Default + Add<Output = T> + Mul<f64, Output = T>>(&self, coefficients: &mut [T]) {
        let [first, middle, last] = &self.turns;
        let mut held = [T::default(); 2 * MOST];
        for l in 1..self.order.bands() {
            let Some(band) = coefficients.get_mut(l * l..(l + 1) * (l + 1)) else { return };
            let held = &mut held[..2 * l + 1];
            let exchange = &exchanges()[l];
            turn_around_z(band, first);
            transform(exchange, false, band, held);
            turn_around_z(held, middle);
            transform(exchange, true, held, band);
            turn_around_z(band, last);
        }
    }
}

fn swapped((sin, cos): (f64, f64)) -> (f64, f64) {
    (cos, sin)
}

fn turn_around_z<T: Copy + Add<Output = T> + Mul<f64, Output = T>>(band: &mut [T], turn: &[(f64, f64); MOST]) {
    let l = band.len() / 2;
    for (m, (cos, sin)) in turn.iter().enumerate().take(l + 1).skip(1) {
        let (c, s) = (band[l + m], band[l - m]);
        band[l + m] = c * *cos + s * -*sin;
        band[l - m] = c * *sin + s * *cos;
    }
}

/// Multiplies by a band's matrix, or by its transpose.
fn transform<T: Copy + Default + Add<Output = T> + Mul<f64, Output = T>>(
    matrix: &[f64],
    transposed: bool,
    from: &[T],
    into: &mut [T],
) {
    let n = from.len();
    into.fill(T::default());
    for (i, value) in into.iter_mut().enumerate() {
        for (j, from) in from.iter().enumerate() {
            let factor = if transposed { matrix[j * n + i] } else { matrix[i * n + j] };
            if factor != 0.0 {
                *value = *value + *from * factor;
            }
        }
    }
}

/// The matrices of the exchange that takes y to z, row by row, for each band: integrals of one
/// function times the other one turned, which the quadrature finds to rounding.
fn exchanges() -> &'static [Vec<f64>; MOST] {
    static MATRICES: OnceLock<[Vec<f64>; MOST]> = OnceLock::new();
    MATRICES.get_or_init(|| {
        let mut matrices: [Vec<f64>; MOST] = std::array::from_fn(|l| vec![0.0; (2 * l + 1) * (2 * l + 1)]);
        let (mut here, mut turned) = ([0.0; MOST * MOST], [0.0; MOST * MOST]);
        for (s, weight) in quadrature(2 * (MOST as u32 - 1)) {
            evaluate(Order::MAX, s, &mut here);
            evaluate(Order::MAX, DVec3::new(s.x, s.z, -s.y), &mut turned);
            for (l, matrix) in matrices.iter_mut().enumerate() {
                let band = index(l, -(l as isize))..=index(l, l as isize);
                for (row, to) in matrix.chunks_mut(2 * l + 1).zip(&here[band.clone()]) {
                    row.iter_mut().zip(&turned[band.clone()]).for_each(|(sum, from)| *sum += weight * to * from);
                }
            }
        }
        // Half of them are zero but for rounding.
        matrices.iter_mut().flatten().for_each(|value| *value = if value.abs() < 1e-13 { 0.0 } else { *value });
        matrices
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unit quaternions without a pattern, and those where angles lose their meaning.
    fn rotations(count: u32) -> impl Iterator<Item = DQuat> {
        let special = [DQuat::IDENTITY, DQuat::from_rotation_x(std::f64::consts::PI), DQuat::from_rotation_y(1e-9)];
        let any = (0..count).map(|i| {
            let (a, b) = (crate::sampling::shift(2 * i), crate::sampling::shift(2 * i + 1));
            DQuat::from_xyzw(a.x - 0.5, a.y - 0.5, b.x - 0.5, b.y - 0.5).normalize()
        });
        special.into_iter().chain([-special[1], DQuat::from_rotation_z(3.0)]).chain(any)
    }

    #[test]
    fn a_turned_function_is_the_function_of_the_direction_turned_back() {
        for order in (1..=10).filter_map(|n| Order::new(n).ok()) {
            let count = order.functions();
            let pattern = crate::sampling::lattice(count);
            let coefficients: Vec<f64> = pattern.iter().map(|p| 2.0 * p.y - 1.0).collect();
            let mut basis = [0.0; 100];
            let mut value = |coefficients: &[f64], s: DVec3| {
                evaluate(order, s, &mut basis);
                coefficients.iter().zip(&basis).map(|(c, y)| c * y).sum::<f64>()
            };
            let mut worst: f64 = 0.0;
            for (i, rotation) in (0..).zip(rotations(1000)) {
                let mut turned = coefficients.clone();
                Rotation::new(order, rotation).apply(&mut turned);
                let at = crate::sampling::shift(i + 5000) - 0.5;
                let s = at.extend(0.25).normalize();
                worst = worst.max((value(&turned, s) - value(&coefficients, rotation.inverse() * s)).abs());
            }
            assert!(worst < 1e-12, "order {order}: {worst}");
        }
    }

    #[test]
    fn a_quarter_turn_around_y_takes_x_to_minus_z() {
        // The flip side, a direction turned the other way round, would give +z.
        let mut x = [0.0, 0.0, 0.0, 1.0];
        let order = Order::default();
        Rotation::new(order, DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2)).apply(&mut x);
        let want = [0.0, 0.0, -1.0, 0.0];
        assert!(x.iter().zip(want).all(|(found, want)| (found - want).abs() < 1e-15), "{x:?}");
    }

    #[test]
    fn colours_turn_as_numbers_do_and_what_is_too_short_or_long_stays() {
        let rotation = Rotation::new(Order::default(), DQuat::from_rotation_x(0.7));
        let mut colours: Vec<DVec3> = (0..30).map(|i| DVec3::new(f64::from(i), 1.0, -f64::from(i))).collect();
        let mut red: Vec<f64> = colours.iter().map(|c| c.x).collect();
        let mut short = red[..7].to_vec();
        rotation.apply(&mut red);
        rotation.apply(&mut short);
        rotation.apply(&mut colours);
        assert!(colours.iter().zip(&red).all(|(c, r)| c.x == *r && c.z == -*r));
        assert_eq!(
            (&red[25..], &short[..4], &short[4..]),
            (&[25., 26., 27., 28., 29.][..], &red[..4], &[4., 5., 6.][..])
        );
    }
}

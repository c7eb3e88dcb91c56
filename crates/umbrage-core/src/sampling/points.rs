//! Points of the unit square that fill it evenly, and the way from the square to the disc.

use glam::{DVec2, UVec2};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// 1/φ, φ the golden ratio: the multiple of it that comes closest to a whole number is as far off
/// as can be.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// `n` points of the square [0, 1)²: (i/n, frac(i/φ)). The golden-ratio rank-1 lattice; where `n`
/// is a Fibonacci number it is, up to rounding to multiples of 1/n, the Fibonacci lattice, the best
/// one there is (Niederreiter, Sloan 1994).
pub fn lattice(n: usize) -> Vec<DVec2> {
    (0..n).map(|i| DVec2::new(i as f64 / n as f64, (i as f64 * GOLDEN).fract())).collect()
}

/// The points of [`lattice`], rotated such that the set is its own mirror image through the middle
/// of the square: its mean is the middle, and a single point is there.
pub(super) fn symmetric_lattice(n: usize) -> impl Iterator<Item = DVec2> {
    let last = n.saturating_sub(1) as f64;
    let to_middle = DVec2::splat(0.5) - DVec2::new(0.5 * last / n as f64, 0.5 * last * GOLDEN);
    lattice(n).into_iter().map(move |u| rotated(u, to_middle))
}

/// A pseudo-random point of [0, 1)² that belongs to `seed`, such as a pixel's index: what
/// [`rotated`] moves that pixel's points by. Neighbouring seeds give unrelated points.
pub fn shift(seed: u32) -> DVec2 {
    let x = hash(seed ^ 0x9e37_79b9);
    let y = hash(x.wrapping_add(seed).wrapping_mul(0x85eb_ca6b) ^ 0x68bc_21eb);
    UVec2::new(x, y).as_dvec2() / 4_294_967_296.0
}

/// `point` moved by `shift` on the torus [0, 1)²: a Cranley–Patterson rotation, which keeps a
/// lattice a lattice.
pub fn rotated(point: DVec2, shift: DVec2) -> DVec2 {
    let moved = point + shift;
    // A tiny negative number would be rounded up to 1.
    (moved - moved.floor()).min(DVec2::splat(1.0 - f64::EPSILON / 2.0))
}

/// Takes the square [0, 1]² to the unit disc so that equal areas stay equal: Shirley and Chiu, "A
/// Low Distortion Map Between Disk and Square", 1997. The middle of the square goes to the centre.
pub fn square_to_disc(square: DVec2) -> DVec2 {
    let p = square * 2.0 - 1.0;
    let (radius, angle) = if p.x.abs() > p.y.abs() {
        (p.x, FRAC_PI_4 * p.y / p.x)
    } else if p.y != 0.0 {
        (p.y, FRAC_PI_2 - FRAC_PI_4 * p.x / p.y)
    } else {
        return DVec2::ZERO;
    };
    DVec2::from_angle(angle) * radius
}

/// A hash of 32 bits with little bias: `lowbias32` of Wellons, "Prospecting for Hash
/// Functions", 2018.
fn hash(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ x >> 16
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Largest difference between the share of points in a box at the origin and the box's area.
    fn star_discrepancy(points: &[DVec2]) -> f64 {
        let mut worst: f64 = 0.0;
        for i in 1..=64 {
            for j in 1..=64 {
                let corner = DVec2::new(f64::from(i), f64::from(j)) / 64.0;
                let inside = points.iter().filter(|p| p.cmplt(corner).all()).count();
                worst = worst.max((inside as f64 / points.len() as f64 - corner.x * corner.y).abs());
            }
        }
        worst
    }

    #[test]
    fn the_lattice_fills_the_square_evenly_however_it_is_rotated() {
        for n in [64, 100, 256, 1024, 2584] {
            for seed in 0..4 {
                let points: Vec<_> = lattice(n).into_iter().map(|p| rotated(p, shift(seed))).collect();
                let (d, limit) = (star_discrepancy(&points), 1.2 * (n as f64).ln() / n as f64);
                assert!(d < limit, "{n} points, shift {seed}: discrepancy {d}, not under {limit}");
            }
        }
    }

    #[test]
    fn the_symmetric_lattice_is_its_own_mirror_image() {
        for n in [1, 2, 7, 256] {
            let points: Vec<_> = symmetric_lattice(n).collect();
            for (p, q) in points.iter().zip(points.iter().rev()) {
                assert!((*p + *q - 1.0).length() < 1e-9, "{n} points: {p} and {q}");
            }
        }
        assert!(star_discrepancy(&symmetric_lattice(256).collect::<Vec<_>>()) < 0.02);
    }

    #[test]
    fn few_points_are_none_and_the_corner() {
        assert_eq!(lattice(0), vec![]);
        assert_eq!(lattice(1), vec![DVec2::ZERO]);
    }

    #[test]
    fn shifts_of_neighbouring_seeds_are_spread_and_unrelated() {
        let n = 20_000;
        let shifts: Vec<_> = (0..n).map(shift).collect();
        assert!(star_discrepancy(&shifts) < 0.015);
        let centred = |s: &DVec2| *s - 0.5;
        let covariance = |f: &dyn Fn(usize) -> f64| (0..n as usize - 1).map(f).sum::<f64>() / f64::from(n);
        let within = covariance(&|i| centred(&shifts[i]).x * centred(&shifts[i]).y);
        let next = covariance(&|i| centred(&shifts[i]).dot(centred(&shifts[i + 1])));
        assert!(within.abs() < 3e-3 && next.abs() < 3e-3, "covariances {within} and {next}");
    }

    #[test]
    fn a_rotation_never_rounds_up_to_one() {
        assert!(rotated(DVec2::ZERO, DVec2::splat(-1e-20)).cmplt(DVec2::ONE).all());
    }

    #[test]
    fn the_map_to_the_disc_keeps_areas() {
        // Cells of a grid, taken to the disc as polygons with many corners, have the area of the
        // cell times π.
        let (cells, steps) = (4, 64);
        for i in 0..cells {
            for j in 0..cells {
                let cell = DVec2::new(f64::from(i), f64::from(j));
                let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
                let outline: Vec<DVec2> = (0..4 * steps)
                    .map(|k| {
                        let (side, t) = (k / steps, f64::from(k as u32 % steps as u32) / steps as f64);
                        let on_cell = cell + corners[side].lerp(corners[(side + 1) % 4], t);
                        square_to_disc(on_cell / f64::from(cells))
                    })
                    .collect();
                let area: f64 =
                    (0..outline.len()).map(|k| outline[k].perp_dot(outline[(k + 1) % outline.len()])).sum::<f64>()
                        / 2.0;
                let want = std::f64::consts::PI / f64::from(cells * cells);
                assert!((area / want - 1.0).abs() < 1e-3, "cell {cell}: {area} instead of {want}");
            }
        }
    }

    proptest! {
        #[test]
        fn rotated_points_stay_in_the_square(x in 0.0..1.0f64, y in 0.0..1.0f64, seed: u32) {
            for s in [shift(seed), DVec2::new(-1e-20, 1.0 - f64::EPSILON), -shift(seed)] {
                let r = rotated(DVec2::new(x, y), s);
                prop_assert!(r.cmpge(DVec2::ZERO).all() && r.cmplt(DVec2::ONE).all(), "{r}");
            }
        }

        #[test]
        fn points_of_the_disc_are_in_it(x in 0.0..=1.0f64, y in 0.0..=1.0f64) {
            prop_assert!(square_to_disc(DVec2::new(x, y)).length() <= 1.0 + 1e-12);
        }
    }

    #[test]
    fn the_middle_and_the_border_of_the_square() {
        assert_eq!(square_to_disc(DVec2::splat(0.5)), DVec2::ZERO);
        for i in 0..=8 {
            let t = f64::from(i) / 8.0;
            for p in [DVec2::new(t, 0.0), DVec2::new(t, 1.0), DVec2::new(0.0, t), DVec2::new(1.0, t)] {
                assert!((square_to_disc(p).length() - 1.0).abs() < 1e-12);
            }
        }
    }
}

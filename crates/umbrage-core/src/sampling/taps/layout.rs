//! One set of taps: strata of equal area, and in which order.

use super::super::points::{rotated, shift, symmetric_lattice};
use super::Domain;
use glam::DVec2;
use std::f64::consts::{PI, TAU};

/// One jittered tap in each of `taps` strata of equal area; `seed` gives each set its own jitter.
/// `tests` ≤ `taps`.
pub fn jittered(domain: Domain, taps: u32, tests: u32, seed: u32) -> Vec<[f64; 2]> {
    let first = seed.wrapping_mul(taps);
    match domain {
        Domain::Segment => {
            let stratum = |i| (f64::from(i) + shift(first.wrapping_add(i)).x) / f64::from(taps);
            ends_first((0..taps).map(|i| [stratum(i) * 2.0 - 1.0, 0.0]).collect(), tests)
        }
        _ => {
            let mut done = 0;
            let mut set = Vec::with_capacity(taps as usize);
            for sectors in rings(domain, taps, tests) {
                let outside = f64::from(taps - done) / f64::from(taps);
                let share = f64::from(sectors) / f64::from(taps);
                for sector in 0..sectors {
                    let jitter = shift(first.wrapping_add(done + sector));
                    let around = (f64::from(sector) + jitter.x) / f64::from(sectors);
                    set.push(from_polar(domain, around, outside - share * jitter.y));
                }
                done += sectors;
            }
            set
        }
    }
}

/// Number of sectors in each ring of a disc or a square, from the border inwards: the `tests` of
/// the outermost, then rings of the same width, whose sectors are about as long as they are wide.
/// All sectors have the same area.
pub fn rings(domain: Domain, taps: u32, tests: u32) -> Vec<u32> {
    let inner = taps - tests;
    // The area of a disc or a square whose inscribed circle has radius 1.
    let area = if domain == Domain::Disc { PI } else { 4.0 };
    let count = (f64::from(inner) / area).sqrt().round().max(1.0) as u32;
    let within = |ring: u32| (f64::from(inner) * (f64::from(ring) / f64::from(count)).powi(2)).round() as u32;
    let inner = (1..=count).rev().map(|ring| within(ring) - within(ring - 1));
    std::iter::once(tests).chain(inner).filter(|&sectors| sectors > 0).collect()
}

/// An evenly spread set without chance, the next one for every `turn` in [0, 1). `tests` ≤ `taps`.
///
/// The disc gets a Vogel spiral, turned; the square a lattice, shifted along its diagonal; the
/// segment the middles of equal pieces, shifted within them. Small turns move taps a little, so
/// that where errors depend on `turn`, they do smoothly.
pub fn evenly_spread(domain: Domain, taps: u32, tests: u32, turn: f64) -> Vec<[f64; 2]> {
    let lattice = symmetric_lattice(taps as usize);
    let to_square = |u: DVec2| (u * 2.0 - 1.0).to_array();
    match domain {
        Domain::Disc => {
            rim_first(domain, lattice.map(|u| from_polar(domain, (u.y + turn).fract(), u.x)).collect(), tests)
        }
        Domain::Square => {
            rim_first(domain, lattice.map(|u| to_square(rotated(u, DVec2::splat(turn)))).collect(), tests)
        }
        Domain::Segment => {
            let by = DVec2::new(turn / f64::from(taps), 0.0);
            ends_first(lattice.map(|u| [to_square(rotated(u, by))[0], 0.0]).collect(), tests)
        }
    }
}

/// The point of the disc or the square that is `around` ∈ [0, 1) of the way around the middle and
/// on the border of the part that has the share `within` ∈ [0, 1] of the area. Equal areas of the
/// two go to equal areas of the domain.
fn from_polar(domain: Domain, around: f64, within: f64) -> [f64; 2] {
    let radius = within.sqrt();
    if domain == Domain::Disc {
        let (sin, cos) = (TAU * around).sin_cos();
        return [radius * cos, radius * sin];
    }
    let along = radius * ((around * 4.0).fract() * 2.0 - 1.0);
    match (around * 4.0) as u32 {
        0 => [radius, along],
        1 => [-along, radius],
        2 => [-radius, -along],
        _ => [along, -radius],
    }
}

/// The inverse of [`from_polar`]: how far around and how far out.
pub fn to_polar(domain: Domain, [x, y]: [f64; 2]) -> (f64, f64) {
    if domain == Domain::Disc {
        return ((y.atan2(x) / TAU).rem_euclid(1.0), x * x + y * y);
    }
    let radius = x.abs().max(y.abs());
    let (side, along) = match (x.abs() >= y.abs(), x > 0.0, y > 0.0) {
        (true, true, _) => (0.0, y),
        (false, _, true) => (1.0, -x),
        (true, false, _) => (2.0, -y),
        (false, _, false) => (3.0, x),
    };
    let on_side = if radius > 0.0 { 0.5 + 0.5 * along / radius } else { 0.5 };
    (((side + on_side) * 0.25).rem_euclid(1.0), radius * radius)
}

/// From the border inwards, but first the outermost tap of each of `tests` equal sectors, as far as
/// a sector has one.
fn rim_first(domain: Domain, mut set: Vec<[f64; 2]>, tests: u32) -> Vec<[f64; 2]> {
    set.sort_by(|a, b| to_polar(domain, *b).1.total_cmp(&to_polar(domain, *a).1));
    let mut taken = vec![false; tests as usize];
    let (mut first, rest): (Vec<_>, Vec<_>) = set.into_iter().partition(|tap| {
        let sector = (to_polar(domain, *tap).0 * f64::from(tests)) as usize;
        taken.get_mut(sector).is_some_and(|taken| !std::mem::replace(taken, true))
    });
    first.extend(rest);
    first
}

/// From one end of the segment to the other, but first `tests` that are spread over all of it, ends
/// included.
fn ends_first(mut set: Vec<[f64; 2]>, tests: u32) -> Vec<[f64; 2]> {
    set.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (last, tests) = (set.len() - 1, tests as usize);
    let place = |test: usize| if tests == 1 { last / 2 } else { test * last / (tests - 1) };
    let mut is_test = vec![false; set.len()];
    (0..tests).for_each(|test| is_test[place(test)] = true);
    let of_kind = |kind| set.iter().zip(&is_test).filter(move |(_, is_test)| **is_test == kind).map(|(tap, _)| *tap);
    of_kind(true).chain(of_kind(false)).collect()
}

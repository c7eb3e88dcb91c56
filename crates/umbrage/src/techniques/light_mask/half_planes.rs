//! The samples of a light in every half plane of its face (Schwarz and Stamminger 2007; Sintorn et
//! al. 2008): what a triangle hides is that of its three edges, each looked up.

use umbrage_core::glam::DVec2;

/// Steps of a half plane's normal over half a turn, and of its distance from the middle. An edge is
/// off by half a step: less than samples are apart.
pub(super) const TURNS: u32 = 128;
pub(super) const DISTANCES: u32 = 256;

/// Samples in four words.
const FOUR: usize = 128;

/// For each turn and distance a bit for every sample that is inside, in groups of four words.
/// `reach`: how far from the middle there are samples.
pub(super) fn half_planes(samples: &[DVec2], reach: f64) -> Vec<[u32; 4]> {
    let fours = samples.len().div_ceil(FOUR);
    let mut table = vec![[0; 4]; (TURNS * DISTANCES) as usize * fours];
    for turn in 0..TURNS {
        // The normal's way around a square on its corner, from straight down to straight up.
        let at = (f64::from(turn) + 0.5) / f64::from(TURNS) * 2.0 - 1.0;
        let normal = DVec2::new(1.0 - at.abs(), at).normalize();
        for (i, sample) in samples.iter().enumerate() {
            let height = normal.dot(*sample);
            for step in first_step(height, reach)..DISTANCES {
                let of = (turn * DISTANCES + step) as usize * fours + i / FOUR;
                table[of][i % FOUR / 32] |= 1 << (i % 32);
            }
        }
    }
    table
}

/// The first distance at which a sample at this height is inside; that of a step is in its middle.
/// None is in the first and all are in the last one.
fn first_step(height: f64, reach: f64) -> u32 {
    let steps = f64::from(DISTANCES - 2);
    let step = (0.5 - 0.5 * height / reach) * steps + 0.5;
    (step.ceil().max(1.0) as u32).min(DISTANCES - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::sampling::{lattice, square_to_disc};

    #[test]
    fn a_half_plane_holds_what_its_line_says_but_for_half_a_step() {
        let samples: Vec<DVec2> = lattice(160).into_iter().map(square_to_disc).collect();
        let table = half_planes(&samples, 1.0);
        let (mut inside, mut outside) = (0, 0);
        for turn in 0..TURNS {
            let at = (f64::from(turn) + 0.5) / 64.0 - 1.0;
            let normal = DVec2::new(1.0 - at.abs(), at).normalize();
            for step in 0..DISTANCES {
                let distance = (f64::from(step) - 0.5) / f64::from(DISTANCES / 2 - 1) - 1.0;
                for (i, sample) in samples.iter().enumerate() {
                    let word = table[(turn * DISTANCES + step) as usize * 2 + i / 128][i % 128 / 32];
                    let is_in = word >> (i % 32) & 1 == 1;
                    let height = normal.dot(*sample) + distance;
                    let is_sure = height.abs() > 1e-9 && step > 0 && step < DISTANCES - 1;
                    assert!(!is_sure || is_in == (height > 0.0), "turn {turn}, step {step}, {sample}");
                    inside += u32::from(is_in);
                    outside += u32::from(!is_in);
                }
                let all =
                    |bits: u32| table[(turn * DISTANCES + step) as usize * 2][..4].iter().all(|word| *word == bits);
                assert!(step > 0 || all(0), "none");
                assert!(step < DISTANCES - 1 || all(u32::MAX), "all");
            }
        }
        assert!(inside.abs_diff(outside) < (inside + outside) / 100, "{inside} inside, {outside} outside");
    }

    #[test]
    fn samples_in_one_place_go_by_the_sign() {
        let table = half_planes(&[DVec2::ZERO; 32], 1.0);
        let of = |step: u32| table[(64 * DISTANCES + step) as usize][0];
        assert_eq!((of(DISTANCES / 2 - 1), of(DISTANCES / 2)), (0, u32::MAX));
    }
}

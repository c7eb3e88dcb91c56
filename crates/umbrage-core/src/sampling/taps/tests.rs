use super::layout::{rings, to_polar};
use super::*;
use std::f64::consts::{PI, TAU};

const DOMAINS: [Domain; 3] = [Domain::Disc, Domain::Square, Domain::Segment];
const PATTERNS: [Pattern; 4] = [Pattern::Stratified, Pattern::Blue, Pattern::Gradient, Pattern::Fixed];
const COUNTS: [u32; 7] = [1, 2, 7, 8, 9, 64, 1000];

/// Share of the domain beyond the line at distance `d` from its middle, across `angle`.
fn beyond(domain: Domain, angle: f64, d: f64) -> f64 {
    let (s, c) = angle.sin_cos();
    let (s, c) = (s.abs(), c.abs());
    match domain {
        Domain::Disc => (d.acos() - d * (1.0 - d * d).sqrt()) / PI,
        // The sum of two numbers that are even in [−c, c] and [−s, s].
        Domain::Square => {
            let corner = |t: f64| (t - d).max(0.0).powi(2);
            (corner(c + s) - corner(c - s) - corner(s - c) + corner(-c - s)) / (8.0 * c * s)
        }
        Domain::Segment => ((1.0 - d / c) / 2.0).clamp(0.0, 1.0),
    }
}

/// Over the sets and many lines: mean error of the share of taps beyond the line, root mean square,
/// and that of white noise.
fn share_errors(table: &TapTable, domain: Domain) -> (f64, f64, f64) {
    let (mut sum, mut squares, mut white, mut n) = (0.0, 0.0, 0.0, 0.0);
    for turn in 0..32 {
        let angle = TAU * (f64::from(turn) + 0.37) / 32.0;
        let (s, c) = angle.sin_cos();
        for line in -9..10 {
            let d = (f64::from(line) + 0.123) / 10.0;
            let want = beyond(domain, angle, d);
            for set in 0..table.sets {
                let taps = table.set(set);
                let count = taps.iter().filter(|[x, y]| f64::from(*x) * c + f64::from(*y) * s > d).count();
                let error = count as f64 / f64::from(table.taps) - want;
                sum += error;
                squares += error * error;
                white += want * (1.0 - want) / f64::from(table.taps);
                n += 1.0;
            }
        }
    }
    (sum / n, (squares / n).sqrt(), (white / n).sqrt())
}

#[test]
fn all_taps_are_in_the_domain_and_the_table_is_complete() {
    for (domain, pattern, taps) in all(&COUNTS) {
        let table = TapTable::new(pattern, domain, taps, 8, 4);
        assert_eq!(table.offsets.len() as u32, table.sets * taps);
        assert_eq!(table.set_of_pixel.len() as u32, table.tile * table.tile);
        assert!(table.set_of_pixel.iter().all(|&set| set < table.sets));
        for [x, y] in &table.offsets {
            let inside = match domain {
                Domain::Disc => x * x + y * y <= 1.0,
                Domain::Square => x.abs() <= 1.0 && y.abs() <= 1.0,
                Domain::Segment => x.abs() <= 1.0 && *y == 0.0,
            };
            assert!(inside, "{domain:?}, {pattern:?}, {taps} taps: {x}, {y}");
        }
    }
}

#[test]
fn one_tap_is_the_middle_and_no_taps_count_as_one() {
    for (domain, pattern, taps) in all(&[0, 1]) {
        let table = TapTable::new(pattern, domain, taps, 8, 2);
        assert!(table.taps == 1 && table.offsets.iter().all(|tap| *tap == [0.0; 2]));
    }
}

#[test]
fn moments_are_those_of_the_domain() {
    for (domain, pattern, taps) in all(&[64, 1000]) {
        let table = TapTable::new(pattern, domain, taps, 8, 16);
        let mean_of = |f: &dyn Fn(&[f32; 2]) -> f32| {
            table.offsets.iter().map(|tap| f64::from(f(tap))).sum::<f64>() / table.offsets.len() as f64
        };
        let (x, y) = (mean_of(&|tap| tap[0]), mean_of(&|tap| tap[1]));
        let second =
            [mean_of(&|tap| tap[0] * tap[0]), mean_of(&|tap| tap[1] * tap[1]), mean_of(&|tap| tap[0] * tap[1])];
        let want = match domain {
            Domain::Disc => [0.25, 0.25, 0.0],
            Domain::Square => [1.0 / 3.0, 1.0 / 3.0, 0.0],
            Domain::Segment => [1.0 / 3.0, 0.0, 0.0],
        };
        let off = second.iter().zip(want).map(|(got, want)| (got - want).abs()).fold(0.0, f64::max);
        // Four standard deviations of taps jittered in cells of area 4 / taps, 256 sets of them.
        // The others have no chance in them, but a lattice has a slant, and one set need not be as
        // good as the many: measured, rounded up.
        let limit = match pattern {
            Pattern::Stratified => 0.145,
            Pattern::Blue | Pattern::Gradient => 0.25,
            Pattern::Fixed => 1.0,
        } / f64::from(taps);
        assert!(
            x.abs() < limit && y.abs() < limit && off < limit,
            "{domain:?}, {pattern:?}, {taps}: {x}, {y}; {second:?}"
        );
    }
}

#[test]
fn grids_are_regular_and_have_the_moments_of_the_domain() {
    for domain in DOMAINS {
        assert_eq!(TapTable::grid(domain, 0).offsets, [[0.0; 2]]);
        for side in [1, 2, 3, 8, 31] {
            let table = TapTable::grid(domain, side);
            assert_eq!((table.sets, table.taps, table.offsets.len() as u32), (1, side * side, side * side));
            let mean = |f: &dyn Fn(&[f32; 2]) -> f32| table.offsets.iter().map(f).sum::<f32>() / table.taps as f32;
            let full = if domain == Domain::Disc { 0.25 } else { 1.0 / 3.0 };
            // The middles of n pieces have (1 − 1/n²) of the second moment of all; in the disc they
            // come as close to that.
            let pieces = if domain == Domain::Segment { side * side } else { side } as f32;
            let want = full * (1.0 - 1.0 / (pieces * pieces));
            let limit = if domain == Domain::Disc { 1.1 * full / (pieces * pieces) } else { 1e-5 };
            let (second, first) = (mean(&|tap| tap[0] * tap[0]), mean(&|tap| tap[0]) + mean(&|tap| tap[1]));
            assert!(
                first.abs() < 1e-5 && (second - want).abs() < limit,
                "{domain:?}, {side}: {first}, {second}, {want}"
            );
        }
    }
    assert_eq!(TapTable::grid(Domain::Square, 2).offsets, [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]]);
}

#[test]
fn weighted_taps_go_where_a_picture_is_bright() {
    let picture = |pixels: [u8; 4]| Texture {
        name: "test".into(),
        width: 2,
        height: 2,
        rgba: pixels.map(|v| [v, v, v, 255]).to_vec(),
        sampling: Default::default(),
    };
    let table = TapTable::grid(Domain::Square, 16);
    // Rows go down: the second row is at negative y.
    let right_of_second_row = table.clone().weighted_by(&picture([0, 0, 0, 200]));
    assert!(right_of_second_row.offsets.iter().all(|[x, y]| *x >= 0.0 && *y <= 0.0));
    let left = table.clone().weighted_by(&picture([90, 0, 90, 0]));
    assert!(left.offsets.iter().all(|[x, _]| *x <= 0.0));
    assert_eq!(left.offsets.iter().filter(|[_, y]| *y > 0.0).count(), 128);
    assert_eq!(table.clone().weighted_by(&picture([0; 4])), table);
    let flat = table.clone().weighted_by(&picture([77; 4]));
    let off = |a: &[f32; 2], b: &[f32; 2]| (a[0] - b[0]).abs() + (a[1] - b[1]).abs();
    assert!(flat.offsets.iter().zip(&table.offsets).all(|(a, b)| off(a, b) < 1e-5));
}

#[test]
fn each_stratum_of_the_same_area_holds_one_tap() {
    for taps in [2, 7, 8, 9, 64, 100, 1000] {
        for domain in [Domain::Disc, Domain::Square] {
            let table = TapTable::new(Pattern::Stratified, domain, taps, 8, 3);
            let rings = rings(domain, taps, taps.min(8));
            assert_eq!(rings.iter().sum::<u32>(), taps);
            for set in 0..table.sets {
                let mut at = table.set(set).iter().map(|tap| to_polar(domain, tap.map(f64::from)));
                let mut left = taps;
                for sectors in &rings {
                    let (from, to) = (f64::from(left - sectors) / f64::from(taps), f64::from(left) / f64::from(taps));
                    left -= sectors;
                    for sector in 0..*sectors {
                        let (around, within) = at.next().unwrap();
                        let in_sector = around * f64::from(*sectors) - f64::from(sector);
                        assert!((-1e-4..=1.0001).contains(&in_sector), "{domain:?}, {taps}: {around} in {sector}");
                        assert!((from - 1e-6..=to + 1e-6).contains(&within), "{domain:?}, {taps}: {within}");
                    }
                }
            }
        }
        for set in TapTable::new(Pattern::Stratified, Domain::Segment, taps, 8, 3).offsets.chunks(taps as usize) {
            let mut x: Vec<f32> = set.iter().map(|tap| (tap[0] * 0.5 + 0.5) * taps as f32).collect();
            x.sort_by(f32::total_cmp);
            assert!(x.iter().zip(0u16..).all(|(x, i)| (x - f32::from(i) - 0.5).abs() <= 0.501), "{x:?}");
        }
    }
}

#[test]
fn strata_are_about_as_long_as_wide() {
    for domain in [Domain::Disc, Domain::Square] {
        for taps in [16, 25, 64, 256, 1000] {
            let mut left = 1.0;
            for sectors in rings(domain, taps, 0) {
                let share = f64::from(sectors) / f64::from(taps);
                let (outer, inner) = (f64::sqrt(left), f64::sqrt(f64::max(left - share, 0.0)));
                left -= share;
                let around = if domain == Domain::Disc { TAU } else { 8.0 };
                let shape = around * 0.5 * (outer + inner) / f64::from(sectors) / (outer - inner);
                assert!((0.6..1.7).contains(&shape), "{domain:?}, {taps}: a ring of {sectors} has {shape}");
            }
        }
    }
}

#[test]
fn the_first_taps_are_outermost_and_one_in_each_sector() {
    for (domain, pattern, taps) in all(&[9, 16, 25, 64, 1000]).filter(|(domain, ..)| *domain != Domain::Segment) {
        let table = TapTable::new(pattern, domain, taps, 8, 4);
        for set in 0..table.sets {
            let polar: Vec<_> = table.set(set).iter().map(|tap| to_polar(domain, tap.map(f64::from))).collect();
            let sector = |tap: &(f64, f64)| (tap.0 * 8.0) as usize % 8;
            let mut outermost = [-1.0; 8];
            polar.iter().for_each(|tap| outermost[sector(tap)] = f64::max(outermost[sector(tap)], tap.1));
            let mut tested = [-1.0; 8];
            polar[..8].iter().for_each(|tap| tested[sector(tap)] = f64::max(tested[sector(tap)], tap.1));
            // A few evenly spread taps may leave a sector empty; then the eight have another
            // outermost one instead.
            assert_eq!(tested, outermost, "{domain:?}, {pattern:?}, {taps} taps, set {set}");
            let all_full = outermost.iter().all(|within| *within >= 0.0);
            assert!(all_full || (pattern != Pattern::Stratified && taps <= 16), "{domain:?}, {pattern:?}, {taps}");
        }
    }
}

#[test]
fn the_first_taps_of_a_segment_cover_it() {
    for pattern in PATTERNS {
        for taps in [8, 9, 64, 1000] {
            let table = TapTable::new(pattern, Domain::Segment, taps, 8, 4);
            for set in 0..table.sets {
                let x: Vec<f32> = table.set(set)[..8].iter().map(|tap| tap[0]).collect();
                let stratum = 2.0 / taps as f32;
                assert!(x[0] <= -1.0 + stratum && x[7] >= 1.0 - stratum, "{pattern:?}, {taps}: {x:?}");
                let gap = (2.0 - stratum) / 7.0;
                assert!(
                    x.windows(2).all(|x| (x[1] - x[0] - gap).abs() <= 2.001 * stratum),
                    "{pattern:?}, {taps}: {x:?}"
                );
            }
        }
    }
}

#[test]
fn neighbours_have_different_sets() {
    for domain in DOMAINS {
        for pattern in [Pattern::Stratified, Pattern::Blue, Pattern::Gradient] {
            let table = TapTable::new(pattern, domain, 16, 8, 8);
            for a in 0..table.sets {
                assert!((0..a).all(|b| table.set(a) != table.set(b)), "{domain:?}, {pattern:?}: set {a} comes again");
            }
            let tile = table.tile as usize;
            for pixel in 0..table.set_of_pixel.len() {
                let right = pixel / tile * tile + (pixel + 1) % tile;
                let below = (pixel + tile) % (tile * tile);
                let same = |other| tile > 1 && table.set_of_pixel[pixel] == table.set_of_pixel[other];
                assert!(!same(right) && !same(below), "{pattern:?}: pixel {pixel}");
            }
        }
    }
}

#[test]
fn blue_tiles_take_all_sets_equally_often() {
    let table = TapTable::new(Pattern::Blue, Domain::Disc, 16, 8, 16);
    for set in 0..64 {
        assert_eq!(table.set_of_pixel.iter().filter(|&&of_pixel| of_pixel == set).count(), 4);
    }
}

#[test]
fn shares_beyond_lines_are_right_with_less_noise_than_random_taps() {
    for (domain, pattern, taps) in all(&[16, 64, 256]) {
        // The largest root mean squares, as a share of that of random taps: the measured ones,
        // rounded up.
        let limit = match (pattern, taps) {
            (Pattern::Stratified, 16) => 0.55,
            (Pattern::Stratified, 64) => 0.4,
            (Pattern::Stratified, _) => 0.28,
            (_, 16) => 0.45,
            (_, 64) => 0.32,
            _ => 0.19,
        };
        let (mean, rms, white) = share_errors(&TapTable::new(pattern, domain, taps, 8, 8), domain);
        let mean_limit = if pattern == Pattern::Fixed { 0.04 } else { 0.012 } / f64::from(taps).sqrt();
        assert!(mean.abs() < mean_limit, "{domain:?}, {pattern:?}, {taps} taps: mean error {mean}");
        assert!(rms < limit * white, "{domain:?}, {pattern:?}, {taps} taps: {rms}, random ones {white}");
    }
}

#[test]
fn the_closed_forms_of_these_tests_agree_with_many_taps() {
    // Against an error of the formulas and of the layout that both hide from each other: a plain
    // grid.
    let grid: Vec<[f64; 2]> =
        (0..400 * 400).map(|i| [i % 400, i / 400].map(|x| (f64::from(x) + 0.5) / 200.0 - 1.0)).collect();
    for domain in [Domain::Disc, Domain::Square] {
        let of_domain: Vec<_> = grid.iter().filter(|[x, y]| domain == Domain::Square || x * x + y * y <= 1.0).collect();
        for (angle, d) in [(0.3, 0.2), (1.4, -0.5), (2.5, 0.0), (4.0, 0.8)] {
            let (s, c) = f64::sin_cos(angle);
            let share = of_domain.iter().filter(|[x, y]| x * c + y * s > d).count() as f64 / of_domain.len() as f64;
            let want = beyond(domain, angle, d);
            assert!((share - want).abs() < 2e-3, "{domain:?}, {angle}, {d}: {share}, {want}");
        }
    }
}

/// All domains with all patterns and these numbers of taps.
fn all(counts: &[u32]) -> impl Iterator<Item = (Domain, Pattern, u32)> {
    DOMAINS.into_iter().flat_map(move |domain| {
        PATTERNS.into_iter().flat_map(move |pattern| counts.iter().map(move |&taps| (domain, pattern, taps)))
    })
}

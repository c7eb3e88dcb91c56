//! Where the view of a camera is split by distance, so that each part gets a map of its own.
//!
//! Sources: Zhang, Sun, Xu and Lun, "Parallel-Split Shadow Maps for Large-Scale Virtual
//! Environments", 2006; FE 3.1.

/// Most parts that a view is split into.
pub const MOST_SPLITS: usize = 9;

/// The borders of `count` parts of what lies between the distances `near` and `far`: `count + 1` of
/// them, ascending, the first `near`, the last `far`.
///
/// `lambda` is between uniform (0) and logarithmic (1) borders, the practical scheme: C_i = λ n (f
/// / n)^(i / m) + (1 − λ) (n + (f − n) i / m). (FE 3.1 has a sum in place of the first product;
/// with that the last part would not end at `far`.) Distances of 0 or less have no logarithm:
/// borders are uniform there. `count` is clamped to 1 … [`MOST_SPLITS`], `lambda` to 0 … 1; `far`
/// before `near` counts as `near`.
///
/// ```
/// # use umbrage_core::splits::split_distances;
/// assert_eq!(split_distances(1.0, 100.0, 2, 1.0), [1.0, 10.0, 100.0]);
/// assert_eq!(split_distances(1.0, 101.0, 2, 0.0), [1.0, 51.0, 101.0]);
/// ```
pub fn split_distances(near: f64, far: f64, count: usize, lambda: f64) -> Vec<f64> {
    let count = count.clamp(1, MOST_SPLITS);
    let far = far.max(near);
    let lambda = if near > 0.0 && far.is_finite() { lambda.clamp(0.0, 1.0) } else { 0.0 };
    let border = |i: usize| {
        let share = i as f64 / count as f64;
        let uniform = near + (far - near) * share;
        let logarithmic = if lambda > 0.0 { near * (far / near).powf(share) } else { uniform };
        (logarithmic * lambda + uniform * (1.0 - lambda)).clamp(near, far)
    };
    // The ends are what was asked for, to the last bit.
    let inner = (1..count).map(border);
    std::iter::once(near).chain(inner).chain([far]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_forms() {
        let near = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
        assert!(near(&split_distances(1.0, 10_000.0, 4, 1.0), &[1.0, 10.0, 100.0, 1000.0, 10_000.0]));
        assert!(near(&split_distances(2.0, 10.0, 4, 0.0), &[2.0, 4.0, 6.0, 8.0, 10.0]));
        // Half way between 10 and 50.5.
        assert!(near(&split_distances(1.0, 100.0, 2, 0.5), &[1.0, 30.25, 100.0]));
    }

    #[test]
    fn borders_ascend_from_near_to_far() {
        for count in 1..=MOST_SPLITS {
            for lambda in [0.0, 0.3, 0.5, 0.99, 1.0] {
                for (near, far) in [(0.05, 500.0), (1e-6, 1e7), (3.0, 3.0), (0.0, 10.0), (-5.0, 5.0)] {
                    let borders = split_distances(near, far, count, lambda);
                    assert_eq!(borders.len(), count + 1);
                    assert_eq!((borders[0], borders[count]), (near, far));
                    assert!(borders.is_sorted(), "{near} {far} {count} {lambda}: {borders:?}");
                }
            }
        }
    }

    #[test]
    fn more_lambda_brings_inner_borders_nearer() {
        let at = |lambda| split_distances(0.5, 200.0, 4, lambda);
        for (less, more) in at(0.2).iter().zip(at(0.7)).skip(1).take(3) {
            assert!(more < *less);
        }
    }

    #[test]
    fn what_is_out_of_range_is_clamped() {
        assert_eq!(split_distances(1.0, 2.0, 0, 0.5).len(), 2);
        assert_eq!(split_distances(1.0, 2.0, 10, 0.5).len(), 10);
        assert_eq!(split_distances(5.0, 2.0, 2, 0.5), [5.0, 5.0, 5.0]);
        assert_eq!(split_distances(1.0, 9.0, 2, 7.0), split_distances(1.0, 9.0, 2, 1.0));
        assert!(split_distances(1.0, f64::INFINITY, 1, 0.5)[1].is_infinite());
    }
}

//! How wide filters are made cheap: the moments are reduced first, and blurred and looked up on the
//! coarser grid.

/// What makes up a filter of some radius.
///
/// A mean over 2ⁿ × 2ⁿ texels, looked up with a quadratic B-spline, has a variance of 4ⁿ / 3 − 1 /
/// 12 squared texels along each axis. What is missing up to the next n is the part of a few
/// binomial taps on the coarser grid. So a wider filter is as many taps on fewer texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Blur {
    /// How often the map is halved.
    pub(super) level: u32,
    /// Weights of the middle tap, its neighbours and theirs; the outer ones are 0 where the
    /// reduction alone is wide enough.
    pub(super) taps: [f64; 3],
    /// Of the whole filter along each axis, squared texels.
    pub(super) variance: f64,
}

/// The most often that moments are halved in the pass that takes them.
pub(super) const AT_ONCE: u32 = 2;
/// Texels that are left of a map at least.
const LEAST_SIZE: u32 = 4;
/// Of three taps with the B-spline after them; wider ones would have a dent in the middle.
const MOST_OF_THREE: f64 = 0.7;
/// Of five binomial taps.
const MOST_OF_FIVE: f64 = 1.0;

impl Blur {
    /// As wide as a disc of this radius, in texels of a map of `size`; as near to that as the map
    /// allows.
    pub(super) fn new(radius: f64, size: u32) -> Self {
        // A disc has a quarter of its squared radius along each axis.
        let wanted = radius * radius * 0.25;
        let most = (size / LEAST_SIZE).checked_ilog2().unwrap_or(0);
        let mut level = 0;
        while level < most && widest_of(level) < wanted {
            level += 1;
        }
        let coarse = 4_f64.powi(level as i32);
        let missing = (wanted - of_level(level)) / coarse;
        // The taps (a, 1 − 2a, a) have the variance 2a: once on the map itself, else twice.
        let (taps, missing) = if level == 0 {
            let a = missing.clamp(0.0, MOST_OF_THREE) * 0.5;
            ([1.0 - 2.0 * a, a, 0.0], 2.0 * a)
        } else {
            let a = missing.clamp(0.0, MOST_OF_FIVE) * 0.25;
            let inner = 1.0 - 2.0 * a;
            ([inner * inner + 2.0 * a * a, 2.0 * a * inner, a * a], 4.0 * a)
        };
        Self { level, taps, variance: of_level(level) + missing * coarse }
    }

    /// Whether moments are taken from several texels around: cheaper than more passes over a whole
    /// map.
    pub(super) fn is_in_take(&self) -> bool {
        self.level == 0 && self.taps[1] > 0.0
    }

    /// Texels of the map that moments are taken from at once.
    pub(super) fn texels_taken(&self) -> u64 {
        if self.is_in_take() { 9 } else { 1 << (2 * self.level.min(AT_ONCE)) }
    }

    /// Whether a blur across and one down follow.
    pub(super) fn has_passes(&self) -> bool {
        self.level > 0 && self.taps[1] > 0.0
    }
}

/// The largest variance for which a level is the nearest: up to half-way to the next where taps do
/// not get there.
fn widest_of(level: u32) -> f64 {
    if level > 0 { of_level(level + 1) } else { 0.5 * (of_level(0) + MOST_OF_THREE + of_level(1)) }
}

/// Variance of a reduction to 1 / 2ⁿ and its look-up.
fn of_level(level: u32) -> f64 {
    4_f64.powi(level as i32) / 3.0 - 1.0 / 12.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Variance of the filter as the shaders do it, along one axis: the look-up's weights around
    /// every place of a coarse texel, spread over taps and texels.
    fn measured(blur: &Blur, place: f64) -> f64 {
        let width = f64::from(1 << blur.level);
        let f = place - 0.5;
        let spline = [0.5 * (0.5 - f).powi(2), 0.75 - f * f, 0.5 * (0.5 + f).powi(2)];
        let mut moments = [0.0; 3];
        for (i, at) in spline.iter().zip(-1..) {
            for tap in -2_i32..=2 {
                for texel in 0..1 << blur.level {
                    let x = f64::from(at + tap) * width + f64::from(texel) + 0.5 - place * width;
                    let weight = i * blur.taps[tap.unsigned_abs() as usize] / width;
                    moments.iter_mut().zip([1.0, x, x * x]).for_each(|(m, v)| *m += weight * v);
                }
            }
        }
        assert!((moments[0] - 1.0).abs() < 1e-12 && moments[1].abs() < 1e-9 * width, "{moments:?}");
        moments[2]
    }

    #[test]
    fn filters_are_as_wide_as_asked_for() {
        for radius in [1.0, 1.3, 1.9, 2.0, 2.2, 2.3, 3.0, 5.0, 8.0, 33.0, 64.0, 100.0] {
            let blur = Blur::new(radius, 4096);
            // Between 1.95 and 2.24 texels there is none.
            let slack = if (1.95..2.24).contains(&radius) { 0.08 } else { 1e-9 };
            assert!((2.0 * blur.variance.sqrt() / radius - 1.0).abs() < slack, "{radius}: {blur:?}");
            assert!(blur.taps.iter().all(|w| *w >= 0.0), "{radius}: {blur:?}");
            for place in [0.0, 0.3, 0.5, 0.9] {
                assert!((measured(&blur, place) / blur.variance - 1.0).abs() < 1e-9, "{radius} {place}: {blur:?}");
            }
        }
    }

    #[test]
    fn a_filter_is_no_narrower_than_its_look_up_and_no_wider_than_the_map() {
        for radius in [0.0, 0.5, 1.0] {
            let blur = Blur::new(radius, 1024);
            assert_eq!((blur.level, blur.is_in_take(), blur.has_passes(), blur.variance), (0, false, false, 0.25));
        }
        for size in [1, 2, 3, 7, 1000, 16384] {
            let blur = Blur::new(1e9, size);
            assert!(size >> blur.level >= LEAST_SIZE.min(size) && blur.variance.is_finite(), "{size}: {blur:?}");
        }
    }
}

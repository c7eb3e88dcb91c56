//! Axes: logarithmic, or even for what runs through zero or not far.

use crate::round::rounded;

/// Decades that an axis shows at most; what is below is drawn on its edge.
const DECADES: i32 = 4;

/// One axis of a plot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
    /// Whether equal steps are equal lengths, in place of equal ratios.
    even: bool,
    /// Whether some values are on the lower edge, because they are below it.
    pub cut: bool,
}

impl Axis {
    /// For these values, from the place `from` of a picture to `to`.
    pub(crate) fn new(values: &[f64], from: f64, to: f64) -> Self {
        let positive = || values.iter().copied().filter(|v| *v > 0.0);
        let high = positive().fold(0.0, f64::max);
        // Nothing to show: any axis is as good.
        let high = if high > 0.0 { high * 1.25 } else { 1.0 };
        let least = positive().fold(high / 2.0, f64::min).max(high / 10f64.powi(DECADES));
        let cut = values.iter().any(|v| *v < least);
        Self { low: if cut { below(least / 1.5) } else { least / 1.25 }, high, from, to, even: false, cut }
    }

    /// Logarithmic where the values go over a factor of ten or more, else even.
    pub(crate) fn even_or_log(values: &[f64], from: f64, to: f64) -> Self {
        let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
        if low > 0.0 && high >= 10.0 * low || low >= high {
            return Self::new(values, from, to);
        }
        let room = 0.04 * (high - low);
        Self { low: low - room, high: high + room, from, to, even: true, cut: false }
    }

    /// Where a value is.
    pub(crate) fn at(&self, value: f64) -> f64 {
        let share = if self.even {
            (value - self.low) / (self.high - self.low)
        } else {
            (value.max(self.low) / self.low).ln() / (self.high / self.low).ln()
        };
        self.from + share.min(1.0) * (self.to - self.from)
    }

    pub(crate) fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// 1, 2 and 5 of each decade, or more where those are too few, but none where the edge is
    /// marked.
    pub(crate) fn ticks(&self) -> Vec<f64> {
        if self.even {
            return self.even_ticks();
        }
        let (first, last) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        let of = |digits: &[f64]| -> Vec<f64> {
            let all = (first..=last).flat_map(|decade| digits.iter().map(move |d| rounded(d * 10f64.powi(decade))));
            let edge = if self.cut { self.low * 1.5 } else { self.low };
            all.filter(|v| (edge..=self.high).contains(v)).collect()
        };
        let (few, more) = (of(&[1.0, 2.0, 5.0]), of(&[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0]));
        if few.len() < 3 { more } else { few }
    }

    /// Multiples of 1, 2 or 5 of a decade, five to a dozen of them.
    fn even_ticks(&self) -> Vec<f64> {
        let step = below((self.high - self.low) / 5.0);
        let (first, last) = ((self.low / step).ceil() as i64, (self.high / step).floor() as i64);
        (first..=last).map(|i| rounded(i as f64 * step)).collect()
    }

    /// The lower edge.
    pub(crate) fn low(&self) -> f64 {
        self.low
    }
}

/// The next 1, 2 or 5 of a decade.
fn below(value: f64) -> f64 {
    let decade = 10f64.powf(value.log10().floor());
    let digit = [5.0, 2.0].into_iter().find(|digit| digit * decade <= value).unwrap_or(1.0);
    rounded(digit * decade)
}

/// A number with up to three significant digits.
pub(crate) fn short(value: f64) -> String {
    let Ok(value) = format!("{value:.2e}").parse::<f64>() else { return String::new() };
    if value != 0.0 && value.abs() < 1e-4 { format!("{value:e}") } else { value.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_ratios_are_equal_lengths() {
        let axis = Axis::new(&[1.0, 80.0], 100.0, 500.0);
        let step = axis.at(2.0) - axis.at(1.0);
        assert!(step > 0.0 && (axis.at(80.0) - axis.at(40.0) - step).abs() < 1e-9);
        assert!((axis.at(1.25 * 80.0) - 500.0).abs() < 1e-9 && (axis.at(0.8) - 100.0).abs() < 1e-9);
        assert_eq!((axis.cut, axis.ticks()), (false, vec![1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]));
    }

    #[test]
    fn equal_steps_are_equal_lengths_where_values_run_through_zero() {
        let axis = Axis::even_or_log(&[0.0, 0.5, 1.0], 100.0, 500.0);
        assert!((axis.at(0.5) - axis.at(0.0) - (axis.at(1.0) - axis.at(0.5))).abs() < 1e-9 && axis.at(0.5) == 300.0);
        assert_eq!(axis.ticks(), [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]);
        assert_eq!(Axis::even_or_log(&[-3.0, 9.0], 0.0, 1.0).ticks(), [-2.0, 0.0, 2.0, 4.0, 6.0, 8.0]);
        assert_eq!(Axis::even_or_log(&[256.0, 4096.0], 0.0, 1.0), Axis::new(&[256.0, 4096.0], 0.0, 1.0));
        assert!(Axis::even_or_log(&[7.0], 0.0, 1.0).at(7.0).is_finite());
        assert!(Axis::even_or_log(&[], 0.0, 1.0).at(7.0).is_finite());
    }

    #[test]
    fn what_is_too_small_is_on_the_edge() {
        let axis = Axis::new(&[0.0, -3.0, 1e-9, 2.0, 4.0], 0.0, 100.0);
        assert_eq!((axis.cut, axis.at(0.0), axis.at(-3.0), axis.at(1e-9)), (true, 0.0, 0.0, 0.0));
        assert!(axis.at(2.0) > 80.0 && !axis.contains(1e-9) && axis.contains(2.0));
        assert_eq!(axis.low(), 2e-4, "5e-4 is the last of four decades; below it the next round number is the edge");
        assert!(axis.ticks().iter().all(|tick| *tick >= 3e-4), "{:?}", axis.ticks());
    }

    #[test]
    fn there_are_ticks_whatever_the_values() {
        for values in [&[][..], &[0.0], &[-1.0], &[3.3], &[1.01, 1.02], &[1e-12, 1e12]] {
            let axis = Axis::new(values, 0.0, 100.0);
            assert!(axis.ticks().len() >= 2 && axis.at(1.0).is_finite(), "{values:?}: {axis:?}");
        }
    }

    #[test]
    fn numbers_are_short() {
        let text = [0.0, 0.5, 1234.5, 0.012345, 99.96, 1e-5, -0.25].map(short);
        assert_eq!(text, ["0", "0.5", "1230", "0.0123", "100", "1e-5", "-0.25"]);
    }
}

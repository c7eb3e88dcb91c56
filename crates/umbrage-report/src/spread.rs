//! Median, smallest and largest of repeated measurements.

use crate::round::six;
use serde::Serialize;

/// Milliseconds of several frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Half of the frames took no longer.
    #[serde(serialize_with = "six")]
    pub median: f64,
    /// The shortest.
    #[serde(serialize_with = "six")]
    pub min: f64,
    /// The longest.
    #[serde(serialize_with = "six")]
    pub max: f64,
}

impl Spread {
    /// Of `values` in any order; all zero where there are none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.into_iter().collect();
        sorted.sort_by(f64::total_cmp);
        let (Some(&min), Some(&max)) = (sorted.first(), sorted.last()) else { return Self::default() };
        let median = (sorted[(sorted.len() - 1) / 2] + sorted[sorted.len() / 2]) * 0.5;
        Self { median, min, max }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!(Spread::of([5.0, 1.0, 3.0]), Spread { median: 3.0, min: 1.0, max: 5.0 });
        assert_eq!(Spread::of([4.0, 1.0]).median, 2.5);
        assert_eq!(Spread::of([]), Spread::default());
    }
}

//! How large pictures are, so that the window answers.

/// Picture pixels' divisors, from fine to coarse.
const DIVISORS: [u32; 6] = [1, 2, 3, 4, 6, 8];
/// GPU time of all panes together that still lets the window answer at once, milliseconds.
const GOAL_MS: f64 = 40.0;
/// The same of a picture that is drawn once, when hands rest.
const REST_MS: f64 = 800.0;
/// A finer picture has to promise to stay this far below the goal, lest sizes go back and forth.
const RESERVE: f64 = 0.6;

/// Chooses the divisor by what frames cost.
#[derive(Debug)]
pub(crate) struct Pace {
    divisor: u32,
    /// Milliseconds of all panes for each pixel of the window, were the divisor 1.
    cost: Option<f64>,
    /// Frames since the divisor was changed.
    settled: u32,
}

impl Default for Pace {
    fn default() -> Self {
        Self { divisor: 1, cost: None, settled: 0 }
    }
}

impl Pace {
    /// The divisor now.
    pub fn divisor(&self) -> u32 {
        self.divisor
    }

    /// The divisor for a picture that stays, which may take its time.
    pub fn at_rest(&self) -> u32 {
        let cost = self.cost.unwrap_or_default();
        DIVISORS.into_iter().find(|d| cost / f64::from(d * d) <= REST_MS).unwrap_or(self.divisor).min(self.divisor)
    }

    /// Takes a frame into account that took `ms` for all panes together.
    pub fn took(&mut self, ms: f64) {
        self.settled += 1;
        // The first frames of a size make pipelines and textures.
        if !ms.is_finite() || ms <= 0.0 || self.settled < 4 {
            return;
        }
        let whole = ms * f64::from(self.divisor * self.divisor);
        let cost = self.cost.map_or(whole, |old| old + (whole - old) * 0.3);
        self.cost = Some(cost);
        let at = |divisor: u32| cost / f64::from(divisor * divisor);
        let now = at(self.divisor);
        let fits = |limit: f64| DIVISORS.into_iter().find(|d| at(*d) <= limit).unwrap_or(DIVISORS[5]);
        let next = if now > GOAL_MS { fits(GOAL_MS) } else { fits(GOAL_MS * RESERVE).min(self.divisor) };
        if next != self.divisor {
            (self.divisor, self.settled) = (next, 0);
        }
    }

    /// Something else is drawn from now on.
    pub fn forget(&mut self) {
        self.cost = None;
        self.settled = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The divisor in the end when a whole picture takes `ms`.
    fn rest(ms: f64) -> u32 {
        let mut pace = Pace::default();
        for _ in 0..100 {
            pace.took(ms / f64::from(pace.divisor() * pace.divisor()));
        }
        pace.divisor()
    }

    #[test]
    fn pictures_get_as_small_as_they_have_to() {
        assert_eq!([1.0, 39.0, 100.0, 300.0, 1e6].map(rest), [1, 1, 2, 3, 8]);
    }

    #[test]
    fn at_rest_pictures_are_as_fine_as_one_frame_can_be() {
        let mut pace = Pace::default();
        (0..100).for_each(|_| pace.took(300.0 / f64::from(pace.divisor() * pace.divisor())));
        assert_eq!((pace.divisor(), pace.at_rest()), (3, 1));
        let mut pace = Pace::default();
        (0..100).for_each(|_| pace.took(5000.0 / f64::from(pace.divisor() * pace.divisor())));
        assert_eq!(pace.at_rest(), 3);
    }

    #[test]
    fn one_slow_frame_changes_nothing_for_long() {
        let mut pace = Pace::default();
        (0..10).for_each(|_| pace.took(5.0));
        pace.took(300.0);
        (0..40).for_each(|_| pace.took(5.0));
        assert_eq!(pace.divisor(), 1);
        pace.took(f64::NAN);
        assert_eq!(pace.divisor(), 1);
    }

    #[test]
    fn what_gets_cheap_gets_fine_again() {
        let mut pace = Pace::default();
        (0..50).for_each(|_| pace.took(400.0 / f64::from(pace.divisor() * pace.divisor())));
        assert!(pace.divisor() > 1);
        (0..50).for_each(|_| pace.took(4.0 / f64::from(pace.divisor() * pace.divisor())));
        assert_eq!(pace.divisor(), 1);
    }
}

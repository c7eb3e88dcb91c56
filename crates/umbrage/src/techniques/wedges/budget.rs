//! The scale that keeps a light within its time (SG "Load-balancing").

/// Frames between two changes: times arrive a few frames late, and a change shows in them after
/// that.
const PATIENCE: u32 = 8;

/// A finer scale has to fit with so much to spare, or scales would change to and fro.
const SPARE: f64 = 0.8;

/// Chooses the scale of a frame by what earlier ones took.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    budget_ms: f64,
    scale: u32,
    /// Frames until it may change.
    wait: u32,
}

impl Budget {
    /// `budget_ms` 0: the scale stays.
    pub fn new(budget_ms: f64, scale: u32) -> Self {
        Self { budget_ms, scale, wait: PATIENCE }
    }

    pub fn scale(&self) -> u32 {
        self.scale
    }

    /// `last_ms`: what the light's passes took, as far as that is known.
    pub fn frame(&mut self, last_ms: Option<f64>) {
        let Some(last_ms) = last_ms.filter(|_| self.budget_ms > 0.0) else { return };
        self.wait = self.wait.saturating_sub(1);
        if self.wait > 0 {
            return;
        }
        // Next to all of the time goes by the number of pixels.
        let finer = last_ms * 4.0;
        let next = match self.scale {
            1 | 2 if last_ms > self.budget_ms => self.scale * 2,
            2 | 4 if finer < SPARE * self.budget_ms => self.scale / 2,
            same => same,
        };
        if next != self.scale {
            (self.scale, self.wait) = (next, PATIENCE);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The scale after many frames of a light that takes `full_ms` at full size.
    fn settle(budget: &mut Budget, full_ms: f64) -> u32 {
        for _ in 0..100 {
            budget.frame(Some(full_ms / f64::from(budget.scale() * budget.scale())));
        }
        budget.scale()
    }

    #[test]
    fn it_settles_on_the_finest_scale_that_fits() {
        let mut budget = Budget::new(2.0, 1);
        assert_eq!(settle(&mut budget, 1.0), 1);
        assert_eq!(settle(&mut budget, 6.0), 2);
        assert_eq!(settle(&mut budget, 20.0), 4);
        // Nothing is smaller.
        assert_eq!(settle(&mut budget, 1000.0), 4);
        assert_eq!(settle(&mut budget, 1.0), 1);
    }

    #[test]
    fn it_does_not_go_to_and_fro() {
        let mut budget = Budget::new(2.0, 1);
        settle(&mut budget, 2.2);
        assert_eq!(budget.scale(), 2);
        let before = budget.scale();
        settle(&mut budget, 1.9);
        assert_eq!(budget.scale(), before, "1.9 of 2 ms is too near");
    }

    #[test]
    fn without_a_budget_or_times_it_stays() {
        let mut none = Budget::new(0.0, 2);
        assert_eq!(settle(&mut none, 100.0), 2);
        let mut blind = Budget::new(1.0, 1);
        (0..100).for_each(|_| blind.frame(None));
        assert_eq!(blind.scale(), 1);
    }
}

//! Choices and changed values, all out of the number of the input.

use mutatis::{DefaultMutate, Session};

pub struct Dice {
    session: Session,
}

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self { session: Session::new().seed(seed) }
    }

    /// A number below `count`; 0 where there is none.
    pub fn below(&mut self, count: usize) -> usize {
        let number: u64 = self.session.generate().unwrap_or_default();
        if count == 0 { 0 } else { (number % count as u64) as usize }
    }

    /// True once in so many times.
    pub fn is_one_in(&mut self, times: usize) -> bool {
        self.below(times) == 0
    }

    /// One of these.
    pub fn choose<T: Clone>(&mut self, from: &[T]) -> Option<T> {
        let at = self.below(from.len());
        from.get(at).cloned()
    }

    /// Changes a value.
    pub fn change<T: DefaultMutate>(&mut self, value: &mut T) {
        // A value that can't be changed stays.
        let _ = self.session.mutate(value);
    }
}

//! Which instances have to be sent to the GPU.

use super::places::Places;
use std::ops::Range;

/// Places, each once.
#[derive(Default)]
pub(super) struct Changed {
    places: Vec<u32>,
    set: Places,
}

/// So many instances that did not change are sent rather than that a copy more is recorded.
const GAP: u32 = 16;

impl Changed {
    pub fn push(&mut self, place: u32) {
        self.set.make_room(place);
        if self.set.insert(place) {
            self.places.push(place);
        }
    }

    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Ranges of places that hold all; none are left.
    pub fn take(&mut self) -> Vec<Range<u32>> {
        self.places.sort_unstable();
        let mut ranges: Vec<Range<u32>> = Vec::new();
        for place in self.places.drain(..) {
            self.set.remove(place);
            match ranges.last_mut() {
                Some(last) if place <= last.end + GAP => last.end = place + 1,
                _ => ranges.push(place..place + 1),
            }
        }
        ranges
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_hold_what_changed_and_not_much_more() {
        let mut changed = Changed::default();
        [7, 900, 5, 7, 22, 39, 901].into_iter().for_each(|place| changed.push(place));
        assert_eq!(changed.take(), [5..40, 900..902]);
        assert!(changed.is_empty() && changed.take().is_empty());
        changed.push(7);
        assert_eq!(changed.take(), vec![7..8]);
    }
}

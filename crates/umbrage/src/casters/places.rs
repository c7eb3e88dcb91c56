//! Sets of casters.

/// A set of places in [`super::Casters::placed`]: a bit each.
#[derive(Clone, Default)]
pub(crate) struct Places {
    words: Vec<u64>,
}

impl Places {
    /// The empty set, with room for this many places.
    pub fn clear(&mut self, count: usize) {
        self.words.clear();
        self.words.resize(count.div_ceil(64), 0);
    }

    /// Has room for a place, and keeps what it holds.
    pub fn make_room(&mut self, place: u32) {
        let words = place as usize / 64 + 1;
        if self.words.len() < words {
            self.words.resize(words.next_power_of_two(), 0);
        }
    }

    /// Adds a place; true where it was not in the set and there is room.
    pub fn insert(&mut self, place: u32) -> bool {
        let Some(word) = self.words.get_mut(place as usize / 64) else { return false };
        let before = *word;
        *word |= 1 << (place % 64);
        *word != before
    }

    pub fn remove(&mut self, place: u32) {
        if let Some(word) = self.words.get_mut(place as usize / 64) {
            *word &= !(1 << (place % 64));
        }
    }

    /// Adds or removes a place.
    pub fn set(&mut self, place: u32, within: bool) {
        if within {
            self.insert(place);
        } else {
            self.remove(place);
        }
    }

    /// Adds all of another set.
    pub fn add(&mut self, other: &Self) {
        self.words.iter_mut().zip(&other.words).for_each(|(word, more)| *word |= more);
    }

    pub fn has(&self, place: u32) -> bool {
        self.words.get(place as usize / 64).is_some_and(|word| word >> (place % 64) & 1 == 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_holds_what_was_put_in() {
        let mut set = Places::default();
        assert!(!set.insert(0), "there is no room");
        set.clear(130);
        for place in [0, 63, 64, 129] {
            assert!(set.insert(place) && !set.insert(place) && set.has(place) && !set.has(place + 1));
        }
        set.remove(64);
        assert!(!set.has(64) && set.has(63) && !set.has(1000));
        set.clear(10);
        assert!(!set.has(0));
    }
}

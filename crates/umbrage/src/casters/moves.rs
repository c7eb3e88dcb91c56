//! Which casters moved when: so whoever keeps something for those at rest learns of the others
//! alone.

/// A log in which each caster stands at most twice as often as there are casters, however often it
/// moves.
#[derive(Default)]
pub(crate) struct Moves {
    /// Number of moves so far.
    now: u64,
    /// Moves in their order; only a caster's last one counts.
    log: Vec<Move>,
    /// By place in [`super::Casters::placed`]: the number of its last move, 0 for none.
    last: Vec<u64>,
}

#[derive(Clone, Copy)]
struct Move {
    number: u64,
    place: u32,
}

impl Moves {
    /// After a caster moved, came or went.
    pub fn push(&mut self, place: u32) {
        if place as usize >= self.last.len() {
            self.last.resize(place as usize + 1, 0);
        }
        self.now += 1;
        self.last[place as usize] = self.now;
        if self.log.len() >= 2 * self.last.len() {
            self.log.retain(|m| self.last[m.place as usize] == m.number);
        }
        self.log.push(Move { number: self.now, place });
    }

    /// The number of moves so far, for [`Moves::since`].
    pub fn now(&self) -> u64 {
        self.now
    }

    /// The number of a caster's last move; 0 where it never moved.
    pub fn last(&self, place: u32) -> u64 {
        self.last.get(place as usize).copied().unwrap_or(0)
    }

    /// The places of the casters that have moved since there were `number` moves, each once.
    pub fn since(&self, number: u64) -> impl Iterator<Item = u32> {
        let newer = self.log.iter().rev().take_while(move |m| m.number > number);
        newer.filter(|m| self.last[m.place as usize] == m.number).map(|m| m.place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_mover_is_told_once_and_the_log_stays_short() {
        let mut moves = Moves::default();
        moves.push(4);
        for i in 0..1000_u32 {
            let before = moves.now();
            moves.push(i % 3);
            moves.push(i % 2);
            let mut told: Vec<u32> = moves.since(before).collect();
            told.sort_unstable();
            let mut expected = vec![i % 3, i % 2];
            expected.sort_unstable();
            expected.dedup();
            assert_eq!(told, expected, "step {i}");
            assert!(moves.log.len() <= 10);
        }
        assert_eq!(moves.since(0).count(), 4, "one never moved");
        assert_eq!(moves.since(moves.now()).count(), 0);
        moves.push(7);
        assert_eq!((moves.since(0).count(), moves.last(7)), (5, moves.now()), "one that came");
    }
}

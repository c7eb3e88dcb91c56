//! Which casters move and which are at rest, as far as one technique has to know.

use crate::casters::{Casters, Places};
use std::collections::VecDeque;

/// Frames without a move after which a caster counts as one at rest.
const REST: usize = 30;

/// The casters that have moved lately.
#[derive(Default)]
pub(super) struct Movers {
    /// Whose they are: [`Casters::version`].
    of: u64,
    /// [`crate::casters::Moves::now`] of the last [`REST`] frames.
    frames: VecDeque<u64>,
    /// Places of those that move.
    pub moving: Vec<u32>,
    set: Places,
    /// Those that moved since the last frame.
    pub moved: Vec<u32>,
    /// Those of them that were at rest before.
    pub started: Vec<u32>,
    /// Counts the times that movers were taken for resting.
    pub rests: u64,
}

impl Movers {
    /// Once a frame. False where these are other casters than in the last.
    pub fn update(&mut self, casters: &Casters) -> bool {
        let now = casters.moves().now();
        let known = self.of == casters.version();
        if !known {
            *self = Self { of: casters.version(), ..Self::default() };
        }
        let seen = self.frames.back().copied().unwrap_or(now);
        self.moved.clear();
        self.moved.extend(casters.moves().since(seen));
        self.started.clear();
        for &place in &self.moved {
            self.set.make_room(place);
            if self.set.insert(place) {
                self.moving.push(place);
                self.started.push(place);
            }
        }
        self.frames.push_back(now);
        if self.frames.len() > REST {
            let long_ago = self.frames.pop_front().unwrap_or(now);
            self.let_rest(|place| casters.moves().last(place) <= long_ago);
        }
        known
    }

    /// True for a caster that moves.
    pub fn has(&self, place: u32) -> bool {
        self.set.has(place)
    }

    /// Takes movers for resting, all that can be at a time and not before they are half of all:
    /// whoever keeps those at rest has to start anew.
    fn let_rest(&mut self, rests: impl Fn(u32) -> bool) {
        let resting = self.moving.iter().filter(|place| rests(**place)).count();
        if resting == 0 || 2 * resting < self.moving.len() {
            return;
        }
        self.rests += 1;
        let set = &mut self.set;
        self.moving.retain(|place| {
            let moves = !rests(*place);
            if !moves {
                set.remove(*place);
            }
            moves
        });
    }
}

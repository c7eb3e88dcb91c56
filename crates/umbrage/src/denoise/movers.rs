//! Spheres around what casters left and where they came, from one frame to the next.

use crate::casters::Casters;
use umbrage_core::Bounds;
use umbrage_core::glam::DVec3;

/// Most casters whose moves are told apart.
pub(super) const MOVERS: usize = 32;

/// What the last frame's casters were.
#[derive(Default)]
pub(super) struct MovedCasters {
    /// Whose they are: [`Casters::version`]; `None` before the first frame.
    of: Option<u64>,
    /// [`crate::casters::Moves::now`] of the last frame.
    seen: u64,
    /// By place, as the last frame had them.
    bounds: Vec<Bounds>,
}

impl MovedCasters {
    /// Middle and radius of spheres around all that moved, came, went or was bent since the last
    /// frame. `None` where anything may have: other casters, too many, or some that a host draws.
    pub fn update(&mut self, casters: &Casters) -> Option<Vec<(DVec3, f64)>> {
        let moves = casters.moves();
        let box_of = |place: usize| casters.placed().get(place).map_or(Bounds::EMPTY, |placed| placed.bounds);
        if self.of != Some(casters.version()) {
            self.of = Some(casters.version());
            self.seen = moves.now();
            self.bounds = (0..casters.placed().len()).map(box_of).collect();
            return None;
        }
        let mut spheres = Vec::new();
        for place in moves.since(self.seen).map(|place| place as usize) {
            if place >= self.bounds.len() {
                self.bounds.resize(place + 1, Bounds::EMPTY);
            }
            let before = std::mem::replace(&mut self.bounds[place], box_of(place));
            spheres.extend([before, self.bounds[place]].iter().filter(|b| !b.is_empty()).map(sphere));
        }
        self.seen = moves.now();
        (spheres.len() <= MOVERS && !casters.has_host_casters()).then_some(spheres)
    }

    /// The next frame knows nothing of this one.
    pub fn forget(&mut self) {
        self.of = None;
    }
}

fn sphere(bounds: &Bounds) -> (DVec3, f64) {
    ((bounds.min + bounds.max) * 0.5, bounds.min.distance(bounds.max) * 0.5)
}

//! Where a filter looks up its map: sets of taps, a different one for neighbouring pixels, or one
//! for all.

mod layout;

use super::{blue_noise::blue_noise, luminance::Luminance, points::square_to_disc};
use crate::material::Texture;
use glam::DVec2;
use layout::{evenly_spread, jittered};

#[cfg(test)]
mod tests;

/// Sets of the patterns that turn or shift one set.
const TURNS: u32 = 64;

/// What the taps fill.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// The disc of radius 1 around the origin.
    Disc,
    /// The square [−1, 1]².
    Square,
    /// x in [−1, 1], y = 0.
    Segment,
}

/// How neighbouring pixels differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// Each pixel of a tile has a set of its own, one jittered tap in each of many strata of equal
    /// area: Uralsky, "Efficient Soft-Edged Shadows Using Pixel Shader Branching", GPU Gems 2,
    /// chapter 17, 2005.
    Stratified,
    /// One evenly spread set, 64 times, turned (disc) or shifted (square, segment) more and more; a
    /// tile of blue noise says which of them a pixel takes, so that the errors of neighbours
    /// cancel.
    Blue,
    /// The same 64 sets. Which of them a pixel takes is left to the shader: interleaved gradient
    /// noise, Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare",
    /// SIGGRAPH 2014.
    Gradient,
    /// All pixels take the same evenly spread set.
    Fixed,
}

/// Sets of taps for one filter.
#[derive(Clone, Debug, PartialEq)]
pub struct TapTable {
    /// Pixels across and down after which the sets repeat; 1 where the shader chooses the set
    /// ([`Pattern::Gradient`]) and where there is only one ([`Pattern::Fixed`]).
    pub tile: u32,
    /// Number of sets.
    pub sets: u32,
    /// Taps in each set.
    pub taps: u32,
    /// Which set each pixel of the tile takes, row by row; `tile`² numbers below `sets`.
    pub set_of_pixel: Vec<u32>,
    /// The taps, set by set: `sets` × `taps` places in the domain.
    pub offsets: Vec<[f32; 2]>,
}

impl TapTable {
    /// Sets of `taps` taps that fill `domain` evenly, in such an order that the first `tests` alone
    /// find out whether there is anything to filter: they are spread along the border of the disc
    /// or the square, one in each of `tests` equal sectors, or over all of the segment. A penumbra
    /// is met at the border first.
    ///
    /// `taps` is at least 1, which is the middle, and `tests` counts as at most `taps`. The sets
    /// repeat every `tile` pixels (at least 1) where `pattern` has tiles; its blue noise takes time
    /// by `tile`⁴. Every call with the same arguments gives the same table.
    pub fn new(pattern: Pattern, domain: Domain, taps: u32, tests: u32, tile: u32) -> Self {
        let (taps, tile) = (taps.max(1), tile.max(1));
        let tests = tests.min(taps);
        let (tile, sets) = match pattern {
            Pattern::Stratified => (tile, tile * tile),
            Pattern::Blue => (tile, TURNS),
            Pattern::Gradient => (1, TURNS),
            Pattern::Fixed => (1, 1),
        };
        let set_of_pixel = match pattern {
            Pattern::Stratified => (0..sets).collect(),
            Pattern::Blue => blue_noise(tile).into_iter().map(|rank| rank * TURNS / (tile * tile)).collect(),
            Pattern::Gradient | Pattern::Fixed => vec![0],
        };
        let set = |index: u32| match (taps, pattern) {
            (1, _) => vec![[0.0; 2]],
            (_, Pattern::Stratified) => jittered(domain, taps, tests, index),
            _ => evenly_spread(domain, taps, tests, f64::from(index) / f64::from(TURNS)),
        };
        let offsets = (0..sets).flat_map(set).map(|tap| tap.map(|x| x as f32)).collect();
        Self { tile, sets, taps, set_of_pixel, offsets }
    }

    /// One set for all pixels: the middles of a grid of `side` × `side` equal cells over `domain`,
    /// row by row; a segment gets as many points along its length. `side` is at least 1.
    pub fn grid(domain: Domain, side: u32) -> Self {
        let side = side.max(1);
        let taps = side * side;
        let middle = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
        let tap = |i: u32| {
            let square = DVec2::new(middle(i % side, side), middle(i / side, side));
            match domain {
                Domain::Disc => square_to_disc(square),
                Domain::Square => square * 2.0 - 1.0,
                Domain::Segment => DVec2::new(middle(i, taps) * 2.0 - 1.0, 0.0),
            }
        };
        let offsets = (0..taps).map(|i| tap(i).as_vec2().to_array()).collect();
        Self { tile: 1, sets: 1, taps, set_of_pixel: vec![0], offsets }
    }

    /// The taps of a square as dense as `texture` is bright; x runs along a row, y up from its last
    /// row. Nothing changes where nothing of it is bright.
    pub fn weighted_by(mut self, texture: &Texture) -> Self {
        let Some(luminance) = Luminance::of(texture) else { return self };
        for tap in &mut self.offsets {
            let [x, y] = tap.map(f64::from);
            let moved = luminance.sample(DVec2::new(x * 0.5 + 0.5, 0.5 - y * 0.5));
            *tap = [(moved.x * 2.0 - 1.0) as f32, (1.0 - moved.y * 2.0) as f32];
        }
        self
    }

    /// The taps of one set; `index` is below `sets`.
    pub fn set(&self, index: u32) -> &[[f32; 2]] {
        let taps = self.taps as usize;
        &self.offsets[index as usize * taps..][..taps]
    }
}

//! Procedural scenes with a registry: the product works with nothing but its own source.
//!
//! A scene is one file with a `const ENTRY` and its line in [`SCENES`]. Light 0 is hard, light 1
//! soft; each file says what its lights are for. Some have a sky besides. Building is
//! deterministic.

mod atrium;
mod city;
mod contact;
mod courtyard;
mod duelling_frusta;
mod kit;
mod lantern;
mod overlap;
mod picket_fence;
mod plinths;
mod primitives;
mod seabed;
mod shapes;
mod tentacles;
mod terrain;
mod tree;

use crate::scene::Scene;

/// A scene that is made by a function.
#[derive(Clone, Copy, Debug)]
pub struct SceneEntry {
    /// What users type.
    pub id: &'static str,
    /// What it is, in a few words.
    pub title: &'static str,
    /// What it is for.
    pub about: &'static str,
    /// Builds it. The argument is the detail: 1 is the normal state, triangles (in the city: boxes)
    /// go about in proportion to it. The range is 0.05 … 4, for the city 0.05 … 64; numbers beyond
    /// are brought into it, and NaN counts as 1.
    pub build: fn(detail: f32) -> Scene,
}

/// All procedural scenes.
pub static SCENES: &[SceneEntry] = &[
    primitives::ENTRY,
    atrium::ENTRY,
    city::ENTRY,
    picket_fence::ENTRY,
    lantern::ENTRY,
    duelling_frusta::ENTRY,
    contact::ENTRY,
    overlap::ENTRY,
    terrain::ENTRY,
    tentacles::ENTRY,
    courtyard::ENTRY,
    seabed::ENTRY,
    plinths::ENTRY,
];

/// The scene called `id`.
pub fn find(id: &str) -> Option<&'static SceneEntry> {
    SCENES.iter().find(|entry| entry.id == id)
}

/// The range of detail of all scenes but the city.
const DETAIL: std::ops::RangeInclusive<f32> = 0.05..=4.0;

#[cfg(test)]
mod tests;

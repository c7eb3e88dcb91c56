//! Low-discrepancy points, and points of every light shape.
//!
//! [`LightSampler`] gives the points that one receiver sees a light through, as the definition of
//! visibility has them; the plain mean of "is this point seen?" over [`lattice`] points is the
//! visibility. [`hard_lights`] replaces a soft light by many hard ones for all receivers at once,
//! [`light_pieces`] a large one by smaller ones.
//! [`TapTable`] has the places where a filter looks up a map.

mod blue_noise;
mod hard_lights;
mod light_pieces;
mod light_sampler;
mod luminance;
mod points;
mod taps;

pub use blue_noise::blue_noise;
pub use hard_lights::hard_lights;
pub use light_pieces::light_pieces;
pub use light_sampler::{LightFrom, LightSampler};
pub use luminance::Luminance;
pub use points::{lattice, rotated, shift, square_to_disc};
pub use taps::{Domain, Pattern, TapTable};

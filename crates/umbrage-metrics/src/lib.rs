//! How far a picture is from the truth: image errors and shadow errors.
//!
//! Pictures of visibility hold the share of a light that each pixel sees, 1 = fully lit. [`score`] compares one with a
//! reference over the pixels of a mask; [`discontinuities`] finds the pixels that no mask should hold, since a
//! rasteriser and a ray tracer may see different surfaces there; [`heat`] draws where the errors are.
//! [`color_scores`] is for finished pictures.

mod color;
mod discontinuity;
mod error;
mod flip;
mod heat;
mod interior;
mod reach;
mod score;
mod ssim;

pub use color::{ColorScores, color_scores};
pub use discontinuity::discontinuities;
pub use error::Error;
pub use heat::heat;
pub use interior::{REACH_PIXELS, interior};
pub use reach::map_reach;
pub use score::{Comparison, Scores, TOLERANCE, score};

//! How far a picture is from the truth: image errors and shadow errors.
//!
//! Pictures of visibility hold the share of a light that each pixel sees, 1 = fully lit. [`score`]
//! compares one with a reference over the pixels of a mask; [`discontinuities`] finds the pixels
//! that no mask should hold, since a rasteriser and a ray tracer may see different surfaces there;
//! [`heat`] draws where the errors are, and [`contacts`] where shadows should touch their casters.
//! [`Flicker`] tells what changes at fixed points of the scene while the camera or the light moves,
//! [`seam`] how much worse shadows are around the borders between maps, and [`aliasing`] how large
//! the texels of maps are on the screen. [`color_scores`] is for finished pictures,
//! [`score_radiance`] for those of radiance.

mod color;
mod contact;
mod contour;
mod discontinuity;
mod error;
mod flicker;
#[cfg(feature = "flip")]
mod flip;
mod footprint;
mod grain;
mod heat;
mod interior;
mod radiance;
mod score;
mod seam;
mod ssim;

pub use color::{ColorScores, color_scores};
pub use contact::contacts;
pub use contour::EdgeOffset;
pub use discontinuity::discontinuities;
pub use error::Error;
pub use flicker::{FixedPoint, Flicker, Frame, fixed_points};
#[cfg(feature = "flip")]
pub use flip::{flip_colors, of_colors as flip_of_colors};
pub use footprint::{Aliasing, aliasing, footprint_colors, map_reach, reach_of, texel_footprint};
pub use heat::heat;
pub use interior::{REACH_PIXELS, interior};
pub use radiance::{RadianceComparison, RadianceScores, luminance, score_radiance};
pub use score::{Comparison, Scores, TOLERANCE, score, standard_error};
pub use seam::{around_borders, seam};

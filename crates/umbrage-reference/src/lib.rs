//! Ray-traced ground truth: the visibility of every kind of light on the CPU.
//!
//! [`Tracer::new`] takes a scene, [`Tracer::geometry`] finds what a camera sees, and
//! [`Tracer::visibility`] computes for each pixel the share of a light that its surface sees past
//! the casting triangles. What visibility is, the scene format specifies; [`closed_form`] holds the
//! formulas that the tracer is tested against. [`PathTracer`] traces the radiance that an
//! environment makes surfaces send. [`Progressive`] traces the same in slices, for
//! windows.

mod bvh;
pub mod closed_form;
mod cutout;
mod geometry;
mod kept;
mod kept_radiance;
mod light_seen;
mod light_view;
mod progressive;
mod radiance;
mod shaft;
mod tracer;
mod triangle;
mod visibility;

pub use geometry::{Geometry, Shown, Surface};
pub use kept::{Kept, Key, SceneKey, Traced};
pub use kept_radiance::KeptRadiance;
pub use light_seen::{Blocker, LightSeen, Spot};
pub use progressive::Progressive;
pub use radiance::{PathTracer, RadianceOptions, RadianceTruth};
pub use tracer::{Hit, Tracer};
pub use visibility::{Options, Truth};

//! From maps to visibility: the uniforms and the full-screen pass.

mod extent;
mod in_eye;
mod layer;
mod lend;
mod pass;
mod phases;
mod pictures;
mod steady;
mod uniforms;
mod variant;

pub(super) use layer::MapLayer;
pub(crate) use pass::{Lookup, LookupInput};
pub(super) use uniforms::SHARED;

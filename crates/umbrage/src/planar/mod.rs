//! Shadows that casters cast on planes: which planes a camera sees, which casters stand between a
//! plane and a light, and the projection through the light that draws them there.
//!
//! For a plane (n, d) and a light l the shadow of p is M p with M = (P·l) I − l Pᵀ (Blinn 1988; ZA
//! 2.2.2, for column vectors). With the height h = n · p + d of p and H of the light that is
//! p − (h / H) l and w = 1 − h / H for a point, w = 1 for parallel light. Heights are computed
//! first, relative to the eye, so that what is near keeps its precision wherever the scene lies.

mod chosen;
mod lit;
mod outline;
mod screen;
mod seen;
mod uniforms;

pub(crate) use chosen::{Chosen, Wanted};
pub(crate) use lit::LitPlane;
pub(crate) use screen::nearest_w;
pub(crate) use uniforms::{Finder, Shadows};

use crate::shader::Shared;

/// What the host has to agree on with the modules of this folder.
pub(crate) const SHARED: &[Shared] = &[uniforms::FINDER, uniforms::SHADOW];

/// Most planes that a light has shadows on, and most that it shines on from behind.
pub(crate) const MOST: usize = 32;

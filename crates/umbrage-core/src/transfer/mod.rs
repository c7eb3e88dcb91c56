//! Baked transfer of radiance: how much of each function of the sky's light reaches a point and
//! leaves it again, towards the eye.
//!
//! For light with coefficients L_i (of [`crate::harmonics`]) a point of transfer T_i sends out the
//! radiance **base colour · Σ L_i T_i**, a plain dot product. So that each factor is in one place:
//!
//! - **1/π is in T**, by whoever bakes it; nobody multiplies with it later.
//! - **The point's own albedo is not in T**: whoever draws multiplies by the base colour, texture
//!   included, once. The albedo of the surfaces that light was reflected by before is in T.
//! - The cosine, its A_l and visibility are in T.
//! - Coefficients are in **world axes**, as the scene stands in the bake. Where the whole scene is
//!   turned by R, the light is turned by R⁻¹.
//!
//! Under a constant sky of 1 a white point that sees all of it sends out 1.

mod baked;
mod points;
mod stored;
mod wanted;

pub use baked::{BakedMesh, Kind, Transfer};
pub use points::{Points, Sides};
pub use stored::{Cluster, Codes, Stored};
pub use wanted::Wanted;

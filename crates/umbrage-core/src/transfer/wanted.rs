//! What whoever works from a baked transfer asks whoever bakes for.

use super::Kind;
use crate::harmonics::Order;

/// A transfer that is wanted of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// n² functions.
    pub order: Order,
    /// What light does on its way.
    pub kind: Kind,
    /// Rays for each point and pass, 1 and up.
    pub rays: u32,
    /// Edges of triangles along the diagonal of the scene, 1 and up: longer ones are cut.
    pub detail: f64,
}

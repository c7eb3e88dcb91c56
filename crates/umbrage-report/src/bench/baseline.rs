//! What times are set against.

use crate::maps::Maps;

/// What the others are set against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Baseline {
    /// One full-screen pass that reads depth and writes visibility.
    Floor,
    /// A depth-only pass over the casters into each of the maps, and one full-screen one-tap pass.
    BareMinimum(Maps),
}

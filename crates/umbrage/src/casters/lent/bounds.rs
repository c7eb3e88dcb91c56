//! Boxes that a host tells.

use crate::error::Error;
use umbrage_core::Bounds;

/// # Errors
/// [`Error::Scene`] for a box that is empty or not finite.
pub(in crate::casters) fn check_bounds(bounds: &Bounds) -> Result<(), Error> {
    if bounds.is_empty() || !bounds.min.is_finite() || !bounds.max.is_finite() {
        let what = "the box around what a host lends is empty or not finite; maps are fitted to it";
        return Err(Error::Scene(what.into()));
    }
    Ok(())
}

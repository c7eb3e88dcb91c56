//! What is looked at beside the pictures themselves.

use crate::app::Lab;
use crate::loupe::Loupe;
use crate::ui::Kept;

/// The loupe, and what is drawn over pictures.
#[derive(Default)]
pub(crate) struct See {
    pub has_loupe: bool,
    pub loupe: Loupe,
    pub kept: Kept,
}

/// What the loupe shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The pixel.
    pub pixel: (u32, u32),
    /// Visibility there by rays.
    pub visibility: f64,
    /// Lit share of the picture of the light.
    pub lit: f64,
    /// Millimetres of half a texel of slope, where the technique has a map there.
    pub bias_mm: Option<f64>,
}

impl Lab {
    /// What the loupe shows; `None` where it is closed or held over nothing.
    pub fn loupe(&self) -> Option<Reading> {
        let (pixel, known) = self.face.see.loupe.known()?;
        let known = known?;
        let bias_mm = known.texel.map(|texel| texel.bias * 1e3);
        Some(Reading { pixel, visibility: known.visibility, lit: known.light.share(), bias_mm })
    }
}

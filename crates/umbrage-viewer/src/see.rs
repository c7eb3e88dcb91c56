//! What is looked at beside the pictures themselves.

use crate::app::Lab;
use crate::background::Background;
use crate::loupe::{Loupe, Maps};
use crate::overlay::{Line, Shapes, What};
use crate::ui::Kept;
use std::sync::Arc;
use umbrage_core::Light;
use umbrage_core::glam::DVec3;

/// The loupe, and what is drawn over pictures.
pub(crate) struct See {
    pub has_loupe: bool,
    pub loupe: Loupe,
    pub kept: Kept,
    /// What an observer sees.
    pub shows: Vec<What>,
    /// The casters, and of which scene they are.
    pub shapes: Option<(u64, Arc<Shapes>)>,
    pub shaping: Background<(u64, Arc<Shapes>)>,
    /// For each pane the lines that were drawn last, and what they depend on.
    pub lines: Vec<Option<(Lines, Arc<Vec<Line>>)>>,
    /// The point that was clicked.
    pub mark: Option<DVec3>,
    /// Where its cross is in each pane.
    pub crosses: Vec<Option<[f32; 2]>>,
}

/// What lines depend on.
#[derive(Clone, PartialEq)]
pub(crate) struct Lines {
    pub version: u64,
    pub light: Light,
    pub maps: Arc<Maps>,
    pub shows: Vec<What>,
    pub aspect: f32,
}

impl Default for See {
    fn default() -> Self {
        Self {
            has_loupe: false,
            loupe: Loupe::default(),
            kept: Kept::default(),
            shows: What::FIRST.into(),
            shapes: None,
            shaping: Background::default(),
            lines: Vec::new(),
            mark: None,
            crosses: Vec::new(),
        }
    }
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

    /// The smallest and the largest number in the picture of a pane, where it is one of numbers and
    /// they are known.
    pub fn extremes(&self, pane: usize) -> Option<[f32; 2]> {
        self.panes.get(pane)?.extremes
    }

    /// Where the cross of the mark is over a pane, points of the window.
    pub fn mark_on(&self, pane: usize) -> Option<[f32; 2]> {
        self.face.see.crosses.get(pane).copied().flatten()
    }

    /// Lines that an observer sees over a pane.
    pub fn line_count(&self, pane: usize) -> usize {
        let lines = self.face.see.lines.get(pane);
        lines.and_then(Option::as_ref).map_or(0, |(_, lines)| lines.len())
    }

    /// The point of the scene that was clicked, metres.
    pub fn mark(&self) -> Option<DVec3> {
        self.face.see.mark
    }
}

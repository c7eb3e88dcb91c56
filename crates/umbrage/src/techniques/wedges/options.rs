//! What the user chooses.

use crate::params::Settings;
use crate::{error::Error, gpu::Gpu};

/// What users type.
pub(super) const ID: &str = "wedges";

/// Checked settings of every way of drawing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Options {
    pub scale: u32,
    /// Milliseconds on the GPU that the light may take, by which the scale is chosen; 0: none.
    pub budget_ms: f64,
    /// The light is split into so many columns and rows.
    pub split: usize,
    /// Shares of discs are looked up.
    pub table: bool,
    pub point_radius: f64,
    /// The host leaves surfaces out of the receivers that cast, such as those that face away.
    pub unseen: bool,
}

impl Options {
    pub fn new(gpu: &Gpu, settings: &Settings) -> Result<Self, Error> {
        let new = Self {
            scale: settings.choice("scale").trim_start_matches("1/").parse().unwrap_or(1),
            budget_ms: settings.float("budget-ms"),
            split: settings.int("split-light") as usize,
            table: settings.choice("coverage") == "table",
            point_radius: settings.float("radius"),
            unseen: settings.choice("unseen") == "on",
        };
        if new.budget_ms > 0.0 && !gpu.has(wgpu::Features::TIMESTAMP_QUERY) {
            let what = "budget-ms on this adapter, which lacks TIMESTAMP_QUERY; set scale instead".into();
            return Err(Error::Unsupported { technique: ID.into(), what });
        }
        Ok(new)
    }

    /// Scales that may come up.
    pub fn scales(&self) -> &'static [u32] {
        match self.scale {
            _ if self.budget_ms > 0.0 => &[1, 2, 4],
            2 => &[2],
            4 => &[4],
            _ => &[1],
        }
    }
}

//! What the user chooses.

use super::INFO;
use super::draws::Draw;
use super::pipelines::Pipelines;
use crate::params::Settings;
use crate::{error::Error, gpu::Gpu};

/// What becomes of casters that hide the same part of the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Combine {
    Sum,
    Max,
}

/// What is drawn in one call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Batch {
    All,
    PerLoop,
    PerWedge,
}

/// Checked settings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Options {
    pub batch: Batch,
    pub combine: Combine,
    /// A stencil mask keeps pixels out that are in no wedge.
    pub stencil: bool,
    pub scale: u32,
    /// Milliseconds on the GPU that the light may take, by which the scale is chosen; 0: none.
    pub budget_ms: f64,
    /// The light is split into so many columns and rows.
    pub split: usize,
    pub point_radius: f64,
    /// The host leaves surfaces out of the receivers that cast, such as those that face away.
    pub unseen: bool,
}

impl Options {
    pub fn new(gpu: &Gpu, settings: &Settings) -> Result<Self, Error> {
        let combine = match settings.choice("combine") {
            "max" => Combine::Max,
            _ => Combine::Sum,
        };
        let batch = match settings.choice("batch") {
            "per-loop" => Batch::PerLoop,
            "per-wedge" => Batch::PerWedge,
            _ => Batch::All,
        };
        let cull = settings.choice("cull");
        let new = Self {
            batch,
            combine,
            stencil: cull == "stencil" || (cull == "auto" && batch == Batch::PerWedge),
            scale: settings.choice("scale").trim_start_matches("1/").parse().unwrap_or(1),
            budget_ms: settings.float("budget-ms"),
            split: settings.int("split-light") as usize,
            point_radius: settings.float("radius"),
            unseen: settings.choice("unseen") == "on",
        };
        new.check(gpu)?;
        Ok(new)
    }

    fn check(&self, gpu: &Gpu) -> Result<(), Error> {
        let refuse = |what: &str| Err(Error::Unsupported { technique: INFO.id.into(), what: what.into() });
        if self.combine == Combine::Max && self.batch != Batch::All {
            return refuse("combine=max with batch, since it draws casters one by one; leave batch out");
        }
        if self.stencil && self.apart() {
            return refuse("cull=stencil with loops or casters one by one; leave cull out");
        }
        if self.stencil && !gpu.has(wgpu::Features::DEPTH_CLIP_CONTROL) {
            return refuse("a stencil mask on this adapter, which lacks DEPTH_CLIP_CONTROL; set cull=shader");
        }
        if self.budget_ms > 0.0 && !gpu.has(wgpu::Features::TIMESTAMP_QUERY) {
            return refuse("budget-ms on this adapter, which lacks TIMESTAMP_QUERY; set scale instead");
        }
        Ok(())
    }

    /// Wedges are cut in two halves.
    pub fn halves(&self) -> bool {
        self.batch == Batch::PerWedge
    }

    /// Silhouettes are listed by the CPU, which draws parts of the list.
    pub fn listed(&self) -> bool {
        self.batch != Batch::All || self.combine == Combine::Max
    }

    /// Wedges that lie close together are drawn as one. Shares of pieces are dear, and each wedge by itself has fewer to find.
    pub fn bundles(&self) -> bool {
        !self.listed() && !self.stencil && self.split == 1
    }

    /// Loops or casters are drawn into a buffer of their own.
    pub fn apart(&self) -> bool {
        self.batch == Batch::PerLoop || self.combine == Combine::Max
    }

    /// Of what is drawn apart, see `draw.wgsl`.
    pub fn apart_format(&self, pipelines: &Pipelines) -> Option<wgpu::TextureFormat> {
        match self.apart() {
            true if self.combine == Combine::Max => Some(pipelines.format),
            true => Some(pipelines.loop_format),
            false => None,
        }
    }

    /// All that may be drawn.
    pub fn draws(&self) -> &'static [Draw] {
        match (self.batch, self.stencil) {
            _ if self.combine == Combine::Max => &[Draw::Sides, Draw::Caps, Draw::Bodies, Draw::Most],
            (Batch::PerLoop, _) => {
                &[Draw::Sides, Draw::Caps, Draw::Bodies, Draw::LoopSides, Draw::LoopBodies, Draw::Loop]
            }
            (Batch::PerWedge, true) => &[Draw::Sides, Draw::Caps, Draw::FrontMask, Draw::MaskedFront, Draw::MaskedBack],
            (Batch::PerWedge, false) => &[Draw::Sides, Draw::Caps, Draw::Front, Draw::Back],
            (Batch::All, true) => &[Draw::Sides, Draw::Caps, Draw::Mask, Draw::MaskedBodies],
            _ if self.bundles() => &[Draw::Sides, Draw::Caps, Draw::Singles, Draw::Bundles],
            (Batch::All, false) => &[Draw::Sides, Draw::Caps, Draw::Bodies],
        }
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

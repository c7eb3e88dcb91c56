//! What the user chooses.

use crate::{Masked, choices, error::Error, gpu::Gpu, settings};

/// What users type.
pub(super) const ID: &str = "wedges";

settings! {
    /// Settings of penumbra wedges.
    pub struct Wedges {
        #[flatten] masked: Masked,
        /// What is drawn at once: all wedges of the light; every caster whose silhouette is one
        /// convex loop, and the others as with `all`; or single wedges, in two halves.
        batch: Batch = Batch::All,
        /// What happens where casters hide the same part of the light: their shares are added, or
        /// the largest one counts.
        combine: Combine = Combine::Sum,
        /// What removes pixels that are in no wedge: the shader, or a stencil mask before it.
        /// `auto` takes the mask for single wedges only.
        cull: Cull = Cull::Auto,
        /// Size of the buffer in which shares are added, relative to the picture.
        scale: Scale = Scale::Whole,
        /// GPU time by which the scale is chosen in every frame; 0 keeps `scale`.
        budget_ms: f64 = 0.0, in 0.0..=1000.0, unit "ms",
        /// Columns and rows into which the light is split, each piece with silhouettes of its own.
        /// A line is split into that many parts.
        split_light: u32 = 1, in 1..=3,
        /// How the share that an edge covers of a sphere, an ellipsoid, a disc or a sun is found:
        /// by a formula, or by two look-ups of 32³ values. Textured rectangles always have a table,
        /// other lights none.
        coverage: Coverage = Coverage::Analytic,
        /// Radius of point and spot lights, which are hard without one.
        radius: f64 = 0.0, in 0.0..=1000.0, unit "m",
        /// For hosts that cull faces or hide casters from the camera: counts all casters from
        /// infinity, with both sides of meshes.
        unseen: bool = false,
    }
}

choices! {
    /// What becomes of casters that hide the same part of the light.
    pub enum Combine {
        /// Their shares add up.
        Sum = "sum",
        /// The largest share counts.
        Max = "max",
    }
}

choices! {
    /// What is drawn in one call.
    pub enum Batch {
        /// All wedges of the light.
        All = "all",
        /// Every caster whose silhouette is one convex loop.
        PerLoop = "per-loop",
        /// One wedge after the other, in two halves.
        PerWedge = "per-wedge",
    }
}

choices! {
    /// Who finds what is in no wedge.
    pub enum Cull {
        /// The stencil for one wedge after the other, else the shader.
        Auto = "auto",
        /// The shader.
        Shader = "shader",
        /// A stencil mask before it.
        Stencil = "stencil",
    }
}

choices! {
    /// Size of the buffer that shares add up in, against the picture.
    pub enum Scale {
        /// The same.
        Whole = "1",
        /// Half as wide and high.
        Half = "1/2",
        /// A quarter as wide and high.
        Quarter = "1/4",
    }
}

choices! {
    /// Where the share that an edge covers comes from.
    pub enum Coverage {
        /// A formula.
        Analytic = "analytic",
        /// Two look-ups in a table.
        Table = "table",
    }
}

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
    /// Casters with alpha masks are looked up in maps.
    pub leaves_masked: bool,
}

impl Options {
    pub fn new(gpu: &Gpu, settings: &Wedges) -> Result<Self, Error> {
        let new = Self {
            scale: match settings.scale {
                Scale::Whole => 1,
                Scale::Half => 2,
                Scale::Quarter => 4,
            },
            budget_ms: settings.budget_ms,
            split: settings.split_light as usize,
            table: settings.coverage == Coverage::Table,
            point_radius: settings.radius,
            unseen: settings.unseen,
            leaves_masked: settings.masked.leaves_out(),
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

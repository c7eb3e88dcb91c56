//! The papers' own ways of drawing wedges, kept to be compared with the one draw: one wedge or one
//! convex loop after the other, casters one by one, and a stencil mask of what is in any body. The
//! default reads none of this; [`way`] is where they hook in.

mod apart;
mod draws;
mod groups;
mod halves;
mod listed;
mod masked;

pub(super) use draws::SHADERS;

use super::options::{Batch, Combine, Cull, ID, Wedges};
use super::pipelines::is_exact;
use super::way::Way;
use crate::{error::Error, gpu::Gpu};
use apart::{Apart, Kind};
use halves::PerWedge;
use masked::Masked;

/// The way that settings ask for; `None` for the one draw.
///
/// # Errors
/// [`Error::Unsupported`] for what does not go together, or needs a feature that the device lacks.
pub(super) fn way(gpu: &Gpu, settings: &Wedges) -> Result<Option<Box<dyn Way>>, Error> {
    let Wedges { batch, cull, combine, .. } = *settings;
    let largest = combine == Combine::Max;
    let stencil = cull == Cull::Stencil || (cull == Cull::Auto && batch == Batch::PerWedge && is_exact(gpu));
    check(gpu, batch, largest, stencil)?;
    Ok(match batch {
        _ if largest => Some(Box::new(Apart::new(gpu, Kind::Largest))),
        Batch::PerLoop => Some(Box::new(Apart::new(gpu, Kind::Loops))),
        Batch::PerWedge => Some(Box::new(PerWedge::new(gpu, stencil))),
        Batch::All => stencil.then(|| Box::new(Masked::new(gpu)) as Box<dyn Way>),
    })
}

fn check(gpu: &Gpu, batch: Batch, largest: bool, stencil: bool) -> Result<(), Error> {
    let refuse = |what: &str| Err(Error::Unsupported { technique: ID.into(), what: what.into() });
    if largest && batch != Batch::All {
        return refuse("combine=max with batch, since it draws casters one by one; leave batch out");
    }
    if stencil && (largest || batch == Batch::PerLoop) {
        return refuse("cull=stencil with loops or casters one by one; leave cull out");
    }
    if stencil && batch == Batch::PerWedge && !is_exact(gpu) {
        return refuse("a stencil mask for single wedges on this adapter, which rasterises coarsely; set cull=shader");
    }
    if stencil && !gpu.has(wgpu::Features::DEPTH_CLIP_CONTROL) {
        return refuse("a stencil mask on this adapter, which lacks DEPTH_CLIP_CONTROL; set cull=shader");
    }
    Ok(())
}

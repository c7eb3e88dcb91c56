//! The texts' own ways of drawing wedges, kept to be compared with the one draw: one wedge or one convex loop after the other,
//! casters one by one, and a stencil mask of what is in any body. The default reads none of this; [`way`] is where they hook in.

mod apart;
mod draws;
mod groups;
mod halves;
mod listed;
mod masked;

pub(super) use draws::SHADERS;

use super::options::ID;
use super::way::Way;
use crate::params::Settings;
use crate::{error::Error, gpu::Gpu};
use apart::{Apart, Kind};
use halves::PerWedge;
use masked::Masked;

/// The way that settings ask for; `None` for the one draw.
///
/// # Errors
/// [`Error::Unsupported`] for what does not go together, or needs a feature that the device lacks.
pub(super) fn way(gpu: &Gpu, settings: &Settings) -> Result<Option<Box<dyn Way>>, Error> {
    let (batch, cull) = (settings.choice("batch"), settings.choice("cull"));
    let largest = settings.choice("combine") == "max";
    let stencil = cull == "stencil" || (cull == "auto" && batch == "per-wedge");
    check(gpu, batch, largest, stencil)?;
    Ok(match batch {
        _ if largest => Some(Box::new(Apart::new(gpu, Kind::Largest))),
        "per-loop" => Some(Box::new(Apart::new(gpu, Kind::Loops))),
        "per-wedge" => Some(Box::new(PerWedge::new(gpu, stencil))),
        _ if stencil => Some(Box::new(Masked::new(gpu))),
        _ => None,
    })
}

fn check(gpu: &Gpu, batch: &str, largest: bool, stencil: bool) -> Result<(), Error> {
    let refuse = |what: &str| Err(Error::Unsupported { technique: ID.into(), what: what.into() });
    if largest && batch != "all" {
        return refuse("combine=max with batch, since it draws casters one by one; leave batch out");
    }
    if stencil && (largest || batch == "per-loop") {
        return refuse("cull=stencil with loops or casters one by one; leave cull out");
    }
    if stencil && !gpu.has(wgpu::Features::DEPTH_CLIP_CONTROL) {
        return refuse("a stencil mask on this adapter, which lacks DEPTH_CLIP_CONTROL; set cull=shader");
    }
    Ok(())
}

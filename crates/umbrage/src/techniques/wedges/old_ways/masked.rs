//! `cull = stencil`: a mask of what is in any body, before the one draw of shares.

use super::super::draws;
use super::super::piece::{Piece, Recording, prepare_draws};
use super::super::pipelines::Pipelines;
use super::super::targets::Target;
use super::super::way::Way;
use super::draws::{MASK, MASKED_BODIES};
use crate::fullscreen::attachment;
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View};

/// See the module.
pub(super) struct Masked {
    format: wgpu::TextureFormat,
}

/// The stencil of a pass starts with 0 and is gone with it.
pub(super) const CLEARED: wgpu::Operations<u32> =
    wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Discard };

/// Depth with a stencil.
pub(super) fn stencil_format(gpu: &Gpu) -> wgpu::TextureFormat {
    if gpu.has(wgpu::Features::DEPTH32FLOAT_STENCIL8) {
        wgpu::TextureFormat::Depth32FloatStencil8
    } else {
        wgpu::TextureFormat::Depth24PlusStencil8
    }
}

impl Masked {
    pub fn new(gpu: &Gpu) -> Self {
        Self { format: stencil_format(gpu) }
    }
}

impl Way for Masked {
    fn depth_format(&self) -> Option<wgpu::TextureFormat> {
        Some(self.format)
    }

    fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View<'_>,
        pieces: &[Piece],
        targets: &[Target],
        pipelines: &mut Pipelines,
    ) -> Result<(), Error> {
        prepare_draws(gpu, view, pieces, targets, &[&draws::SIDES, &draws::CAPS, &MASK, &MASKED_BODIES], pipelines);
        Ok(())
    }

    fn add_up(&self, passes: &mut Passes<'_>, view: &View<'_>, number: usize, piece: &Piece, r: &Recording<'_>) -> u32 {
        let Some(layer) = r.target.layers.get(number) else { return 0 };
        let color = attachment(layer, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
        let mut pass = piece.begin(passes, view, color, Some(CLEARED), r);
        let mut drawn = piece.all_hard(&mut pass, view, r);
        if !piece.form.is_point() {
            drawn += piece.all_bodies(&mut pass, view, &[(&MASK, 0), (&MASKED_BODIES, 0)], r);
        }
        drawn
    }
}

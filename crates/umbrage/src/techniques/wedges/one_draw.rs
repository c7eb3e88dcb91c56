//! All wedges of a piece in one draw, whatever casts the shadows.

use super::cuts::CUTS;
use super::draws::{self, Draw};
use super::piece::{Piece, Recording, prepare_draws};
use super::pipelines::Pipelines;
use super::targets::{BUNDLES, SINGLES, Target};
use super::way::Way;
use crate::fullscreen::attachment;
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View};

/// See the module.
pub(super) struct OneDraw {
    /// Shares of pieces are dear, and each wedge by itself has fewer to find.
    pub is_split: bool,
}

/// Bodies with where the arguments of their draws are.
const WHOLE: &[(&Draw, u64)] = &[(&draws::SINGLES, SINGLES), (&draws::BUNDLES, BUNDLES)];
const SPLIT: &[(&Draw, u64)] = &[(&draws::BODIES, 0)];

impl OneDraw {
    fn bodies(&self) -> &'static [(&'static Draw, u64)] {
        if self.is_split { SPLIT } else { WHOLE }
    }
}

impl Way for OneDraw {
    fn bundles(&self) -> bool {
        !self.is_split
    }

    fn at_once(&self) -> bool {
        false
    }

    fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View<'_>,
        pieces: &[Piece],
        targets: &[Target],
        pipelines: &mut Pipelines,
    ) -> Result<(), Error> {
        let mut used = vec![&draws::SIDES, &draws::CAPS];
        if pieces.iter().any(|piece| !piece.selection.cuts.is_empty()) {
            used.push(&CUTS);
        }
        used.extend(self.bodies().iter().map(|(draw, _)| *draw));
        prepare_draws(gpu, view, pieces, targets, &used, pipelines);
        Ok(())
    }

    fn add_up(&self, passes: &mut Passes<'_>, view: &View<'_>, number: usize, piece: &Piece, r: &Recording<'_>) -> u32 {
        let Some(layer) = r.target.layers.get(number) else { return 0 };
        let clear = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
        let color = attachment(layer, if r.round.is_first { clear } else { wgpu::LoadOp::Load });
        let mut pass = piece.begin(passes, view, color, None, r);
        let mut drawn = piece.all_hard(&mut pass, view, r);
        if !piece.form.is_point() {
            drawn += piece.all_bodies(&mut pass, view, self.bodies(), r);
            if r.round.is_first {
                drawn += piece.cut_casters(&mut pass, view, r);
            }
        }
        drawn
    }
}

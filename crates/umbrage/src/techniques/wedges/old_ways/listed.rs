//! Draws of wedges that the CPU listed.

use super::super::draws::Draw;
use super::super::piece::{BODY_INDICES, Piece, Recording, SIDE_INDICES};
use super::super::records::GROUP;
use crate::view::View;
use std::ops::Range;

/// Corners of a body and of a side, by which vertices are numbered.
pub(super) const BODY_CORNERS: u32 = 6;
const SIDE_CORNERS: u32 = 4;

/// All wedges of a piece.
pub(super) fn all(piece: &Piece) -> Range<u32> {
    0..piece.silhouettes.found().map_or(0, |[sides, ..]| sides)
}

/// Sides or bodies of some wedges, groups of 64 and what is left; gives the number of draws.
pub(super) fn range(
    pass: &mut wgpu::RenderPass<'_>,
    view: &View<'_>,
    piece: &Piece,
    draw: &'static Draw,
    wedges: Range<u32>,
    r: &Recording<'_>,
) -> u32 {
    let Some(pipeline) = r.pipelines.drawing(piece.key(view, draw, r.target)) else { return 0 };
    pass.set_pipeline(pipeline);
    let (indices, corners, each) = match draw.is_body {
        true => (r.body_indices, BODY_CORNERS, BODY_INDICES),
        false => (piece.silhouettes.corner_indices(), SIDE_CORNERS, SIDE_INDICES),
    };
    pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint16);
    let count = wedges.end - wedges.start;
    let (groups, left) = (count / GROUP, count % GROUP);
    let first = |number: u32| (number * corners) as i32;
    let mut drawn = 0;
    if groups > 0 {
        pass.draw_indexed(0..GROUP * each, first(wedges.start), 0..groups);
        drawn += 1;
    }
    if left > 0 {
        pass.draw_indexed(0..left * each, first(wedges.end - left), 0..1);
        drawn += 1;
    }
    drawn
}

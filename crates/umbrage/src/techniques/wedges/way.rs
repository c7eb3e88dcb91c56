//! How the wedges of a light's pieces are drawn: all at once, see `one_draw.rs`, or as the texts
//! do, see `old_ways`.

use super::piece::{Piece, Recording};
use super::pipelines::Pipelines;
use super::targets::Target;
use crate::silhouettes::Extrude;
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View};

/// A way of drawing. Pieces are known by their number, which is that of their layer in the target,
/// too.
pub(super) trait Way: wgpu::WasmNotSend {
    /// Where silhouettes are found.
    fn extrude(&self) -> Extrude {
        Extrude::Compute
    }

    /// Whether wedges that lie close together are put into bundles.
    fn bundles(&self) -> bool {
        false
    }

    /// Whether all wedges of a piece have to be there before the first one is drawn. If not, they
    /// may come in rounds.
    fn at_once(&self) -> bool {
        true
    }

    /// The format of the depth buffer that wedges are drawn against, where it can't be the
    /// receivers' own at any scale.
    fn depth_format(&self) -> Option<wgpu::TextureFormat> {
        None
    }

    /// Makes what the draws of all pieces need in these targets.
    ///
    /// # Errors
    /// [`Error::Size`] beyond the limits.
    fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View<'_>,
        pieces: &[Piece],
        targets: &[Target],
        pipelines: &mut Pipelines,
    ) -> Result<(), Error>;

    /// Adds up what casters cover of a piece, as far as its wedges are built in this round, in its
    /// layer of the target; gives the number of draws.
    fn add_up(&self, passes: &mut Passes<'_>, view: &View<'_>, number: usize, piece: &Piece, r: &Recording<'_>) -> u32;

    /// The shadows that the eye is in and that [`Way::add_up`] leaves to the last pass.
    fn shadows_of_eye(&self, _number: usize, piece: &Piece) -> [u32; 2] {
        piece.shadows_of_eye()
    }

    /// Bytes of GPU memory of its own.
    fn bytes(&self) -> u64 {
        0
    }
}

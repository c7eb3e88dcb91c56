//! Records and sizes that host and shaders share, see `record.wgsl` and `cuts.wgsl`.

use crate::shader::shader_struct;

/// Bytes of the records of a wedge, of a bundle and of a cap.
pub(super) const RECORD: u64 = 304;
pub(super) const BUNDLE_RECORD: u64 = 112;
pub(super) const CAP_RECORD: u64 = 128;

/// Triangles that are looked at together, see `caps.wgsl`.
pub(super) const CHUNK: u32 = 64;

/// Bytes of the caps of a chunk.
pub(super) const CAPS: u64 = CAP_RECORD * CHUNK as u64;

/// Wedges in a bundle.
pub(super) const BUNDLE: u64 = 4;

/// Wedges that an instance draws, and that a workgroup makes.
pub(super) const GROUP: u32 = 64;

/// Wedges that a thread puts into bundles.
pub(super) const WINDOW: u32 = 16;

/// Wedges that are built and drawn at once, and chunks of caps, where the rest can follow in more
/// rounds: a few megabytes, and more than most pictures need. Of a large scene it is this share.
const ROUND: u32 = 1 << 16;
const CAP_ROUND: u32 = 1 << 10;
const ROUND_SHARE: u32 = 16;

/// Numbers of things that buffers have to hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Needs {
    pub wedges: u32,
    /// Chunks of triangles that are drawn.
    pub caps: u32,
}

impl Needs {
    /// As much of it as is built in one round, in bindings of at most `limit` bytes.
    pub fn round(&self, limit: u64) -> Self {
        let wedges = self.wedges.min(ROUND.max(self.wedges / ROUND_SHARE)).next_multiple_of(GROUP);
        let most = (limit / RECORD / u64::from(GROUP)).max(1).min(u64::from(u32::MAX / GROUP)) as u32 * GROUP;
        let caps = self.caps.min(CAP_ROUND.max(self.caps / ROUND_SHARE));
        Self { wedges: wedges.min(most), caps: caps.min((limit / CAPS).max(1).min(u64::from(u32::MAX)) as u32) }
    }

    /// Rounds that build all of it.
    pub fn rounds(&self, round: &Self) -> u32 {
        self.wedges.div_ceil(round.wedges.max(1)).max(self.caps.div_ceil(round.caps.max(1)))
    }
}

/// A part of the wedges and caps of a piece, built and drawn before the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Round {
    pub number: u32,
    /// Nothing was drawn before it.
    pub is_first: bool,
}

shader_struct! {
    /// What a light cuts of a caster, see `cuts.wgsl`.
    pub(in crate::techniques::wedges) struct Cut {
        a: [f32; 4],
        b: [f32; 4],
        c: [f32; 4],
        plane: [f32; 4],
        off: f32,
        is_edge: f32,
        pad: [f32; 2],
    }
}

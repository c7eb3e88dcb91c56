//! Records and sizes that host and shaders share, see `record.wgsl` and `cuts.wgsl`.

use crate::shader::shader_struct;

/// Bytes of the records of a wedge, of a bundle and of a cap.
pub(super) const RECORD: u64 = 304;
pub(super) const BUNDLE_RECORD: u64 = 112;
pub(super) const CAP_RECORD: u64 = 128;

/// Wedges in a bundle.
pub(super) const BUNDLE: u64 = 4;

/// Wedges that an instance draws, and that a workgroup makes.
pub(super) const GROUP: u32 = 64;

/// Wedges that a thread puts into bundles.
pub(super) const WINDOW: u32 = 16;

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

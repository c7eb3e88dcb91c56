//! What a file may claim: beyond these it is refused before memory is taken for it.

/// Bytes of a file, and of all buffers of a model together.
pub(crate) const MOST_BYTES: u64 = 1 << 32;

/// Pixels of a picture.
pub(crate) const MOST_PIXELS: u64 = 1 << 26;

/// Pixels of all pictures of a model together.
pub(crate) const MOST_PIXELS_IN_ALL: u64 = 1 << 28;

/// Numbers that are read out of the accessors of a glTF file.
pub(crate) const MOST_NUMBERS: u64 = 1 << 27;

/// Elements of an accessor without bytes behind them.
pub(crate) const MOST_ZEROS: usize = 1 << 20;

/// Triangles of all meshes of a scene.
pub(crate) const MOST_TRIANGLES: u64 = 1 << 25;

/// Instances of a scene.
pub(crate) const MOST_INSTANCES: usize = 1 << 20;

/// Corners of a polygon that a fan does not fill.
pub(crate) const MOST_CORNERS: usize = 1 << 14;

/// Larger numbers are slips, and their squares leave the range of `f32` that the GPU works with.
pub(crate) const LARGEST: f64 = 1e15;

/// Smaller numbers over 0 are slips, and their squares leave the range of `f32` at its other end.
pub(crate) const SMALLEST: f64 = 1e-15;

/// Something that is used up.
#[derive(Debug)]
pub(crate) struct Budget {
    left: u64,
}

impl Budget {
    pub fn new(most: u64) -> Self {
        Self { left: most }
    }

    /// Takes some of it, if it is there.
    pub fn take(&mut self, amount: u64) -> bool {
        let left = self.left.checked_sub(amount);
        self.left = left.unwrap_or(self.left);
        left.is_some()
    }
}

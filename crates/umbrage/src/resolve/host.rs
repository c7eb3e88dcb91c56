//! What a host has, and what of it a frame uses.

use crate::error::Error;
#[cfg(doc)]
use crate::receivers::Receivers;

/// A host's buffers as they are.
#[derive(Clone, Copy, Debug)]
pub struct HostDepth<'a> {
    /// A view of one layer and level, of the depth alone; with any number of samples a pixel. The
    /// first sample counts, continued along its surface to the middle of the pixel.
    pub depth: &'a wgpu::TextureView,
    /// Packed normals as [`Receivers`] has them, of the same size and with one sample a pixel.
    pub normal: Option<&'a wgpu::TextureView>,
    /// How depth is stored where it is not the depth of the camera's projection.
    pub stored: Option<StoredDepth<'a>>,
}

/// Depth that is stored in a way of the host's own, logarithmic for example.
#[derive(Clone, Copy, Debug)]
pub struct StoredDepth<'a> {
    /// WGSL with a function `view_distance(stored: f32) -> f32`: the distance along the view in
    /// metres of what the buffer holds, 1e30 or more where nothing was drawn.
    pub wgsl: &'a str,
    /// How much coarser distances are than single precision, as a multiple of its steps: 1 for
    /// distances in single precision, the natural logarithm of far over near for a logarithm in
    /// floats. Shadows allow for it.
    pub coarseness: f32,
}

/// What of the buffers is used in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Upper left corner, pixels.
    pub corner: (u32, u32),
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Takes one pixel of four: receivers of half the size, rounded up.
    pub is_half: bool,
}

impl Part {
    /// That it lies in buffers of this size.
    pub(super) fn check(&self, (width, height): (u32, u32)) -> Result<(), Error> {
        let end = |corner: u32, size: u32| u64::from(corner) + u64::from(size);
        let (right, bottom) = (end(self.corner.0, self.size.0), end(self.corner.1, self.size.1));
        if right <= width.into() && bottom <= height.into() {
            return Ok(());
        }
        Err(Error::Lent(format!(
            "the part of the depth buffer ends at {right}, {bottom} and the buffer at {width}, {height}; choose a part of it"
        )))
    }

    /// The upper left `size` of the buffers.
    pub fn of(size: (u32, u32)) -> Self {
        Self { corner: (0, 0), size, is_half: false }
    }

    /// Pixels of the receivers that are made of it.
    pub fn receivers_size(&self) -> (u32, u32) {
        let (width, height) = self.size;
        if self.is_half { (width.div_ceil(2), height.div_ceil(2)) } else { self.size }
    }
}

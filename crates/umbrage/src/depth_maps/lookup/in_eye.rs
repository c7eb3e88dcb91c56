//! What shaders of hosts read in place of the full-screen pass's uniforms, since their receivers
//! are given relative to the eye.

use super::uniforms::MapLookup;
use crate::inline::Lent;
use crate::{gpu::Gpu, passes::Passes};

/// What shaders of hosts read.
pub(super) struct InEye {
    pub uniforms: wgpu::Buffer,
    pub data: MapLookup,
    /// Somebody reads it.
    pub is_lent: bool,
    /// The maps and the view of them that was lent last.
    pub maps: Option<(wgpu::Texture, wgpu::TextureView)>,
    /// What was lent last: without light there is nothing new to lend.
    pub last: Lent,
}

impl InEye {
    pub fn new(gpu: &Gpu) -> Self {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        Self {
            uniforms: gpu.buffer("inline map lookup", &[MapLookup::default()], usage),
            data: MapLookup::default(),
            is_lent: false,
            maps: None,
            last: Lent::LIT,
        }
    }

    pub fn upload(&self, passes: &mut Passes<'_>) {
        if self.is_lent {
            passes.upload(&self.uniforms, bytemuck::bytes_of(&self.data));
        }
    }
}

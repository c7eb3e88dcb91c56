//! The visibility buffer: the one thing every technique writes.

use crate::{error::Error, gpu::Gpu, read};
use umbrage_core::Image;

/// The share of one light that each pixel sees, 0…1, as `R16Float`. PX calls it the LI buffer, SG the V-buffer.
#[derive(Clone, Debug)]
pub struct VisibilityTarget {
    /// The texture; sampled by whoever shades, copied by whoever measures.
    pub texture: wgpu::Texture,
    /// A view of all of it.
    pub view: wgpu::TextureView,
    /// Pixels across and down.
    pub size: (u32, u32),
}

impl VisibilityTarget {
    /// The format: half floats hold 0…1 to within 0.0005.
    pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

    /// A target of `width` × `height`.
    ///
    /// # Errors
    /// [`Error::Size`] for a size of 0 or beyond the adapter's limit.
    pub fn new(gpu: &Gpu, width: u32, height: u32) -> Result<Self, Error> {
        gpu.check_size("a visibility target", width, height)?;
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("visibility"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: Self::FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&Default::default());
        Ok(Self { texture, view, size: (width, height) })
    }

    /// A colour attachment that keeps what a full-screen pass leaves; nothing of the old content is read.
    pub fn overwrite(&self) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        self.attachment(wgpu::LoadOp::Clear(wgpu::Color::WHITE))
    }

    /// A colour attachment that keeps the old content to blend with.
    pub fn keep(&self) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        self.attachment(wgpu::LoadOp::Load)
    }

    fn attachment(&self, load: wgpu::LoadOp<wgpu::Color>) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        Some(wgpu::RenderPassColorAttachment {
            view: &self.view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })
    }

    /// The values, read back: for files and tests, since it waits for the GPU.
    ///
    /// # Errors
    /// [`Error::DeviceLost`] and [`Error::Driver`].
    pub fn read(&self, gpu: &Gpu) -> Result<Image<f32>, Error> {
        read::one_channel(gpu, &self.texture, 0)
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        u64::from(self.size.0) * u64::from(self.size.1) * 2
    }
}

//! The visibility buffer: the one thing every technique writes.

use crate::fullscreen::{attachment, target_texture};
use crate::receivers::{Receivers, check::check_texture};
use crate::{error::Error, gpu::Gpu};

/// The share of one light that each pixel sees, 0…1, as `R16Float`. PX calls it the LI buffer, SG
/// the V-buffer.
#[derive(Clone, Debug)]
pub struct VisibilityTarget {
    /// The texture; sampled by whoever shades, copied by whoever measures.
    pub texture: wgpu::Texture,
    /// A view of its layer.
    pub view: wgpu::TextureView,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Which layer of the texture it is.
    pub(crate) layer: u32,
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
        let texture = target_texture(gpu, "visibility", (width, height), 1, Self::FORMAT);
        let view = texture.create_view(&Default::default());
        Ok(Self { texture, view, size: (width, height), layer: 0 })
    }

    /// A layer of a host's texture: `R16Float` with one sample a pixel that can be drawn to and
    /// read, all of its first level. `Deliver` takes visibility to textures of
    /// other kinds.
    ///
    /// # Errors
    /// [`Error::Lent`] for a texture of another kind, or one without such a layer.
    pub fn of_texture(texture: &wgpu::Texture, layer: u32) -> Result<Self, Error> {
        let size = (texture.width(), texture.height());
        if texture.format() != Self::FORMAT {
            let (found, format) = (texture.format(), Self::FORMAT);
            return Err(Error::Lent(format!(
                "the visibility target is {found:?}; make it {format:?}, or let `Deliver` copy visibility to it"
            )));
        }
        let needed = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        check_texture("visibility target", texture, size, needed)?;
        let layers = texture.depth_or_array_layers();
        if layer >= layers {
            return Err(Error::Lent(format!(
                "the visibility target has {layers} layers; number {layer} is none of them"
            )));
        }
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            mip_level_count: Some(1),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Default::default()
        });
        Ok(Self { texture: texture.clone(), view, size, layer })
    }

    /// That the target is as large as the receivers.
    ///
    /// # Errors
    /// [`Error::Scene`] with both sizes.
    pub fn check(&self, receivers: &Receivers) -> Result<(), Error> {
        same_size("visibility", self.size, receivers.size)
    }

    /// A colour attachment that keeps what a full-screen pass leaves; nothing of the old content is
    /// read.
    pub fn overwrite(&self) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        attachment(&self.view, wgpu::LoadOp::Clear(wgpu::Color::WHITE))
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        u64::from(self.size.0) * u64::from(self.size.1) * 2
    }
}

/// That a target is as large as the receivers.
pub(crate) fn same_size(what: &str, (w, h): (u32, u32), (x, y): (u32, u32)) -> Result<(), Error> {
    if (w, h) == (x, y) {
        return Ok(());
    }
    Err(Error::Scene(format!("the {what} target is {w}×{h} but the receivers are {x}×{y}; make both of one size")))
}

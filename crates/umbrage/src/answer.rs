//! What a technique answers, and the target of the second kind of answer.

use crate::fullscreen::{attachment, target_texture};
use crate::{error::Error, gpu::Gpu, receivers::Receivers, visibility::same_size};

/// What a technique leaves in its target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Answer {
    /// The share of a light that each pixel sees, in a [`crate::VisibilityTarget`]:
    /// [`crate::Prepared::record`].
    #[default]
    Visibility,
    /// The light that leaves what each pixel shows for the eye, in a [`RadianceTarget`]:
    /// [`crate::Prepared::record_radiance`].
    Radiance,
}

impl Answer {
    /// In a word, for messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Visibility => "visibility",
            Self::Radiance => "radiance",
        }
    }

    /// What a technique with this answer says to whoever asks it for the other one.
    pub fn refuse<T>(self) -> Result<T, Error> {
        let other = if self == Self::Visibility { Self::Radiance } else { Self::Visibility };
        let what = format!("pictures of {}, since it answers with {}", other.name(), self.name());
        Err(Error::Unsupported { technique: "this technique".into(), what })
    }
}

/// The light that leaves the surface of each pixel for the eye because of one light, in red, green
/// and blue, as `Rgba16Float`; nothing where nothing is. The shading of the surface is in it. A
/// host adds it to the picture as it is.
#[derive(Clone, Debug)]
pub struct RadianceTarget {
    /// The texture; sampled by whoever adds it to the picture, copied by whoever measures.
    pub texture: wgpu::Texture,
    /// A view of all of it.
    pub view: wgpu::TextureView,
    /// Pixels across and down.
    pub size: (u32, u32),
}

impl RadianceTarget {
    /// The format. The fourth channel means nothing.
    pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

    /// A target of `width` × `height`.
    ///
    /// # Errors
    /// [`Error::Size`] for a size of 0 or beyond the adapter's limit.
    pub fn new(gpu: &Gpu, width: u32, height: u32) -> Result<Self, Error> {
        gpu.check_size("a radiance target", width, height)?;
        let texture = target_texture(gpu, "radiance", (width, height), 1, Self::FORMAT);
        let view = texture.create_view(&Default::default());
        Ok(Self { texture, view, size: (width, height) })
    }

    /// That the target is as large as the receivers.
    ///
    /// # Errors
    /// [`Error::Scene`] with both sizes.
    pub fn check(&self, receivers: &Receivers) -> Result<(), Error> {
        same_size("radiance", self.size, receivers.size)
    }

    /// A colour attachment that keeps what a full-screen pass leaves; nothing of the old content is
    /// read.
    pub fn overwrite(&self) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        attachment(&self.view, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT))
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        u64::from(self.size.0) * u64::from(self.size.1) * 8
    }
}

//! Pictures back from the GPU as futures: for browsers, where nothing may wait. Elsewhere somebody
//! has to poll the device until they are done.
//!
//! All of them give [`Error::DeviceLost`] and [`Error::Driver`]. The copy is submitted when the
//! future is polled for the first time.

use crate::error::Error;
use crate::gpu::{Gpu, arrival};
use crate::{RadianceTarget, VisibilityTarget};
use half::f16;
use umbrage_core::Image;
use umbrage_core::glam::Vec3;

impl VisibilityTarget {
    /// The values, read back.
    ///
    /// # Errors
    /// [`Error::DeviceLost`] and [`Error::Driver`].
    pub async fn read_async(&self, gpu: &Gpu) -> Result<Image<f32>, Error> {
        one_channel(gpu, &self.texture, self.layer).await
    }
}

impl RadianceTarget {
    /// The values, read back.
    ///
    /// # Errors
    /// [`Error::DeviceLost`] and [`Error::Driver`].
    pub async fn read_async(&self, gpu: &Gpu) -> Result<Image<[f32; 3]>, Error> {
        half_colors(gpu, &self.texture).await
    }
}

/// 8-bit colour, as it is stored.
///
/// # Errors
/// See the module.
pub async fn rgba8(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Image<[u8; 4]>, Error> {
    let bytes = rows(gpu, texture, 0).await?;
    Ok(image(texture, bytes.as_chunks::<4>().0.to_vec()))
}

/// Depth or a single float channel, full or half, of a layer.
///
/// # Errors
/// See the module; [`Error::Driver`] for a format of another kind, too.
pub async fn one_channel(gpu: &Gpu, texture: &wgpu::Texture, layer: u32) -> Result<Image<f32>, Error> {
    let bytes = rows(gpu, texture, layer).await?;
    let data = match texture.format() {
        wgpu::TextureFormat::R16Float => halves(&bytes),
        wgpu::TextureFormat::R32Float
        | wgpu::TextureFormat::Depth32Float
        | wgpu::TextureFormat::Depth32FloatStencil8 => {
            bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect()
        }
        other => return Err(Error::Driver(format!("pictures of {other:?} textures can't be read back"))),
    };
    Ok(image(texture, data))
}

/// Red, green and blue of `Rgba16Float`.
///
/// # Errors
/// See the module.
pub async fn half_colors(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Image<[f32; 3]>, Error> {
    let values = halves(&rows(gpu, texture, 0).await?);
    Ok(image(texture, values.as_chunks::<4>().0.iter().map(|&[r, g, b, _]| [r, g, b]).collect()))
}

/// Unit vectors that `pack_normal` packed, see [`crate::wgsl::PACK_NORMAL`].
///
/// # Errors
/// See the module.
pub async fn packed_normals(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Image<[f32; 3]>, Error> {
    let bytes = rows(gpu, texture, 0).await?;
    let unpack = |b: &[u8; 4]| {
        let part = |low, high| f32::from(i16::from_le_bytes([low, high])).max(-32767.0) / 32767.0;
        let (x, y) = (part(b[0] & 0xfe, b[1]), part(b[2], b[3]));
        let z = 1.0 - x.abs() - y.abs();
        let fold = (-z).max(0.0);
        let sign = |v: f32| {
            if v > 0.0 {
                1.0
            } else if v < 0.0 {
                -1.0
            } else {
                0.0
            }
        };
        Vec3::new(x - fold * sign(x), y - fold * sign(y), z).normalize_or_zero().to_array()
    };
    Ok(image(texture, bytes.as_chunks::<4>().0.iter().map(unpack).collect()))
}

fn halves(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks::<2>().0.iter().map(|b| f16::from_le_bytes(*b).to_f32()).collect()
}

fn image<T>(texture: &wgpu::Texture, data: Vec<T>) -> Image<T> {
    Image { width: texture.width(), height: texture.height(), data }
}

/// The texels of a layer without padding between rows.
async fn rows(gpu: &Gpu, texture: &wgpu::Texture, layer: u32) -> Result<Vec<u8>, Error> {
    let (width, height) = (texture.width(), texture.height());
    // Of a format with stencil the depth is read.
    let has_stencil = texture.format().has_stencil_aspect();
    let aspect = if has_stencil { wgpu::TextureAspect::DepthOnly } else { wgpu::TextureAspect::All };
    let texel = texture.format().block_copy_size(Some(aspect)).unwrap_or(4);
    let row = width * texel;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("picture back"),
        size: u64::from(padded) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo { texture, mip_level: 0, origin: wgpu::Origin3d { x: 0, y: 0, z: layer }, aspect },
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None },
        },
        wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
    );
    gpu.queue.submit([encoder.finish()]);
    let (bringer, arrival) = arrival();
    buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| bringer.arrive(result));
    let result = arrival.await;
    gpu.check()?;
    let failed = || Error::Driver("a picture could not be read back".into());
    result.ok_or_else(failed)?.map_err(|_| failed())?;
    let mapped = buffer.slice(..).get_mapped_range().map_err(|_| failed())?;
    let bytes = mapped.chunks(padded as usize).flat_map(|r| &r[..row as usize]).copied().collect();
    Ok(bytes)
}

//! Formats of wgpu as Vulkan calls them; those that pipelines of techniques have.

use anyhow::{Result, bail};
use ash::vk::Format;

pub fn texture(format: wgpu::TextureFormat) -> Result<Format> {
    use wgpu::TextureFormat as F;
    Ok(match format {
        F::R8Unorm => Format::R8_UNORM,
        F::R8Uint => Format::R8_UINT,
        F::Rg8Unorm => Format::R8G8_UNORM,
        F::Rgba8Uint => Format::R8G8B8A8_UINT,
        F::R16Uint => Format::R16_UINT,
        F::R16Unorm => Format::R16_UNORM,
        F::R16Float => Format::R16_SFLOAT,
        F::R32Float => Format::R32_SFLOAT,
        F::R32Uint => Format::R32_UINT,
        F::R32Sint => Format::R32_SINT,
        F::Rg16Uint => Format::R16G16_UINT,
        F::Rg16Unorm => Format::R16G16_UNORM,
        F::Rg16Float => Format::R16G16_SFLOAT,
        F::Rg32Float => Format::R32G32_SFLOAT,
        F::Rg32Uint => Format::R32G32_UINT,
        F::Rgba8Unorm => Format::R8G8B8A8_UNORM,
        F::Rgba8UnormSrgb => Format::R8G8B8A8_SRGB,
        F::Rgba16Uint => Format::R16G16B16A16_UINT,
        F::Rgba16Float => Format::R16G16B16A16_SFLOAT,
        F::Rgba16Unorm => Format::R16G16B16A16_UNORM,
        F::Rgba32Float => Format::R32G32B32A32_SFLOAT,
        F::Rgba32Uint => Format::R32G32B32A32_UINT,
        F::Depth16Unorm => Format::D16_UNORM,
        F::Depth24Plus => Format::X8_D24_UNORM_PACK32,
        F::Depth24PlusStencil8 => Format::D24_UNORM_S8_UINT,
        F::Depth32Float => Format::D32_SFLOAT,
        F::Depth32FloatStencil8 => Format::D32_SFLOAT_S8_UINT,
        F::Stencil8 => Format::S8_UINT,
        other => bail!("formats.rs does not know {other:?}"),
    })
}

pub fn vertex(format: wgpu::VertexFormat) -> Result<Format> {
    use wgpu::VertexFormat as F;
    Ok(match format {
        F::Uint32 => Format::R32_UINT,
        F::Uint32x2 => Format::R32G32_UINT,
        F::Uint32x3 => Format::R32G32B32_UINT,
        F::Uint32x4 => Format::R32G32B32A32_UINT,
        F::Float32 => Format::R32_SFLOAT,
        F::Float32x2 => Format::R32G32_SFLOAT,
        F::Float32x3 => Format::R32G32B32_SFLOAT,
        F::Float32x4 => Format::R32G32B32A32_SFLOAT,
        other => bail!("formats.rs does not know {other:?}"),
    })
}

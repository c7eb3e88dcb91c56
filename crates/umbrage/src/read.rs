//! Pictures back from the GPU. For files and tests; waits for the device, which browsers do not
//! allow. [`later`] has the same as futures, with and without the feature `native`.
//!
//! All of them give [`crate::Error::DeviceLost`] and [`crate::Error::Driver`].

pub mod later;

#[cfg(all(feature = "native", not(target_family = "wasm")))]
pub use now::{half_colors, one_channel, packed_normals, rgba8};

#[cfg(all(feature = "native", not(target_family = "wasm")))]
mod now {
    use super::later;
    use crate::{RadianceTarget, VisibilityTarget, error::Error, gpu::Gpu};
    use umbrage_core::Image;

    /// 8-bit colour, as it is stored.
    ///
    /// # Errors
    /// See the module.
    pub fn rgba8(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Image<[u8; 4]>, Error> {
        gpu.finish(later::rgba8(gpu, texture))
    }

    /// Depth or a single float channel, full or half, of a layer.
    ///
    /// # Errors
    /// See the module; [`Error::Driver`] for a format of another kind, too.
    pub fn one_channel(gpu: &Gpu, texture: &wgpu::Texture, layer: u32) -> Result<Image<f32>, Error> {
        gpu.finish(later::one_channel(gpu, texture, layer))
    }

    /// Red, green and blue of `Rgba16Float`.
    ///
    /// # Errors
    /// See the module.
    pub fn half_colors(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Image<[f32; 3]>, Error> {
        gpu.finish(later::half_colors(gpu, texture))
    }

    /// Unit vectors that `pack_normal` packed, see [`crate::wgsl::PACK_NORMAL`].
    ///
    /// # Errors
    /// See the module.
    pub fn packed_normals(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Image<[f32; 3]>, Error> {
        gpu.finish(later::packed_normals(gpu, texture))
    }

    impl VisibilityTarget {
        /// The values, read back: for files and tests, since it waits for the GPU.
        ///
        /// # Errors
        /// [`crate::Error::DeviceLost`] and [`crate::Error::Driver`].
        pub fn read(&self, gpu: &Gpu) -> Result<Image<f32>, Error> {
            gpu.finish(self.read_async(gpu))
        }
    }

    impl RadianceTarget {
        /// The values, read back: for files and tests, since it waits for the GPU.
        ///
        /// # Errors
        /// [`crate::Error::DeviceLost`] and [`crate::Error::Driver`].
        pub fn read(&self, gpu: &Gpu) -> Result<Image<[f32; 3]>, Error> {
            gpu.finish(self.read_async(gpu))
        }
    }
}

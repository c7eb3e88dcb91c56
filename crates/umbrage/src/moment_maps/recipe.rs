//! What a technique stores of depth, and how.

use crate::fullscreen::FLOATS;
use crate::shader::Shader;

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coding {
    /// Single precision.
    Single,
    /// Half precision.
    Half,
    /// 16 bits from 0 to 1.
    Unorm,
}

/// What a technique stores.
pub(crate) struct Recipe {
    /// The passes, with the technique's `moments_of`.
    pub(crate) passes: Shader,
    /// Numbers a texel: 1, 2 or 4.
    pub(crate) channels: u32,
    pub(crate) coding: Coding,
    /// Pipeline-overridable constants of the passes.
    pub(crate) constants: Vec<(&'static str, f64)>,
}

impl Recipe {
    pub(super) fn format(&self) -> wgpu::TextureFormat {
        use wgpu::TextureFormat as F;
        let of = |[one, two, four]: [F; 3]| match self.channels {
            1 => one,
            2 => two,
            _ => four,
        };
        of(match self.coding {
            Coding::Single => [F::R32Float, F::Rg32Float, F::Rgba32Float],
            Coding::Half => [F::R16Float, F::Rg16Float, F::Rgba16Float],
            Coding::Unorm => [F::R16Uint, F::Rg16Uint, F::Rgba16Uint],
        })
    }

    pub(super) fn sample_type(&self) -> wgpu::TextureSampleType {
        if self.coding == Coding::Unorm { wgpu::TextureSampleType::Uint } else { FLOATS }
    }
}

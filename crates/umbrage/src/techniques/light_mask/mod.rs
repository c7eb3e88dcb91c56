//! A light mask: every point keeps one bit for each sample of the light, and triangles strike them
//! out, so that what casters share counts once.
//!
//! Sources: Schwarz and Stamminger 2007; Sintorn et al. 2008.

mod casters;
mod grown;
mod half_planes;
mod mask;
mod samples;
mod technique;
mod tree;

use crate::casters::Needs;
use crate::settings::Configure;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, FilterId, Gpu, Masked, settings};
use umbrage_core::LightKinds;

settings! {
    /// See the module.
    pub struct LightMask {
        #[flatten] masked: Masked,
        /// Samples of the light, rounded up to a multiple of 32.
        samples: u32 = 256, in 32..=256,
        /// Radius of point and spot lights, which are hard without one.
        radius: f64 = 0.0, in 0.0..=1000.0, unit "m",
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: technique::ID,
    title: "Light mask",
    summary: "Removes what every triangle hides of the light's samples: right for any triangles, wherever casters \
              overlap, as far as the number of samples allows.",
    source: "Schwarz and Stamminger 2007; Sintorn et al. 2008",
    family: Family::AreaLights,
    filter: None,
    lights: LightKinds::ALL,
    casters: Needs::Triangles,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<6>,
    hard: false,
    settings: SettingsOf::new::<LightMask>(),
    views: &[],
    shaders: &[mask::MASK_SHADER],
    readme: include_str!("README.md"),
};

impl Configure for LightMask {
    const INFO: &'static TechniqueInfo = &INFO;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        let mask = technique::LightMask::new(self.samples, self.radius, self.masked.leaves_out());
        Ok(self.masked.beside(gpu, Box::new(mask), FilterId::soft()))
    }
}

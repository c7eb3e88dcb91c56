//! Projected shadows as a filtered texture: soft shadows on planes, sharp at the contact.
//!
//! Sources: ZA A.6, B.3 (`projective fake`); penumbra ratio as in Fernando 2005.

mod draws;
mod planes;
mod technique;

use crate::casters::Needs;
use crate::settings::Configure;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Gpu, choices, settings};
use draws::{CAST_SHADER, LOOKUP_SHADER};
use umbrage_core::LightKinds;

choices! {
    /// How wide shadows are blurred.
    pub enum Softness {
        /// By the light's size and the height of casters.
        Light = "light",
        /// By one radius.
        Fixed = "fixed",
    }
}

settings! {
    /// Settings of filtered projected shadows.
    pub struct ProjectiveFake {
        /// Width and height of each plane's texture.
        size: u32 = 1024, in 1..=16384, unit "texels",
        /// Taps along each side of the grid that averages shadows.
        kernel: u32 = 7, in 1..=32,
        /// How wide shadows are blurred: by the light's size and the height of casters over the
        /// plane, or by one radius everywhere, as in the paper.
        softness: Softness = Softness::Light,
        /// With `softness = fixed`: half the width of the blur; 0 means that the taps are
        /// neighbouring texels.
        radius_m: f64 = 0.0, in 0.0..=100.0, unit "m",
        /// At most this many planes have shadows, with a texture each: the largest on the screen of
        /// those that something may shadow.
        planes: u32 = 4, in 1..=32, unit "planes",
        /// How far off a plane a point may lie and still have the plane's shadows, beyond what
        /// rounding explains. What is no higher than that over a plane casts no shadow on it.
        tolerance: f64 = 0.0, in 0.0..=10.0, unit "m",
        /// Leaves out casters whose shadow falls beside what is seen of a plane, and planes that
        /// have no others.
        cull: bool = true,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "projective-fake",
    title: "Filtered projected shadows",
    summary: "Draws casters through the light into a texture of each flat receiver and blurs it by their height: soft \
              shadows on planes, and none on curved surfaces.",
    source: "ZA A.6, B.3",
    family: Family::Projected,
    filter: None,
    lights: LightKinds::ALL,
    casters: Needs::Triangles,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<2>,
    hard: false,
    settings: SettingsOf::new::<ProjectiveFake>(),
    views: technique::NAMES,
    shaders: &[CAST_SHADER, LOOKUP_SHADER],
    readme: include_str!("README.md"),
};

impl Configure for ProjectiveFake {
    const INFO: &'static TechniqueInfo = &INFO;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        Ok(Box::new(technique::Filtered::new(gpu, self)?))
    }
}

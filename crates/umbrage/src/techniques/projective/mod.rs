//! Planar projected shadows: casters drawn through the light on the planes that receive them, exact
//! to the pixel there.
//!
//! Sources: Blinn 1988; ZA 2.2, A.6, A.9; PX 3.1.

mod draws;
mod technique;
mod views;

use crate::casters::Needs;
use crate::settings::Configure;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Gpu, settings};
use draws::{CAST_SHADER, RESOLVE_SHADER};
use umbrage_core::LightKinds;
use views::VIEWS_SHADER;

settings! {
    /// Settings of projected shadows.
    pub struct Projective {
        /// At most this many planes have shadows: the largest on the screen of those that something
        /// may shadow.
        planes: u32 = 16, in 1..=32, unit "planes",
        /// How far off a plane a point may lie and still have the plane's shadows, beyond what
        /// rounding explains: for floors that are not quite flat. What is no higher than that over
        /// a plane casts no shadow on it.
        tolerance: f64 = 0.0, in 0.0..=10.0, unit "m",
        /// Leaves out casters whose shadow falls beside what is seen of a plane, and planes that
        /// have no others.
        cull: bool = true,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "projective",
    title: "Projected shadows",
    summary: "Draws casters through the light on the flat receivers in view: hard shadows exact to the pixel there, \
              and none on curved surfaces.",
    source: "ZA 2.2, A.6, A.9; PX 3.1",
    family: Family::Projected,
    filter: None,
    lights: LightKinds::ALL,
    casters: Needs::Triangles,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<2>,
    hard: true,
    settings: SettingsOf::new::<Projective>(),
    views: views::NAMES,
    shaders: &[CAST_SHADER, RESOLVE_SHADER, VIEWS_SHADER],
    readme: include_str!("README.md"),
};

impl Configure for Projective {
    const INFO: &'static TechniqueInfo = &INFO;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        Ok(Box::new(technique::Projected::new(gpu, self)))
    }
}

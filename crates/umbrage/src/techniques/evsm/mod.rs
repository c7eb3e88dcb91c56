//! Exponential variance shadow maps: variance shadow maps of depths that an exponential spreads
//! out.
//!
//! Sources: FE 2.3.1; Lauritzen and McCool, "Layered Variance Shadow Maps", 2008, section 3;
//! Lauritzen's thesis, 2008.

mod fixed;
mod soft;

use crate::casters::Needs;
use crate::depth_maps::{BOUNDS_SHADER, Cover, Depth, LAYER_NAMES, LIGHTS, Map, MapSetup, SHADERS};
use crate::moment_maps::Filtering;
use crate::settings::Configure;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Filter, FilterUse, Gpu, choices, settings};

choices! {
    /// What makes penumbras wide.
    pub enum Width {
        /// The filter.
        Fixed = "fixed",
        /// The light's size and the blocker's distance.
        Light = "light",
    }
}

choices! {
    /// Numbers a texel.
    pub enum Components {
        /// For a growing and a falling exponential.
        Four = "4",
        /// For the growing one alone.
        Two = "2",
    }
}

settings! {
    /// See the module.
    pub struct Evsm {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
        #[flatten] filtering: Filtering,
        /// Width of penumbras: that of the filter, or the width that follows from the light's size
        /// and the blocker's distance.
        softness: Width = Width::Fixed,
        /// Numbers for each texel: 4 for a growing and a falling exponential, 2 for the growing one
        /// alone. Only with `softness = fixed`.
        components: Components = Components::Four,
        /// Shares of light up to this value count as none, and the others are stretched. This
        /// removes light that bleeds through.
        bleeding: f64 = 0.1, in 0.0..=0.9,
    }
}

impl Evsm {
    /// Steepness of the growing exponential over half the range of depth. Its square is to stay in
    /// the format's range; and within a filter as wide as `radius` depth changes by more where the
    /// map is coarser, and a steep exponential then sees the nearest of it alone.
    fn growth(&self, size: u32, steepest: f64) -> f64 {
        f64::min(steepest, 0.25 * f64::from(size) / self.filtering.radius.max(1.0))
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "evsm",
    title: "Exponential variance shadow maps",
    summary: "Variance shadow maps of exponentials of depth, which separate receiver and blocker: less light \
              bleeds through.",
    source: "FE 2.3.1",
    family: Family::MomentMaps,
    filter: Some(FilterUse { warped: true }),
    lights: LIGHTS,
    casters: Needs::Depth,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<3>,
    hard: false,
    settings: SettingsOf::new::<Evsm>(),
    views: &LAYER_NAMES,
    shaders: &[
        SHADERS[0],
        SHADERS[1],
        SHADERS[2],
        fixed::PASSES,
        fixed::LOOKUP,
        BOUNDS_SHADER,
        soft::PASSES,
        soft::PASSES_16,
        soft::LOOKUP,
        soft::LOOKUP_16,
    ],
    readme: include_str!("README.md"),
};

impl Configure for Evsm {
    const INFO: &'static TechniqueInfo = &INFO;
    const LENT: bool = true;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        self.make_on(gpu, &self.map.covering(&self.cover, Depth::Projective))
    }

    fn as_filter(&self) -> Option<&dyn Filter> {
        Some(self)
    }

    fn maps(&self) -> Option<MapSetup> {
        Some(self.map.covering(&self.cover, Depth::Projective))
    }
}

impl Filter for Evsm {
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        let make = if self.softness == Width::Light { soft::make } else { fixed::make };
        Ok(Box::new(make(self, gpu, maps)?.with_every_caster()))
    }
}

//! Light-space perspective shadow maps: a perspective across the light and along the view.
//!
//! Sources: Wimmer, Scherzer and Purgathofer, "Light Space Perspective Shadow Maps", 2004; SG
//! "Perspective Shadow Maps".

use crate::casters::Needs;
use crate::depth_maps::{Fitting, Kernel, LAYER_NAMES, LIGHTS, Map, MapSetup, SHADERS, Softness};
use crate::settings::Configure;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, FilterId, Gpu, settings};
use umbrage_core::light_view::Warp;

settings! {
    /// See the module.
    pub struct Lispsm {
        #[flatten] map: Map,
        /// The technique that looks up the maps. It keeps its own defaults, except for the
        /// parameters that are set here.
        filter: FilterId<true> = FilterId::default(),
        /// Kernel of `pcf`.
        kernel: Kernel = Kernel::Hardware,
        /// Strength of the warp: 1 makes the errors of the projection equal near and far, 0 gives a
        /// uniform map.
        strength: f64 = 1.0, in 0.0..=100.0, live true,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "lispsm",
    title: "Light-space perspective shadow map",
    summary: "Warps the depth map by a perspective along the view that makes errors near and far equal.",
    source: "SG \"Perspective Shadow Maps\"; Wimmer et al. 2004",
    family: Family::FittedMaps,
    filter: None,
    lights: LIGHTS,
    casters: Needs::Depth,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<2>,
    hard: false,
    settings: SettingsOf::new::<Lispsm>(),
    views: &LAYER_NAMES,
    shaders: &SHADERS,
    readme: include_str!("README.md"),
};

impl Configure for Lispsm {
    const INFO: &'static TechniqueInfo = &INFO;
    const LENT: bool = true;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        self.filter.make_on(gpu, &self.setup())
    }

    fn maps(&self) -> Option<MapSetup> {
        Some(self.setup())
    }
}

impl Lispsm {
    fn setup(&self) -> MapSetup {
        let warp = Warp::LightSpace { strength: self.strength };
        self.map.fitted(Fitting::Warp(warp), Softness::Texels(self.kernel))
    }
}

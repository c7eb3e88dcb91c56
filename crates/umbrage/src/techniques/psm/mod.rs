//! Perspective shadow maps: the map is taken in post-perspective space, where near things are
//! large.
//!
//! Sources: Stamminger and Drettakis 2002; Kozlov, "Perspective Shadow Maps: Care and Feeding",
//! 2004; SG "Perspective Shadow Maps".

use crate::casters::Needs;
use crate::depth_maps::{Fitting, Kernel, LAYER_NAMES, LIGHTS, Map, MapSetup, SHADERS, Softness};
use crate::settings::Configure;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, FilterId, Gpu, choices, settings};
use umbrage_core::light_view::Warp;

choices! {
    /// How far the virtual camera stands behind the real one.
    pub enum Shift {
        /// As far as makes texels smallest on the screen.
        Auto = "auto",
        /// Not at all.
        Off = "off",
    }
}

settings! {
    /// See the module.
    pub struct Psm {
        #[flatten] map: Map,
        /// The technique that looks up the maps. It keeps its own defaults, except for the
        /// parameters that are set here.
        filter: FilterId<true> = FilterId::default(),
        /// Kernel of `pcf`.
        kernel: Kernel = Kernel::Hardware,
        /// How far the virtual camera is moved back from the real one: to where texels are smallest
        /// on the screen, or not at all.
        shift: Shift = Shift::Auto, live true,
        /// Least distance of the virtual camera's near plane. It lies at the nearest receiver if
        /// that is farther.
        near_plane: f64 = 0.0, in 0.0..=1e12, unit "m", live true,
        /// One map for every side of the post-perspective cube through which rays of the light
        /// leave it, for spots and parallel light.
        cube: bool = false, live true,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "psm",
    title: "Perspective shadow map",
    summary: "Renders the depth map in the space after the projection of a virtual camera: fine texels near the eye.",
    source: "SG \"Perspective Shadow Maps\"",
    family: Family::FittedMaps,
    filter: None,
    lights: LIGHTS,
    casters: Needs::Depth,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<2>,
    hard: false,
    settings: SettingsOf::new::<Psm>(),
    views: &LAYER_NAMES,
    shaders: &SHADERS,
    readme: include_str!("README.md"),
};

impl Configure for Psm {
    const INFO: &'static TechniqueInfo = &INFO;
    const LENT: bool = true;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        self.filter.make_on(gpu, &self.setup())
    }

    fn maps(&self) -> Option<MapSetup> {
        Some(self.setup())
    }
}

impl Psm {
    fn setup(&self) -> MapSetup {
        let shift = self.shift == Shift::Auto;
        let warp = Warp::PostPerspective { shift, near: self.near_plane, cube: self.cube };
        self.map.fitted(Fitting::Warp(warp), Softness::Texels(self.kernel))
    }
}

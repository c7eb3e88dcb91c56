//! The plane-optimal map: no perspective is left between the screen and the map on one plane.
//!
//! Sources: Chong, "Real-Time Perspective Optimal Shadow Maps", 2003; SG "Thesis of Hamilton Yu-Ik
//! Chong".

use crate::casters::Needs;
use crate::depth_maps::{Fitting, Kernel, LAYER_NAMES, LIGHTS, Map, MapSetup, SHADERS, Softness};
use crate::settings::Configure;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, FilterId, Gpu, choices, settings};
use umbrage_core::{glam::DVec4, light_view::Warp};

choices! {
    /// The plane that the map is made for.
    pub enum Plane {
        /// That which most of the picture shows or the ground, whichever is better.
        Auto = "auto",
        /// The level one.
        Level = "level",
    }
}

settings! {
    /// See the module.
    pub struct PlaneOptimal {
        #[flatten] map: Map,
        /// The technique that looks up the maps. It keeps its own defaults, except for the
        /// parameters that are set here.
        filter: FilterId<true> = FilterId::default(),
        /// Kernel of `pcf`.
        kernel: Kernel = Kernel::Hardware,
        /// The plane that the map is optimal for: the better one of the plane that covers most of
        /// the picture and the ground, or the level plane at `height`.
        plane: Plane = Plane::Auto, live true,
        /// Height of the level plane.
        height: f64 = 0.0, in -1e12..=1e12, unit "m", live true,
        /// Warps less than is optimal for the plane where that makes texels smaller in the whole
        /// picture.
        give_way: bool = true, live true,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "plane-optimal",
    title: "Plane-optimal shadow map",
    summary: "Warps the map so that on one plane, such as the ground, all texels have the same size on the screen.",
    source: "SG \"Thesis of Hamilton Yu-Ik Chong\"",
    family: Family::FittedMaps,
    filter: None,
    lights: LIGHTS,
    casters: Needs::Depth,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<2>,
    hard: false,
    settings: SettingsOf::new::<PlaneOptimal>(),
    views: &LAYER_NAMES,
    shaders: &SHADERS,
    readme: include_str!("README.md"),
};

impl Configure for PlaneOptimal {
    const INFO: &'static TechniqueInfo = &INFO;
    const LENT: bool = true;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        self.filter.make_on(gpu, &self.setup())
    }

    fn maps(&self) -> Option<MapSetup> {
        Some(self.setup())
    }
}

impl PlaneOptimal {
    fn setup(&self) -> MapSetup {
        let level = DVec4::Y - DVec4::W * self.height;
        let plane = (self.plane == Plane::Level).then_some(level);
        let warp = Warp::Plane { plane, gives_way: self.give_way };
        self.map.fitted(Fitting::Warp(warp), Softness::Texels(self.kernel))
    }
}

//! Parallel-split shadow maps: what the camera sees is split by distance, and each part has a map of its own.
//!
//! Sources: Zhang et al., "Parallel-Split Shadow Maps for Large-Scale Virtual Environments", 2006; FE 3 and 5; SG "Extensions".

use crate::depth_maps::{
    Blend, Fitting, Kernel, LAYER_NAMES, LIGHTS, Map, MapSetup, SHADERS, SPLIT_FIT_SHADER, Softness, Splits,
};
use crate::settings::Configure;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, FilterId, Gpu, choices, settings};
use umbrage_core::light_view::{Cascades, Cover};

/// Share of a split over which it passes into the next one.
const OVERLAP: f64 = 0.1;

choices! {
    /// What maps cover.
    pub enum Fit {
        /// What a part holds of the receivers.
        Scene = "scene",
        /// The whole part of the view.
        Frustum = "frustum",
    }
}

settings! {
    /// See the module.
    pub struct Cascaded {
        #[flatten] map: Map,
        /// Parts of what the camera sees, each with a map of its own.
        splits: u32 = 4, in 1..=9, live true,
        /// Where the parts end: at uniform (0) or logarithmic (1) distances, or in between.
        lambda: f64 = 0.95, in 0.0..=1.0, live true,
        /// How far along the view shadows go; 0 for the farthest receiver.
        distance: f64 = 0.0, in 0.0..=1e12, unit "m", live true,
        /// The technique that looks the maps up, with its own defaults but for the parameters that are set here.
        filter: FilterId = FilterId::default(),
        /// Of `pcf`, see there.
        kernel: Kernel = Kernel::Hardware,
        /// Radius of `pcf` and `pcf-jitter` in metres, the same in all parts; 0 for their own one in texels. Those of `pcss` follow the light.
        radius_m: f64 = 0.0, in 0.0..=1e6, unit "m",
        /// What maps cover: what a part holds of the receivers (scene-dependent), or the whole part of the view (scene-independent).
        fit: Fit = Fit::Scene, live true,
        /// Splits the range of depths that are really visible, found on the GPU, in place of that of boxes around the receivers.
        depth_fit: bool = false,
        /// Keeps texels where they are in the world when the camera moves or turns, so that edges don't crawl; in place of `fit`.
        stabilize: bool = false, live true,
        /// With `stabilize`: share of a map that the camera may move by before the map changes at all.
        margin: f64 = 0.0, in 0.0..=0.5, live true,
        /// How a part passes into the next one over its last tenth: by mixing both, by a pattern of pixels, or at once.
        blend: Blend = Blend::Lerp,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "cascaded",
    title: "Cascaded shadow maps",
    summary: "Splits what the camera sees by distance and renders a depth map for each part: fine texels near, coarse ones far away.",
    source: "FE 3 to 5; SG \"Extensions\"",
    family: Family::FittedMaps,
    filter: None,
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<3>,
    hard: false,
    settings: SettingsOf::new::<Cascaded>(),
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], SPLIT_FIT_SHADER],
    readme: include_str!("README.md"),
};

impl Configure for Cascaded {
    const INFO: &'static TechniqueInfo = &INFO;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        self.filter.make_on(gpu, &self.setup())
    }

    fn maps(&self) -> Option<MapSetup> {
        Some(self.setup())
    }
}

impl Cascaded {
    pub(crate) fn setup(&self) -> MapSetup {
        let cover = match (self.stabilize, self.fit) {
            (true, _) => Cover::Steady { step_texels: (self.margin * f64::from(self.map.size)).max(1.0) },
            (false, Fit::Frustum) => Cover::Part,
            (false, Fit::Scene) => Cover::Receivers,
        };
        let cascades = Cascades {
            count: self.splits as usize,
            lambda: self.lambda,
            overlap: if self.blend == Blend::Off { 0.0 } else { OVERLAP },
            distance: self.distance,
            cover,
        };
        let softness =
            if self.radius_m > 0.0 { Softness::Metres(self.radius_m) } else { Softness::Texels(self.kernel) };
        let splits = Splits { cascades, blend: self.blend, depth_fit: self.depth_fit };
        self.map.fitted(Fitting::Splits(splits), softness)
    }
}

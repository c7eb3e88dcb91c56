//! Parallel-split shadow maps: what the camera sees is split by distance, and each part has a map
//! of its own.
//!
//! Sources: Zhang et al., "Parallel-Split Shadow Maps for Large-Scale Virtual Environments", 2006;
//! FE 3 and 5; SG "Extensions".

use crate::casters::Needs;
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
        /// Number of splits of the view, each with a map of its own.
        splits: u32 = 4, in 1..=9, live true,
        /// Where the splits end: at uniform distances (0), at logarithmic ones (1), or between the
        /// two.
        lambda: f64 = 0.95, in 0.0..=1.0, live true,
        /// How far along the view there are shadows; 0 means up to the farthest receiver.
        distance: f64 = 0.0, in 0.0..=1e12, unit "m", live true,
        /// The technique that looks up the maps. It keeps its own defaults, except for the
        /// parameters that are set here.
        filter: FilterId = FilterId::default(),
        /// Kernel of `pcf`.
        kernel: Kernel = Kernel::Hardware,
        /// Radius of `pcf` and `pcf-jitter` in metres, the same in all splits; 0 means their own
        /// radius in texels. `pcss` and `pcss-jitter` follow the light.
        radius_m: f64 = 0.0, in 0.0..=1e6, unit "m",
        /// What maps cover: the receivers in a split (scene-dependent), or the whole split
        /// (scene-independent).
        fit: Fit = Fit::Scene, live true,
        /// Splits the range of depths that are visible in this frame, found on the GPU, instead of
        /// the range of boxes around the receivers.
        depth_fit: bool = false,
        /// Keeps texels in place in the world when the camera moves or turns, so that edges do not
        /// crawl. Replaces `fit`.
        stabilize: bool = false, live true,
        /// With `stabilize`: the share of a map by which the camera may move before the map
        /// changes.
        margin: f64 = 0.0, in 0.0..=0.5, live true,
        /// How a split is blended with the next one over its last tenth: by mixing both, by a
        /// pattern of pixels, or not at all.
        blend: Blend = Blend::Lerp,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "cascaded",
    title: "Cascaded shadow maps",
    summary: "Splits the view by distance and renders a depth map for each split: fine texels near, coarse ones \
              far away.",
    source: "FE 3 to 5; SG \"Extensions\"",
    family: Family::FittedMaps,
    filter: None,
    lights: LIGHTS,
    casters: Needs::Depth,
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
    const LENT: bool = true;

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

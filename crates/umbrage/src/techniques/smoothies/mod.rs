//! Smoothies: fins on the silhouettes of casters, drawn into the light's view, that make hard
//! shadows of a map soft outwards.
//!
//! Sources: SG "Rendering Fake Soft Shadows with Smoothies"; Chan and Durand 2003; Wyman and Hansen
//! 2003 (`geometry = cones`).

mod light;
mod stage;
mod targets;

use crate::casters::Needs;
use crate::depth_maps::{
    CONTOUR_SHADER, Cover, EdgePass, LAYER_NAMES, LIGHTS, Map, MapSetup, MapTechnique, SHADERS, Storage,
};
use crate::settings::Configure;
use crate::shader::{Module, Shader};
use crate::silhouettes::FIND_SHADER;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Filter, FilterUse, Gpu, choices, settings};
use light::SmoothieLight;
use stage::SmoothieStage;

const LOOKUP: Shader = Shader::new("smoothies", include_str!("smoothies.wgsl"));

const FINS: Shader = Shader::new("fins", include_str!("fins.wgsl"))
    .with_modules(&[Module { name: "fin_share", source: include_str!("fin_share.wgsl") }])
    .with_layouts(&[SmoothieLight::LAYOUT])
    .with_constants(light::FACES);

choices! {
    /// What stands on a silhouette edge.
    pub enum Geometry {
        /// A fin: at the edge's own distance.
        Smoothies = "smoothies",
        /// Sheets and cones around the light's rim: where the penumbra ends.
        Cones = "cones",
    }
}

choices! {
    /// How many texels decide about a point.
    pub enum Samples {
        /// The four around it, each for itself.
        Four = "2x2",
        /// Its own.
        One = "1",
    }
}

settings! {
    /// See the module.
    pub struct Smoothies {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
        #[flatten] storage: Storage,
        /// What stands on a silhouette edge: fins at the edge's distance, or sheets and cones that
        /// end where the penumbra does.
        geometry: Geometry = Geometry::Smoothies,
        /// Width of the fins; 0 makes them as wide as the light. Under a hard light some texels
        /// hide the steps of the map.
        width: f64 = 0.0, in 0.0..=64.0, unit "texels",
        /// Narrows the penumbra by how near blocker and receiver are. Without it shadows are as
        /// soft at the contact as far away.
        remap: bool = true,
        /// Texels of the map that decide about a point: four, each for itself, or one.
        samples: Samples = Samples::Four,
    }
}

/// Adds the number of the layer to each of these names.
macro_rules! names_by_layer {
    ($($name:literal),*) => {
        [$(concat!($name, "-0"), concat!($name, "-1"), concat!($name, "-2"), concat!($name, "-3"), concat!($name, "-4"),
           concat!($name, "-5"), concat!($name, "-6"), concat!($name, "-7"), concat!($name, "-8")),*]
    };
}

/// The maps and, layer by layer, the depth of the smoothies, and their share of light before and
/// after it is divided by 1 − b/r.
const VIEWS: [&str; 4 * LAYER_NAMES.len()] = names_by_layer!("map", "smoothie-depth", "alpha-before", "alpha");

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "smoothies",
    title: "Smoothies",
    summary: "Draws fins on silhouettes into the light's view: shadows that soften outwards with distance, umbra unchanged.",
    source: "SG \"Rendering Fake Soft Shadows with Smoothies\"",
    family: Family::DepthMaps,
    filter: Some(FilterUse { warped: true }),
    lights: LIGHTS,
    casters: Needs::Edges,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<{ EdgePass::STORAGE_BUFFERS }>,
    hard: false,
    settings: SettingsOf::new::<Smoothies>(),
    views: &VIEWS,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], FIND_SHADER, CONTOUR_SHADER, FINS, LOOKUP],
    readme: include_str!("README.md"),
};

impl Configure for Smoothies {
    const INFO: &'static TechniqueInfo = &INFO;
    const LENT: bool = true;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        self.make_on(gpu, &self.map.covering(&self.cover, self.storage.depth))
    }

    fn as_filter(&self) -> Option<&dyn Filter> {
        Some(self)
    }

    fn maps(&self) -> Option<MapSetup> {
        Some(self.map.covering(&self.cover, self.storage.depth))
    }
}

impl Filter for Smoothies {
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        let remap = ("REMAP", f64::from(u8::from(self.remap)));
        let constants = [("FOUR", f64::from(u8::from(self.samples == Samples::Four))), remap];
        let stage = Box::new(SmoothieStage::new(gpu, self));
        let texels = if self.samples == Samples::Four { 4 } else { 1 };
        // What the receivers are is read from the map, so that all of them have to be in it.
        let maps = MapTechnique::staged(gpu, maps, &LOOKUP, 1.0 + self.width, &constants, Some(stage))?
            .with_every_caster()
            .reading(texels * (4 + 2 + 2));
        Ok(Box::new(if self.width > 0.0 { maps } else { maps.soft() }))
    }
}

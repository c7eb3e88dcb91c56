//! Soft shadow maps for linear lights: from maps of two ends of a light and what each end sees of
//! the borders of the other's shadows, penumbras without samples between.
//!
//! Source: Heidrich, Brabec and Seidel, "Soft Shadow Maps for Linear Lights", 2000; SG "Soft Shadow
//! Maps for Linear Lights".

mod borders;
mod channel;
mod edges;
mod light;
mod lookup;
mod options;
mod pictures;
mod point;
mod skins;
mod steps;
mod technique;
mod uniform;

use crate::casters::Needs;
use crate::depth_maps::{CONTOUR_SHADER, EdgePass, LIGHTS, MapSetup, SHADERS as MAP_SHADERS};
use crate::settings::Configure;
use crate::shader::{Module, Shader};
use crate::silhouettes::FIND_SHADER;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Gpu};
pub use options::{Edges, LinearLight, Shares};

const MODULES: &[Module] = &[
    Module { name: "step_list", source: include_str!("step_list.wgsl") },
    Module { name: "skin", source: include_str!("skin.wgsl") },
];

const FIND: Shader = Shader::new("find steps", include_str!("find_steps.wgsl"))
    .with_modules(MODULES)
    .with_layouts(&[uniform::FindSteps::LAYOUT])
    .with_constants(steps::CONSTANTS);

const STEP_SKINS: Shader = Shader::new("skins of steps", include_str!("step_skins.wgsl"))
    .with_modules(MODULES)
    .with_layouts(&[uniform::PointView::LAYOUT, uniform::LightPoint::LAYOUT, uniform::SkinLayer::LAYOUT])
    .with_constants(skins::CONSTANTS);

const EDGE_SKINS: Shader = Shader::new("skins of edges", include_str!("edge_skins.wgsl"))
    .with_modules(MODULES)
    .with_layouts(&[uniform::PointView::LAYOUT, uniform::LightPoint::LAYOUT, uniform::SkinLayer::LAYOUT])
    .with_constants(edges::CONSTANTS);

const LOOKUP: Shader = Shader::new("linear light", include_str!("linear_light.wgsl"))
    .with_layouts(&[uniform::PointLookup::LAYOUT])
    .with_constants(lookup::CONSTANTS);

const PIECES: Shader = Shader::new("pieces", include_str!("pieces.wgsl"));

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "linear-light",
    title: "Soft shadow maps for linear lights",
    summary: "Maps from the ends of a line light, each with what the other end's shadow borders hide of the light.",
    source: "SG \"Soft Shadow Maps for Linear Lights\"",
    family: Family::DepthMaps,
    filter: None,
    lights: LIGHTS,
    casters: Needs::Edges,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<{ EdgePass::STORAGE_BUFFERS }>,
    hard: false,
    settings: SettingsOf::new::<LinearLight>(),
    views: pictures::NAMES,
    shaders: &[
        MAP_SHADERS[0],
        MAP_SHADERS[1],
        MAP_SHADERS[2],
        FIND,
        STEP_SKINS,
        EDGE_SKINS,
        FIND_SHADER,
        CONTOUR_SHADER,
        LOOKUP,
        PIECES,
    ],
    readme: include_str!("README.md"),
};

impl Configure for LinearLight {
    const INFO: &'static TechniqueInfo = &INFO;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        Ok(Box::new(technique::LinearLight::new(gpu, self)?))
    }

    fn maps(&self) -> Option<MapSetup> {
        Some(self.setup())
    }
}

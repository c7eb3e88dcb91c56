//! Soft shadow volumes: a penumbra wedge for every silhouette edge corrects the hard shadow, all of
//! a light's in one draw.
//!
//! Sources: Assarsson and Akenine-Möller 2003; SG "A Soft Shadow Volume Algorithm"; PX 4, 6 and
//! 7.2.

mod budget;
mod cuts;
mod draws;
mod old_ways;
mod one_draw;
mod options;
mod piece;
mod pipelines;
mod records;
mod select;
mod shaders;
mod stages;
mod tables;
mod targets;
mod technique;
mod views;
mod way;

use crate::casters::Needs;
use crate::settings::Configure;
use crate::shader::Shader;
use crate::silhouettes::FIND_SHADER;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, FilterId, Gpu};
pub use options::{Batch, Combine, Coverage, Cull, Scale, Wedges};
use umbrage_core::LightKinds;

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: options::ID,
    title: "Penumbra wedges",
    summary: "Corrects hard shadow volumes by what every silhouette edge covers of the light: soft shadows without \
              noise, exact where the silhouette is the same from all of the light.",
    source: "PX 4, 6, 7.2; SG \"A Soft Shadow Volume Algorithm\"",
    family: Family::AreaLights,
    filter: None,
    lights: LightKinds::ALL,
    casters: Needs::Edges,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<8>,
    hard: false,
    settings: SettingsOf::new::<Wedges>(),
    views: views::NAMES,
    shaders: SHADERS,
    readme: include_str!("README.md"),
};

impl Configure for Wedges {
    const INFO: &'static TechniqueInfo = &INFO;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        let wedges = Box::new(technique::Wedges::new(gpu, self)?);
        Ok(self.masked.beside(gpu, wedges, FilterId::soft()))
    }
}

const SHADERS: &[Shader] = &[
    FIND_SHADER,
    shaders::MAKE,
    shaders::BUNDLE,
    shaders::CAPS,
    shaders::DRAWS[0],
    shaders::DRAWS[1],
    shaders::DRAWS[2],
    shaders::CUTS[0],
    shaders::CUTS[1],
    shaders::CUTS[2],
    shaders::DEPTH,
    shaders::RESOLVE,
    shaders::RESOLVE_PICTURE,
    shaders::VIEWS,
    shaders::VIEW_BODIES,
    old_ways::SHADERS[0],
    old_ways::SHADERS[1],
    old_ways::SHADERS[2],
    old_ways::SHADERS[3],
    old_ways::SHADERS[4],
];

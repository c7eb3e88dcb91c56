//! Soft shadow volumes: a penumbra wedge for every silhouette edge corrects the hard shadow, all of
//! a light's in one draw.
//!
//! Sources: Assarsson and Akenine-Möller 2003; SG "A Soft Shadow Volume Algorithm"; PX 4, 6 and
//! 7.2.

mod budget;
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

use crate::settings::Configure;
use crate::shader::Shader;
use crate::silhouettes::FIND_SHADER;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Gpu, settings};
pub use options::{Batch, Combine, Coverage, Cull, Scale};
use umbrage_core::LightKinds;

settings! {
    /// See the module.
    pub struct Wedges {
        /// What is drawn at once: all wedges of the light; every caster whose silhouette is one
        /// convex loop, and the others as with `all`; or single wedges, in two halves.
        batch: Batch = Batch::All,
        /// What happens where casters hide the same part of the light: their shares are added, or
        /// the largest one counts.
        combine: Combine = Combine::Sum,
        /// What removes pixels that are in no wedge: the shader, or a stencil mask before it.
        /// `auto` takes the mask for single wedges only.
        cull: Cull = Cull::Auto,
        /// Size of the buffer in which shares are added, relative to the picture.
        scale: Scale = Scale::Whole,
        /// GPU time by which the scale is chosen in every frame; 0 keeps `scale`.
        budget_ms: f64 = 0.0, in 0.0..=1000.0, unit "ms",
        /// Columns and rows into which the light is split, each piece with silhouettes of its own.
        /// A line is split into that many parts.
        split_light: u32 = 1, in 1..=3,
        /// How the share that an edge covers of a sphere, an ellipsoid, a disc or a sun is found:
        /// by a formula, or by two look-ups of 32³ values. Textured rectangles always have a table,
        /// other lights none.
        coverage: Coverage = Coverage::Analytic,
        /// Radius of point and spot lights, which are hard without one.
        radius: f64 = 0.0, in 0.0..=1000.0, unit "m",
        /// For hosts that cull faces or hide casters from the camera: counts all casters from
        /// infinity, with both sides of meshes.
        unseen: bool = false,
    }
}

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
        Ok(Box::new(technique::Wedges::new(gpu, self)?))
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

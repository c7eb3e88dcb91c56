//! Percentage-closer filtering, blurred on the screen: soft edges for two cheap passes, and a halo
//! unless the blur keeps to the surfaces.
//!
//! Sources: ZA 3.3; Shastry, "Soft-Edged Shadows", 2005; weights by surface after Tomasi and
//! Manduchi 1998.

mod blur;
mod technique;
mod tiles;

use crate::casters::Needs;
use crate::depth_maps::{Cover, LAYER_NAMES, LIGHTS, Map, MapSetup, MapTechnique, SHADERS, Storage};
use crate::settings::Configure;
use crate::shader::{Module, Shader};
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Filter, FilterUse, Gpu, choices, settings};
use blur::{Blur, ScreenBlur};
use technique::Blurred;

const SOURCE_SHADER: Shader = Shader::new("pcf-blur source", include_str!("source.wgsl"));

const MODULES: &[Module] = &[
    Module { name: "head", source: include_str!("head.wgsl") },
    Module { name: "quads", source: include_str!("quads.wgsl") },
    Module { name: "blur", source: include_str!("blur.wgsl") },
];

const fn shader(name: &'static str, source: &'static str) -> Shader {
    let constants = &[("OWN_SHADOW", OWN_SHADOW)];
    Shader::new(name, source).with_modules(MODULES).with_layouts(&[Blur::LAYOUT]).with_constants(constants)
}

const TILES_SHADER: Shader = shader("pcf-blur tiles", include_str!("tiles.wgsl"));
const ROWS_SHADER: Shader = shader("pcf-blur rows", include_str!("rows.wgsl"));
const COLUMNS_SHADER: Shader = shader("pcf-blur columns", include_str!("columns.wgsl"));
const RESULT_SHADER: Shader = shader("pcf-blur result", include_str!("result.wgsl"));

/// What the source draws where a surface faces away from the light, for the blur to know: next to
/// no light in place of none. As in `head.wgsl`.
const OWN_SHADOW: f64 = 6.103515625e-5;

choices! {
    /// What is blurred.
    pub enum Source {
        /// Percentage-closer filtering with 3×3 compares.
        Square3 = "3",
        /// One compare.
        Hard = "hard",
    }
}

settings! {
    /// See the module.
    pub struct PcfBlur {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
        #[flatten] storage: Storage,
        /// What is blurred: percentage-closer filtering with 3×3 comparisons, or a single
        /// comparison.
        source: Source = Source::Square3,
        /// Radius of the blur, two standard deviations.
        radius: f64 = 3.0, in 0.0..=64.0, unit "pixels",
        /// Blurs only along a surface. Without it, light and shadow of one surface bleed into
        /// surfaces behind or in front of it on the screen.
        depth_aware: bool = true,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "pcf-blur",
    title: "Blurred percentage-closer filtering",
    summary: "Blurs the picture of the shadow along the visible surfaces: soft edges of constant width on the screen.",
    source: "ZA 3.3",
    family: Family::DepthMaps,
    filter: Some(FilterUse { warped: true }),
    lights: LIGHTS,
    casters: Needs::Depth,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<3>,
    hard: false,
    settings: SettingsOf::new::<PcfBlur>(),
    views: &LAYER_NAMES,
    shaders: &[
        SHADERS[0],
        SHADERS[1],
        SHADERS[2],
        SOURCE_SHADER,
        TILES_SHADER,
        ROWS_SHADER,
        COLUMNS_SHADER,
        RESULT_SHADER,
    ],
    readme: include_str!("README.md"),
};

impl Configure for PcfBlur {
    const INFO: &'static TechniqueInfo = &INFO;

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

impl Filter for PcfBlur {
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        let is_hard = self.source == Source::Hard;
        let reach = if is_hard { 0.5 } else { 2.0 };
        let constants = [("IS_HARD", f64::from(u8::from(is_hard))), ("OWN_SHADOW", OWN_SHADOW)];
        let source = MapTechnique::new(gpu, maps, &SOURCE_SHADER, reach, &constants)?;
        let blur = (self.radius > 0.0).then(|| ScreenBlur::new(gpu, self.radius, self.depth_aware));
        Ok(Box::new(Blurred::new(Box::new(source), blur)))
    }
}

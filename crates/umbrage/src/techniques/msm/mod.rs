//! Moment shadow maps: four moments of depth and the sharpest bound that they give.
//!
//! Source: Peters and Klein, "Moment Shadow Mapping", 2015.

use crate::casters::Needs;
use crate::depth_maps::{Cover, Depth, LAYER_NAMES, LIGHTS, Map, MapSetup, MapTechnique, SHADERS};
use crate::moment_maps::{Coding, Filtering, MomentStage, Recipe};
use crate::settings::Configure;
use crate::shader::{Module, Shader};
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Filter, FilterUse, Gpu, settings};

const MODULES: &[Module] = &[
    Module { name: "moments", source: include_str!("moments.wgsl") },
    Module { name: "msm", source: include_str!("msm.wgsl") },
];

const fn shader(name: &'static str, needs: &'static str) -> Shader {
    Shader::new(name, needs).with_modules(MODULES)
}

const PASSES: Shader = shader("msm moments", "// needs: moments_passes, moments_float, moments");
const PASSES_16: Shader = shader("msm moments, 16 bits", "// needs: moments_passes, moments_unorm, moments");
const LOOKUP: Shader = shader("msm", "// needs: msm, moments_float");
const LOOKUP_16: Shader = shader("msm, 16 bits", "// needs: msm, moments_unorm");

settings! {
    /// See the module.
    pub struct Msm {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
        #[flatten] filtering: Filtering,
        /// Shares of light up to this value count as none, and the others are stretched. This
        /// removes light that bleeds through.
        bleeding: f64 = 0.1, in 0.0..=0.9,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "msm",
    title: "Moment shadow maps",
    summary: "Filters four powers of depth and takes the sharpest bound that they give on the share of light.",
    source: "beyond: Peters and Klein 2015",
    family: Family::MomentMaps,
    filter: Some(FilterUse { warped: true }),
    lights: LIGHTS,
    casters: Needs::Depth,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<2>,
    hard: false,
    settings: SettingsOf::new::<Msm>(),
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], PASSES, PASSES_16, LOOKUP, LOOKUP_16],
    readme: include_str!("README.md"),
};

impl Configure for Msm {
    const INFO: &'static TechniqueInfo = &INFO;
    const LENT: bool = true;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        self.make_on(gpu, &self.map.covering(&self.cover, Depth::Projective))
    }

    fn as_filter(&self) -> Option<&dyn Filter> {
        Some(self)
    }

    fn maps(&self) -> Option<MapSetup> {
        Some(self.map.covering(&self.cover, Depth::Projective))
    }
}

impl Filter for Msm {
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        let half = self.filtering.is_half();
        let (passes, lookup, coding) =
            if half { (PASSES_16, LOOKUP_16, Coding::Unorm) } else { (PASSES, LOOKUP, Coding::Single) };
        let recipe = Recipe { passes, channels: 4, coding, constants: Vec::new() };
        let stage = MomentStage::new(gpu, maps.size, &self.filtering, &recipe);
        let (reach, bytes) = (stage.reach(), stage.lookup_bytes());
        let constants = [
            ("MIPS", f64::from(u8::from(self.filtering.mips))),
            ("BLEEDING", self.bleeding),
            ("MOMENT_BIAS", if half { 6e-5 } else { 1e-5 }),
        ];
        let maps = MapTechnique::staged(gpu, maps, &lookup, reach, &constants, Some(Box::new(stage)))?;
        Ok(Box::new(maps.with_every_caster().reading(bytes)))
    }
}

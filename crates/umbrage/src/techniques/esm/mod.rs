//! Exponential shadow maps: an exponential falls off behind the blocker in place of a step.
//!
//! Source: Annen, Mertens, Seidel, Flerackers and Kautz, "Exponential Shadow Maps", 2008.

use crate::casters::Needs;
use crate::depth_maps::{Cover, Depth, LAYER_NAMES, LIGHTS, Map, MapSetup, MapTechnique, SHADERS};
use crate::moment_maps::{Coding, Filtering, MomentStage, Recipe};
use crate::settings::Configure;
use crate::shader::{Module, Shader};
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Filter, FilterUse, Gpu, settings};

const MODULES: &[Module] = &[
    Module { name: "moments", source: include_str!("moments.wgsl") },
    Module { name: "esm", source: include_str!("esm.wgsl") },
];

const fn shader(name: &'static str, needs: &'static str) -> Shader {
    Shader::new(name, needs).with_modules(MODULES)
}

const PASSES: Shader = shader("esm moments", "// needs: moments_passes, moments_float, moments");
const PASSES_16: Shader = shader("esm moments, 16 bits", "// needs: moments_passes, moments_unorm, moments");
const LOOKUP: Shader = shader("esm", "// needs: esm, moments_float");
const LOOKUP_16: Shader = shader("esm, 16 bits", "// needs: esm, moments_unorm");

settings! {
    /// See the module.
    pub struct Esm {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
        #[flatten] filtering: Filtering,
        /// How steeply light falls off behind a blocker, over the range of depth.
        exponent: f64 = 400.0, in 1.0..=2000.0,
        /// Shares of light up to this value count as none, and the others are stretched. This
        /// removes light that bleeds through.
        bleeding: f64 = 0.1, in 0.0..=0.9,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "esm",
    title: "Exponential shadow maps",
    summary: "Filters exponentials of depth, which fall off steeply behind a blocker.",
    source: "beyond: Annen et al. 2008",
    family: Family::MomentMaps,
    filter: Some(FilterUse { warped: true }),
    lights: LIGHTS,
    casters: Needs::Depth,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<2>,
    hard: false,
    settings: SettingsOf::new::<Esm>(),
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], PASSES, PASSES_16, LOOKUP, LOOKUP_16],
    readme: include_str!("README.md"),
};

impl Configure for Esm {
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

impl Filter for Esm {
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        let exponent = ("EXPONENT", self.exponent);
        let half = self.filtering.is_half();
        let (passes, lookup, coding) =
            if half { (PASSES_16, LOOKUP_16, Coding::Unorm) } else { (PASSES, LOOKUP, Coding::Single) };
        let recipe = Recipe { passes, channels: 1, coding, constants: vec![exponent] };
        let stage = MomentStage::new(gpu, maps.size, &self.filtering, &recipe);
        let (reach, bytes) = (stage.reach(), stage.lookup_bytes());
        let constants = [("MIPS", f64::from(u8::from(self.filtering.mips))), ("BLEEDING", self.bleeding), exponent];
        let maps = MapTechnique::staged(gpu, maps, &lookup, reach, &constants, Some(Box::new(stage)))?;
        Ok(Box::new(maps.with_every_caster().reading(bytes)))
    }
}

//! Percentage-closer filtering: compares first, then averages.
//!
//! Sources: Reeves, Salesin and Cook 1987; ZA 3.2; FE 2.3.1.

use crate::casters::Needs;
use crate::depth_maps::{Cover, Kernel, LAYER_NAMES, LIGHTS, Map, MapSetup, MapTechnique, SHADERS, Softness, Storage};
use crate::settings::Configure;
use crate::shader::Shader;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Filter, FilterUse, Gpu, settings};

const SHADER: Shader = Shader::new("pcf", include_str!("pcf.wgsl"));

settings! {
    /// See the module.
    pub struct Pcf {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
        #[flatten] storage: Storage,
        /// Which comparisons are averaged: a square of 3×3, 5×5 or 7×7 bilinear ones, the 2×2
        /// texels of one hardware comparison, 4×4 texels by a bicubic B-spline, or a Vogel disc.
        kernel: Kernel = Kernel::Square3,
        /// Comparisons of the disc.
        taps: u32 = 16, in 1..=1024,
        /// Radius of the disc.
        radius: f64 = 2.5, in 0.0..=64.0, unit "texels",
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "pcf",
    title: "Percentage-closer filtering",
    summary: "Averages many comparisons with a depth map around each point: soft edges of constant width.",
    source: "ZA 3.2; FE 2.3.1",
    family: Family::DepthMaps,
    filter: Some(FilterUse { warped: true }),
    lights: LIGHTS,
    casters: Needs::Depth,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<2>,
    hard: false,
    settings: SettingsOf::new::<Pcf>(),
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], SHADER],
    readme: include_str!("README.md"),
};

impl Configure for Pcf {
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

impl Filter for Pcf {
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        let kernel = match maps.softness {
            Softness::Own => self.kernel,
            Softness::Texels(kernel) => kernel,
            // Squares are whole texels wide; a softness in metres is not.
            Softness::Metres(_) => Kernel::Disc,
        };
        let side = match kernel {
            Kernel::Hardware => 2,
            Kernel::Square3 => 3,
            Kernel::Square5 => 5,
            Kernel::Square7 => 7,
            Kernel::Bicubic => 4,
            Kernel::Disc => 0,
        };
        let reach = if side == 0 { self.radius + 1.0 } else { 0.5 * f64::from(side) + 0.5 };
        let constants = [("KERNEL", f64::from(side)), ("TAPS", f64::from(self.taps)), ("RADIUS", self.radius)];
        // A bilinear comparison reads four texels; squares of them share most.
        let texels: u32 = match side {
            0 => 4 * self.taps,
            2 | 4 => side * side,
            _ => (side + 1) * (side + 1),
        };
        Ok(Box::new(MapTechnique::new(gpu, maps, &SHADER, reach, &constants)?.reading(4 * u64::from(texels))))
    }
}

//! Precomputed radiance transfer: what every vertex sends out for each function of the sky's light
//! was baked, and a frame adds up the products (Sloan, Kautz, Snyder 2002).
//!
//! Source: SG "Precomputed Radiance Transfer"; the conventions are those of
//! [`umbrage_core::transfer`]. A host hands the transfer over by [`Technique::take_transfer`].

mod baked;
mod batches;
mod fits;
mod lights;
mod pipelines;
mod sky;
mod technique;
mod upload;

use crate::casters::Needs;
use crate::settings::Configure;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Answer, Error, Gpu, choices, settings};
use umbrage_core::harmonics::{self, Order};
use umbrage_core::transfer::{Kind, Wanted};
use umbrage_core::{LightKind, LightKinds};

choices! {
    /// What light does on its way to a point.
    pub enum Transferred {
        /// Surfaces block it.
        Shadowed = "shadowed",
        /// Nothing is in its way.
        Unshadowed = "unshadowed",
        /// Surfaces block it and reflect it again.
        Interreflected = "interreflected",
    }
}

choices! {
    /// What high bands of the light are multiplied by.
    pub enum Window {
        /// Nothing.
        None = "none",
        /// (1 + cos(π l / n)) / 2.
        Hanning = "hanning",
        /// sin(π l / n) / (π l / n).
        Lanczos = "lanczos",
    }
}

settings! {
    /// See the module.
    pub struct Prt {
        /// The sky's light is n² functions: 25 at order 5. More of them show harder shadows.
        order: u32 = 5, in 1..=10,
        /// What light does on its way from the sky: surfaces block it, or nothing does, or they
        /// reflect it again, too.
        transfer: Transferred = Transferred::Shadowed,
        /// How often light is reflected before the surface that is seen, where it is.
        bounces: u32 = 2, in 0..=64,
        /// Rays of the bake for each vertex and pass.
        bake_samples: u32 = 256, in 1..=65536,
        /// Edges of triangles along the diagonal of the scene; the bake cuts longer ones, so that
        /// coarse meshes show shadows.
        detail: f64 = 64.0, in 1.0..=4096.0,
        /// Damps the light's high bands: a hard light rings less and is blurred more.
        window: Window = Window::None,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "prt",
    title: "Precomputed radiance transfer",
    summary: "Surfaces under a sky that may turn and change every frame: baked transfer times the light, vertex by vertex.",
    source: "SG \"Precomputed Radiance Transfer\"; Sloan, Kautz, Snyder 2002",
    family: Family::Baked,
    filter: None,
    lights: LightKinds::of(&[LightKind::Environment]),
    casters: Needs::Triangles,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<{ pipelines::STORAGE_BUFFERS }>,
    hard: false,
    settings: SettingsOf::new::<Prt>(),
    views: &[],
    shaders: &pipelines::SHADERS,
    readme: include_str!("README.md"),
};

impl Configure for Prt {
    const INFO: &'static TechniqueInfo = &INFO;
    const ANSWER: Answer = Answer::Radiance;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        Ok(Box::new(technique::Transferring::new(gpu, self.wanted(), self.window.into())))
    }

    fn wants(&self) -> Option<Wanted> {
        Some(self.wanted())
    }
}

impl Prt {
    /// What is to be baked for these settings.
    pub fn wanted(&self) -> Wanted {
        Wanted {
            order: Order::new(self.order).unwrap_or_default(),
            kind: match self.transfer {
                Transferred::Unshadowed => Kind::Unshadowed,
                Transferred::Shadowed => Kind::Shadowed,
                Transferred::Interreflected => Kind::Interreflected { bounces: self.bounces },
            },
            rays: self.bake_samples,
            detail: self.detail,
        }
    }
}

impl From<Window> for harmonics::Window {
    fn from(window: Window) -> Self {
        match window {
            Window::None => Self::None,
            Window::Hanning => Self::Hanning,
            Window::Lanczos => Self::Lanczos,
        }
    }
}

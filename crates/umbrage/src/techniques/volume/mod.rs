//! Stencil shadow volumes: exact hard shadows by counting how many shadows each visible point is
//! in.
//!
//! Sources: Crow 1977; Heidmann 1991; PX 3.2–3.4, 5; SG "Practical and Robust Stenciled Shadow
//! Volumes"; ZA 2.4; GG 9. Multiplicity of edges: Bergeron 1986; Aldridge and Woods 2004; Kim 2008.

mod counter;
mod depth;
mod options;
mod pipelines;
mod plan;
mod select;
mod situation;
mod technique;
mod views;

use crate::settings::Configure;
use crate::shader::Shader;
pub use crate::silhouettes::Extrude;
use crate::silhouettes::FIND_SHADER;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Gpu, Passes, View, VisibilityTarget, settings};
pub use options::{Count, Counter, Culls, Parallel, Reach, Stencil};
use std::any::Any;
use umbrage_core::LightKinds;

const COUNT_SHADER: Shader = Shader::new("volumes", include_str!("count.wgsl"));

const RESOLVE_SHADER: Shader = Shader::new("volume visibility", include_str!("resolve.wgsl"));

const DEPTH_SHADER: Shader =
    Shader::new("volume depth", include_str!("depth.wgsl")).with_layouts(&[depth::DepthBounds::LAYOUT]);

const VIEWS_SHADER: Shader = Shader::new("views of volumes", include_str!("views.wgsl"));

const VIEW_BASE_SHADER: Shader =
    Shader::new("views of volumes, base", include_str!("view_base.wgsl")).with_layouts(&[views::ViewBase::LAYOUT]);

const PLAN_SHADER: Shader = Shader::new("plan of casters", include_str!("plan.wgsl"));

settings! {
    /// See the module.
    pub struct Volume {
        /// Where counting the shadows of a point starts: at the eye, with the number of shadows
        /// that the eye is in (`z-pass-eye`); at the eye where a caster cannot shadow it, otherwise
        /// at infinity (`auto`); at infinity (`z-fail`); at the eye, with 0 (`z-pass`, wrong where
        /// the eye is in shadow); or only whether the number is odd (`xor`, wrong where shadows
        /// overlap).
        count: Count = Count::ZPassEye,
        /// Where silhouettes are found: in compute shaders, in vertex shaders that visit every
        /// edge, or on the CPU.
        extrude: Extrude = Extrude::Compute,
        /// What counts: 8 bits of stencil, which take 256 shadows on one point for none; floats,
        /// which hold any number; or stencil where the casters cannot have 256 layers, and floats
        /// elsewhere.
        counter: Counter = Counter::Auto,
        /// Whether the stencil counts front and back faces in one pass or in two.
        stencil: Stencil = Stencil::TwoSided,
        /// Where shadows end: behind everything visible, nowhere, or where the light does (the
        /// picture is the same, visibility beyond the light's range is not).
        reach: Reach = Reach::Scene,
        /// What is left out because it changes nothing: everything that can be, nothing, or one
        /// kind: casters that the light does not reach, casters that shadow nothing in view, caps
        /// out of view, or pixels beyond the light (the light's range matters with `reach =
        /// finite`).
        cull: Culls = Culls::All,
        /// Counts nothing at points beyond the light's range, at the cost of one more pass over the
        /// depth (`reach = finite`).
        depth_bounds: bool = false,
        /// Sides of parallel light: triangles that meet at infinity, or quads and dark caps as for
        /// other lights.
        parallel: Parallel = Parallel::Triangles,
        /// At most this many casters have shadows, the most important ones by size on the screen; 0
        /// means all.
        budget: u32 = 0, in 0..=1_000_000, unit "casters",
        /// For hosts that cull faces or hide casters from the camera: counts all casters from
        /// infinity, with both sides of meshes.
        unseen: bool = false,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "volume",
    title: "Shadow volumes",
    summary: "Counts the shadow volumes that each point is in: hard shadows exact to the pixel. Ignores alpha masks.",
    source: "PX 3.2–3.4, 5; SG \"Practical and Robust Stenciled Shadow Volumes\"; ZA 2.4; GG 9",
    family: Family::Volumes,
    filter: None,
    lights: LightKinds::ALL,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<7>,
    hard: true,
    settings: SettingsOf::new::<Volume>(),
    views: views::NAMES,
    shaders: &[FIND_SHADER, COUNT_SHADER, RESOLVE_SHADER, DEPTH_SHADER, VIEWS_SHADER, VIEW_BASE_SHADER, PLAN_SHADER],
    readme: include_str!("README.md"),
};

impl Configure for Volume {
    const INFO: &'static TechniqueInfo = &INFO;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        Ok(Box::new(technique::Volume::new(gpu, self)))
    }
}

/// The single-pass algorithm (PX 3.4): leaves 0 in `visibility` where a point is in the shadow of
/// any of the views' lights, else 1. It is wrong for more than one light, and kept to be compared
/// with. The views differ in nothing but the light.
///
/// # Errors
/// [`Error::Unsupported`] for any other technique than `volume`, and as [`Technique::prepare`].
pub fn record_overlay(
    volume: &mut dyn Technique,
    gpu: &Gpu,
    passes: &mut Passes<'_>,
    views: &[View<'_>],
    visibility: &VisibilityTarget,
) -> Result<(), Error> {
    let any: &mut dyn Any = volume;
    let Some(volume) = any.downcast_mut::<technique::Volume>() else {
        let (technique, what) = ("this technique".into(), "the overlay of all lights at once; choose `volume`".into());
        return Err(Error::Unsupported { technique, what });
    };
    volume.overlay(gpu, passes, views, visibility)
}

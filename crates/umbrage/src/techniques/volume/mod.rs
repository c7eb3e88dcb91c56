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

use crate::casters::Needs;
use crate::checked::Checked;
use crate::masked::WithMasked;
use crate::settings::Configure;
pub use crate::silhouettes::Extrude;
use crate::silhouettes::FIND_SHADER;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, FilterId, Gpu, Passes, View, VisibilityTarget};
use depth::DEPTH_SHADER;
pub use options::{Count, Counter, Culls, Parallel, Reach, Stencil, Volume};
use pipelines::{COUNT_SHADER, RESOLVE_SHADER};
use plan::PLAN_SHADER;
use std::any::Any;
use umbrage_core::LightKinds;
use views::{VIEW_BASE_SHADER, VIEWS_SHADER};

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: options::ID,
    title: "Shadow volumes",
    summary: "Counts the shadow volumes that each point is in: hard shadows exact to the pixel.",
    source: "PX 3.2–3.4, 5; SG \"Practical and Robust Stenciled Shadow Volumes\"; ZA 2.4; GG 9",
    family: Family::Volumes,
    filter: None,
    lights: LightKinds::ALL,
    casters: Needs::Edges,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<8>,
    hard: true,
    settings: SettingsOf::new::<Volume>(),
    views: views::NAMES,
    shaders: &[FIND_SHADER, COUNT_SHADER, RESOLVE_SHADER, DEPTH_SHADER, VIEWS_SHADER, VIEW_BASE_SHADER, PLAN_SHADER],
    readme: include_str!("README.md"),
};

impl Configure for Volume {
    const INFO: &'static TechniqueInfo = &INFO;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        let volume = Box::new(technique::Volume::new(gpu, self));
        Ok(self.masked.beside(gpu, volume, FilterId::hard()))
    }
}

/// The single-pass algorithm (PX 3.4): leaves 0 in `visibility` where a point is in the shadow of
/// any of the views' lights, else 1. It is wrong for more than one light, and kept to be compared
/// with. The views differ in nothing but the light.
///
/// # Errors
/// [`Error::Unsupported`] for any other technique than `volume`, for casters with alpha masks where
/// these are not to cast whole, and as
/// [`Technique::prepare_view`].
pub fn record_overlay(
    volume: &mut dyn Technique,
    gpu: &Gpu,
    passes: &mut Passes<'_>,
    views: &[View<'_>],
    visibility: &VisibilityTarget,
) -> Result<(), Error> {
    if views.iter().any(|view| view.casters.has_masked()) && (&*volume as &dyn Any).is::<WithMasked>() {
        let what = "casters with alpha masks in an overlay of all lights at once; set masked=whole".into();
        return Err(Error::Unsupported { technique: options::ID.into(), what });
    }
    let Some(volume) = counted(volume) else {
        let (technique, what) = ("this technique".into(), "the overlay of all lights at once; choose `volume`".into());
        return Err(Error::Unsupported { technique, what });
    };
    let checked = views.iter().map(Checked::new).collect::<Result<Vec<_>, Error>>()?;
    let views: Vec<_> = checked.iter().map(Checked::view).collect();
    volume.overlay(gpu, passes, &views, visibility)
}

/// Shadow volumes, with or without maps beside them.
fn counted(technique: &mut dyn Technique) -> Option<&mut technique::Volume> {
    if (&*technique as &dyn Any).is::<WithMasked>() {
        let with_masked = (technique as &mut dyn Any).downcast_mut::<WithMasked>()?;
        return (with_masked.inner_mut() as &mut dyn Any).downcast_mut();
    }
    (technique as &mut dyn Any).downcast_mut()
}

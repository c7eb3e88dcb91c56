//! A frame of a technique as hosts see it: first prepared, then recorded, and held to that order by
//! its type.

use crate::answer::{Answer, RadianceTarget};
use crate::casters::refuse_host_casters;
use crate::checked::Checked;
use crate::inline::Inline;
use crate::technique::{InOrder, Technique};
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View, visibility::VisibilityTarget};
use umbrage_core::LightKind;

impl dyn Technique {
    /// Does everything that the CPU does for a frame: fits light views, chooses casters, makes
    /// room. What comes back is to be recorded; until then neither the technique nor anything in
    /// `view` can change. Several techniques may be prepared before any is recorded.
    ///
    /// # Errors
    /// - [`Error::Light`] and [`Error::Camera`] for numbers that are not finite or out of their
    ///   range; directions need not be of unit length.
    /// - [`Error::Unsupported`] for a light or view that the technique can't do, [`Error::Size`]
    ///   beyond the limits.
    /// - [`Error::Scene`] where casters have changed since
    ///   [`Casters::record`](crate::Casters::record).
    /// - [`Error::Order`] once where the host submitted frames in another order than they were
    ///   recorded in; [`Error::DeviceLost`].
    pub fn prepare<'t>(&'t mut self, gpu: &Gpu, view: &View<'t>) -> Result<Prepared<'t>, Error> {
        gpu.check_loss()?;
        gpu.settle();
        gpu.check_fault()?;
        view.casters.check_recorded()?;
        if view.casters.has_host_casters() && !self.draws_host_casters() {
            refuse_host_casters("it needs more of them than depth")?;
        }
        let checked = Checked::new(view)?;
        if self.answer() == Answer::Visibility && view.light.shape.kind() == LightKind::Environment {
            return Err(no_share_of_a_sky());
        }
        self.prepare_view(gpu, &checked.view(), InOrder::new())?;
        Ok(Prepared { technique: self, checked })
    }

    /// What a shader of the host's own calls to look this light up: see [`Inline`]. To be asked for
    /// after a frame was [prepared](crate::Prepared), and to [follow](Inline::follow) later ones.
    ///
    /// # Errors
    /// As [`Technique::lend`] and [`Inline::new`].
    pub fn inline(&mut self, gpu: &Gpu, group: u32, prefix: &str) -> Result<Inline, Error> {
        Inline::new(gpu, self.lend(gpu)?, group, prefix)
    }
}

/// A sky shines from all sides in many colours: no one number tells how much of it a point sees.
fn no_share_of_a_sky() -> Error {
    let what = "the environment, whose answer is radiance, since it answers with visibility; choose a technique of \
                `Registry::of_radiance`"
        .into();
    Error::Unsupported { technique: "this technique".into(), what }
}

/// A technique that is ready to record the view that it was prepared for, once.
///
/// No other order compiles. Nothing is recorded that was not prepared, nothing twice:
/// ```compile_fail,E0382
/// # use umbrage::*;
/// # fn f(t: &mut dyn Technique, gpu: &Gpu, view: &View<'_>, passes: &mut Passes<'_>,
/// #      target: &VisibilityTarget) -> Result<(), Error> {
/// let prepared = t.prepare(gpu, view)?;
/// prepared.record(passes, target)?;
/// prepared.record(passes, target)
/// # }
/// ```
/// and no view takes another one's place:
/// ```compile_fail,E0499
/// # use umbrage::*;
/// # fn f(t: &mut dyn Technique, gpu: &Gpu, [a, b]: [&View<'_>; 2], passes: &mut Passes<'_>,
/// #      target: &VisibilityTarget) -> Result<(), Error> {
/// let of_a = t.prepare(gpu, a)?;
/// let of_b = t.prepare(gpu, b)?;
/// of_a.record(passes, target)?;
/// of_b.record(passes, target)
/// # }
/// ```
#[must_use = "a technique that was prepared leaves nothing in its target until it is recorded"]
pub struct Prepared<'t> {
    technique: &'t mut dyn Technique,
    checked: Checked<'t>,
}

impl Prepared<'_> {
    /// Records the passes that leave the light's visibility in `visibility`.
    ///
    /// # Errors
    /// [`Error::Scene`] where the target is not as large as the receivers; [`Error::Unsupported`]
    /// where the technique [answers](Technique::answer) with radiance; [`Error::DeviceLost`].
    pub fn record(self, passes: &mut Passes<'_>, visibility: &VisibilityTarget) -> Result<(), Error> {
        self.technique.record_visibility(passes, &self.checked.view(), visibility, InOrder::new())?;
        passes.check_loss()
    }

    /// In place of [`Prepared::record`] where shaders of the host's own find the visibility, see
    /// [`Inline`](crate::Inline): records all that these read, and no full-screen pass.
    ///
    /// # Errors
    /// [`Error::Unsupported`] where the technique [lends](Technique::lend) nothing;
    /// [`Error::DeviceLost`].
    pub fn record_maps(self, passes: &mut Passes<'_>) -> Result<(), Error> {
        self.technique.record_maps(passes, &self.checked.view(), InOrder::new())?;
        passes.check_loss()
    }

    /// In place of [`Prepared::record`] where the [answer](Technique::answer) is radiance: records
    /// the passes that leave in `radiance` the light that goes from each visible point to the eye.
    ///
    /// # Errors
    /// As [`Prepared::record`], but where the technique answers with visibility.
    pub fn record_radiance(self, passes: &mut Passes<'_>, radiance: &RadianceTarget) -> Result<(), Error> {
        self.technique.record_radiance(passes, &self.checked.view(), radiance, InOrder::new())?;
        passes.check_loss()
    }
}

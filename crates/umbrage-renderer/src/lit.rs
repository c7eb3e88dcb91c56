//! A light of the picture, and what the views of all lights share.

use crate::shading::{Shading, Slot};
use umbrage::{
    Answer, Casters, Error, Gpu, Passes, Prepared, RadianceTarget, Receivers, Technique, View, VisibilityTarget,
};
use umbrage_core::{CameraView, Light, Texture};

/// A light, its technique and what came out.
pub(crate) struct Lit {
    /// Its number in the scene.
    pub number: usize,
    pub light: Light,
    pub technique: Box<dyn Technique>,
    pub target: Target,
    /// Says that the light lights nothing, since it is left out.
    pub is_left_out: bool,
}

/// Where the answer of a technique goes, and what reads it there.
pub(crate) enum Target {
    Visibility(VisibilityTarget, Slot),
    Radiance(RadianceTarget, wgpu::BindGroup),
}

impl Target {
    /// `one` is that of all lights, where they share one.
    pub fn new(
        gpu: &Gpu,
        shading: &Shading,
        answer: Answer,
        (width, height): (u32, u32),
        one: Option<&VisibilityTarget>,
    ) -> Result<Self, Error> {
        Ok(match answer {
            Answer::Visibility => {
                let target = one.map_or_else(|| VisibilityTarget::new(gpu, width, height), |one| Ok(one.clone()))?;
                let slot = shading.slot(gpu, &[&target]);
                Self::Visibility(target, slot)
            }
            Answer::Radiance => {
                let target = RadianceTarget::new(gpu, width, height)?;
                let read = shading.radiance.bind_group(gpu, &target);
                Self::Radiance(target, read)
            }
        })
    }

    pub fn answer(&self) -> Answer {
        match self {
            Self::Visibility(..) => Answer::Visibility,
            Self::Radiance(..) => Answer::Radiance,
        }
    }

    /// Where the answer is visibility.
    pub fn visibility(&self) -> Option<&VisibilityTarget> {
        match self {
            Self::Visibility(target, _) => Some(target),
            Self::Radiance(..) => None,
        }
    }

    /// Has a technique leave its answer.
    pub fn record(&self, prepared: Prepared<'_>, passes: &mut Passes<'_>) -> Result<(), Error> {
        match self {
            Self::Visibility(target, _) => prepared.record(passes, target),
            Self::Radiance(target, _) => prepared.record_radiance(passes, target),
        }
    }
}

impl Lit {
    /// A light of the scene.
    pub fn new(number: usize, light: Light, technique: Box<dyn Technique>, target: Target) -> Self {
        Self { number, light, technique, target, is_left_out: false }
    }

    /// Has its target say that it is all lit, and gives nothing, as it does where light ends. A
    /// target that is shared is that of the others.
    pub fn leave_out(&mut self, passes: &mut Passes<'_>, shares_visibility: bool) {
        if !std::mem::replace(&mut self.is_left_out, true) {
            let cleared = match &self.target {
                Target::Visibility(..) if shares_visibility => return,
                Target::Visibility(target, _) => target.overwrite(),
                Target::Radiance(target, _) => target.overwrite(),
            };
            passes.render("left out", &[cleared], None);
        }
    }

    /// Gives the light's directions unit length.
    pub fn make_usable(&mut self) -> Result<(), Error> {
        if let Some(usable) = self.light.usable().map_err(Error::Light)? {
            self.light = usable;
        }
        Ok(())
    }

    /// Gives the light another technique and returns the one that it had. The target stays where it
    /// does for both.
    pub fn exchange(
        &mut self,
        gpu: &Gpu,
        shading: &Shading,
        technique: Box<dyn Technique>,
        (size, one): ((u32, u32), Option<&VisibilityTarget>),
    ) -> Result<Box<dyn Technique>, Error> {
        if technique.answer() != self.target.answer() {
            self.target = Target::new(gpu, shading, technique.answer(), size, one)?;
            self.is_left_out = false;
        }
        Ok(std::mem::replace(&mut self.technique, technique))
    }
}

/// What the views of all lights of a frame share.
pub(crate) struct Visible<'a> {
    pub camera: CameraView,
    pub receivers: &'a Receivers,
    pub casters: &'a Casters,
    pub textures: &'a [Texture],
}

impl<'a> Visible<'a> {
    pub fn view(&self, light: &'a Light) -> View<'a> {
        let Self { camera, receivers, casters, textures } = *self;
        View { camera, receivers, casters, light, textures }
    }
}

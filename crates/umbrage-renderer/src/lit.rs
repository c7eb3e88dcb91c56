//! A light of the picture, and what the views of all lights share.

use crate::shading::{Shading, Slot};
use umbrage::{Casters, Error, Gpu, Receivers, Technique, View, VisibilityTarget};
use umbrage_core::{CameraView, Light, Texture};

/// A light, its technique and what came out.
pub(crate) struct Lit {
    /// Its number in the scene.
    pub number: usize,
    pub light: Light,
    pub technique: Box<dyn Technique>,
    pub visibility: VisibilityTarget,
    pub slot: Slot,
}

impl Lit {
    pub fn new(
        gpu: &Gpu,
        shading: &Shading,
        (number, light): (usize, Light),
        technique: Box<dyn Technique>,
        (width, height): (u32, u32),
    ) -> Result<Self, Error> {
        let visibility = VisibilityTarget::new(gpu, width, height)?;
        let slot = shading.slot(gpu, &visibility);
        Ok(Self { number, light, technique, visibility, slot })
    }

    /// From now on for pictures of this size.
    pub fn resize(&mut self, gpu: &Gpu, shading: &Shading, (width, height): (u32, u32)) -> Result<(), Error> {
        self.visibility = VisibilityTarget::new(gpu, width, height)?;
        self.slot = shading.slot(gpu, &self.visibility);
        Ok(())
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

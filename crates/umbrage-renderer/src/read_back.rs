//! What a renderer hands out, read back for files and tests: its picture, and what it is made of.
//! All of it waits for the device; in a browser, `umbrage::read::later` reads the picture.

use crate::{Renderer, lit::Target};
use umbrage::{Answer, DebugView, Error, read};
use umbrage_core::{Camera, Image};

impl Renderer {
    /// [`Renderer::picture`], read back.
    ///
    /// # Errors
    /// As [`Renderer::wait`]; so do all that read back.
    pub fn color(&self) -> Result<Image<[u8; 4]>, Error> {
        read::rgba8(&self.gpu, self.picture())
    }

    /// The visibility that pass number `pass` left, 0…1. What non-receiving surfaces hold means
    /// nothing.
    ///
    /// # Errors
    /// [`Error::Scene`] where there is no such pass; [`Error::Unsupported`] where it answers with
    /// radiance.
    pub fn visibility(&self, pass: usize) -> Result<Image<f32>, Error> {
        match self.target(pass)? {
            Target::Visibility(target, _) => target.read(&self.gpu),
            Target::Radiance(..) => Answer::Radiance.refuse(),
        }
    }

    /// The radiance that pass number `pass` left, red, green and blue.
    ///
    /// # Errors
    /// [`Error::Scene`] where there is no such pass; [`Error::Unsupported`] where it answers with
    /// visibility.
    pub fn radiance(&self, pass: usize) -> Result<Image<[f32; 3]>, Error> {
        match self.target(pass)? {
            Target::Radiance(target, _) => target.read(&self.gpu),
            Target::Visibility(..) => Answer::Visibility.refuse(),
        }
    }

    /// Depth along the view direction in metres, 0 where nothing is.
    ///
    /// # Errors
    /// As [`Renderer::color`].
    pub fn depth(&self, camera: &Camera) -> Result<Image<f32>, Error> {
        let stored = read::one_channel(&self.gpu, self.targets.gbuffer.depth_view.texture(), 0)?;
        Ok(stored.map(|d| if *d > 0.0 { camera.near as f32 / d } else { 0.0 }))
    }

    /// Geometric normals turned to the camera; zero where nothing is.
    ///
    /// # Errors
    /// As [`Renderer::color`].
    pub fn normal(&self) -> Result<Image<[f32; 3]>, Error> {
        let (packed, depth) = (
            read::packed_normals(&self.gpu, self.targets.gbuffer.normal_view.texture())?,
            read::one_channel(&self.gpu, self.targets.gbuffer.depth_view.texture(), 0)?,
        );
        Ok(Image::from_fn(
            packed.width,
            packed.height,
            |x, y| if depth[(x, y)] > 0.0 { packed[(x, y)] } else { [0.0; 3] },
        ))
    }

    /// A picture of the inside of a technique that is in colour.
    ///
    /// # Errors
    /// As [`Renderer::color`].
    pub fn read_debug_color(&self, view: &DebugView<'_>) -> Result<Image<[u8; 4]>, Error> {
        read::rgba8(&self.gpu, view.texture)
    }

    /// A picture of the inside of a technique, as it is stored: depths or numbers.
    ///
    /// # Errors
    /// As [`Renderer::color`].
    pub fn read_debug_view(&self, view: &DebugView<'_>) -> Result<Image<f32>, Error> {
        read::one_channel(&self.gpu, view.texture, view.layer)
    }
}

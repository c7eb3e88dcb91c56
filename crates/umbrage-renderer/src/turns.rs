//! Several pictures that take turns in one renderer: each with its own lights, techniques and
//! upload memory, all of the same geometry.

use crate::lit::{Lit, Target};
use crate::shading::Together;
use crate::{LightPass, Renderer, checked_lights, no_pass};
use umbrage::{Error, Recorder};

/// The lights of one picture, while another one is drawn. What their techniques keep from frame to
/// frame stays.
pub struct Lights {
    lights: Vec<Lit>,
    together: Option<Together>,
    recorder: Recorder,
    size: (u32, u32),
}

impl Renderer {
    /// Lights to take turns with those of this renderer, see [`Renderer::exchange_lights`]. Lights
    /// without a pass do not shine; the same light may come once only.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::Scene`] for a light that is not there.
    pub fn make_lights(&self, passes: Vec<LightPass>) -> Result<Lights, Error> {
        let size = self.targets.size();
        let lights = checked_lights(&self.gpu, &self.shading, &self.scene_lights, size, passes)?;
        Ok(Lights { lights, together: None, recorder: Recorder::new(&self.gpu), size })
    }

    /// Draws with `others` from the next frame on, and leaves in their place what was in use.
    /// Nothing is made, but targets where the size of the pictures has changed since.
    ///
    /// # Errors
    /// [`Error::Size`]; [`Error::Scene`] where a pool has the maps, see [`Renderer::pool_maps`].
    pub fn exchange_lights(&mut self, others: &mut Lights) -> Result<(), Error> {
        if self.pool.is_some() {
            return Err(Error::Scene("the maps of these lights are in a pool, which knows no others".into()));
        }
        let size = self.targets.size();
        std::mem::swap(&mut self.lights, &mut others.lights);
        std::mem::swap(&mut self.together, &mut others.together);
        std::mem::swap(&mut self.recorder, &mut others.recorder);
        if std::mem::replace(&mut others.size, size) != size {
            self.make_targets()?;
        }
        Ok(())
    }

    /// Pixels of pictures across and down.
    pub fn size(&self) -> (u32, u32) {
        self.targets.size()
    }

    /// The visibility that pass number `pass` left, as a texture: one channel of floats, 0…1. What
    /// surfaces hold that receive no shadows means nothing. Another one after [`Renderer::resize`].
    ///
    /// # Errors
    /// [`Error::Scene`] where there is no such pass; [`Error::Unsupported`] where it answers with
    /// radiance.
    pub fn visibility_texture(&self, pass: usize) -> Result<&wgpu::Texture, Error> {
        match &self.lights.get(pass).ok_or_else(|| no_pass(pass))?.target {
            Target::Visibility(target, _) => Ok(&target.texture),
            Target::Radiance(..) => umbrage::Answer::Radiance.refuse(),
        }
    }

    /// Depth of the last frame, as [`umbrage::Receivers`] have it: near plane over distance, or for
    /// parallel lines of sight 1 at the near plane and 0 at the far one; 0 where nothing is.
    /// Another one after [`Renderer::resize`].
    pub fn depth_texture(&self) -> &wgpu::Texture {
        self.targets.gbuffer.depth_view.texture()
    }

    /// Geometric normals of the last frame, packed, see [`umbrage::read::later::packed_normals`].
    pub fn normal_texture(&self) -> &wgpu::Texture {
        self.targets.gbuffer.normal_view.texture()
    }
}

//! What many lights share: a pool of bytes for their maps, and one target.

use crate::lit::{Lit, Target, Visible};
use crate::{Renderer, no_pass};
use umbrage::{Error, Gpu, MapPool, PooledLight, Settings, VisibilityTarget};

/// A pool, and what the technique of each pass is made of.
pub(crate) struct Pooled {
    maps: MapPool,
    pub settings: Vec<Settings>,
}

impl Pooled {
    /// Gives the lights of a frame their maps.
    pub fn share(&mut self, gpu: &Gpu, scene: &Visible<'_>, lights: &mut [Lit]) -> Result<(), Error> {
        let pooled = lights.iter_mut().zip(&self.settings).map(|(lit, settings)| {
            let Lit { light, technique, .. } = lit;
            PooledLight { view: scene.view(light), settings, technique }
        });
        self.maps.share(gpu, &mut pooled.collect::<Vec<_>>())
    }
}

impl Renderer {
    /// From the next frame on the maps of all lights together take so many bytes at most, see
    /// [`MapPool`]. `settings` are what the technique of each pass is made of: it may be made anew
    /// of them.
    ///
    /// # Errors
    /// [`Error::Scene`] where there are not as many settings as passes.
    pub fn pool_maps(&mut self, bytes: u64, settings: Vec<Settings>) -> Result<(), Error> {
        if settings.len() != self.lights.len() {
            return Err(no_pass(settings.len().max(self.lights.len()) - 1));
        }
        self.pool = Some(Pooled { maps: MapPool::new(bytes), settings });
        Ok(())
    }

    /// The pool of [`Renderer::pool_maps`].
    pub fn pool(&self) -> Option<&MapPool> {
        self.pool.as_ref().map(|pooled| &pooled.maps)
    }

    /// From the next frame on all lights leave their visibility in one target, one after the other,
    /// which takes the memory of one; what is read back is that of the last one that lights
    /// something seen. `false`: each has its own, as at the start.
    ///
    /// # Errors
    /// [`Error::Size`].
    pub fn set_one_target(&mut self, one: bool) -> Result<(), Error> {
        let (width, height) = self.targets.size();
        self.one_target = one.then(|| VisibilityTarget::new(&self.gpu, width, height)).transpose()?;
        self.make_targets()
    }

    /// Of the picture's size.
    pub(crate) fn make_targets(&mut self) -> Result<(), Error> {
        let (size, one) = (self.targets.size(), self.one_target.as_ref());
        for lit in &mut self.lights {
            lit.target = Target::new(&self.gpu, &self.shading, lit.target.answer(), size, one)?;
            lit.is_left_out = false;
        }
        Ok(())
    }
}

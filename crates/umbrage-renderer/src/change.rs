//! What of a renderer can change from one frame to the next, without making it anew.

use crate::{LightPass, Renderer, light_of, lit::Target, no_pass, overlay::Overlay, targets::Targets, twice};
use umbrage::{Casters, Error, Recorder, Settings, Technique};
use umbrage_core::{Camera, Light};

impl Renderer {
    /// From the next frame on makes pictures of `width` × `height`. Pipelines, casters and
    /// techniques stay; techniques make what depends on the size in that frame.
    ///
    /// # Errors
    /// [`Error::Size`] beyond the adapter's limits; then everything stays as it was.
    pub fn resize(&mut self, width: u32, height: u32) -> Result<(), Error> {
        let size = (width, height);
        if size == self.targets.size() {
            return Ok(());
        }
        self.gpu.check_size("the picture", width, height)?;
        self.targets = Targets::new(&self.gpu, &self.shading, &self.tonemap, size)?;
        self.set_one_target(self.one_target.is_some())?;
        if let Some(overlay) = &mut self.overlay {
            overlay.resize(&self.gpu, size)?;
            self.light_everything();
        }
        Ok(())
    }

    /// From the next frame on `technique` works for pass number `pass`; everything else stays, and
    /// its light where it is.
    ///
    /// # Errors
    /// [`Error::Scene`] where there is no such pass, and where a pool has its maps, see
    /// [`Renderer::pool_maps`].
    pub fn set_technique(&mut self, pass: usize, technique: Box<dyn Technique>) -> Result<(), Error> {
        self.check_no_pool(pass)?;
        let lit = self.lights.get_mut(pass).ok_or_else(|| no_pass(pass))?;
        let targets = (self.targets.size(), self.one_target.as_ref());
        lit.exchange(&self.gpu, &self.shading, technique, targets).map(|_| ())
    }

    /// From the next frame on pass number `pass` works by `settings`, everything else stays. True
    /// where its technique took them over; else it was made anew, as the settings make it. (What
    /// they do not say gets lost then: whoever wraps techniques, as [`umbrage::light_samples()`]
    /// does, uses [`Renderer::set_technique`].)
    ///
    /// # Errors
    /// What making the technique gives; [`Error::Scene`] where there is no such pass. Then all
    /// stays as it was.
    pub fn set_settings(&mut self, pass: usize, settings: &Settings) -> Result<bool, Error> {
        let lit = self.lights.get_mut(pass).ok_or_else(|| no_pass(pass))?;
        let targets = (self.targets.size(), self.one_target.as_ref());
        let is_taken = lit.technique.set(&self.gpu, settings)?;
        if !is_taken {
            lit.exchange(&self.gpu, &self.shading, settings.make(&self.gpu)?, targets)?;
        }
        if let Some(pool) = &mut self.pool {
            pool.settings[pass] = settings.clone();
        }
        Ok(is_taken)
    }

    /// Puts `new` in the place of pass number `pass` and gives back what was there. Geometry,
    /// targets and pipelines stay; the light is as the scene has it.
    ///
    /// # Errors
    /// [`Error::Scene`] where there is no such pass or light, for a light of another pass, and
    /// where a pool has the maps.
    pub fn exchange(&mut self, pass: usize, new: LightPass) -> Result<LightPass, Error> {
        self.check_no_pool(pass)?;
        if self.lights.iter().enumerate().any(|(i, other)| i != pass && other.number == new.light) {
            return Err(twice(new.light));
        }
        let light = light_of(&self.scene_lights, new.light)?;
        let lit = self.lights.get_mut(pass).ok_or_else(|| no_pass(pass))?;
        let targets = (self.targets.size(), self.one_target.as_ref());
        let technique = lit.exchange(&self.gpu, &self.shading, new.technique, targets)?;
        lit.light = light;
        Ok(LightPass { light: std::mem::replace(&mut lit.number, new.light), technique })
    }

    /// A pool makes techniques anew of the settings that it knows.
    fn check_no_pool(&self, pass: usize) -> Result<(), Error> {
        match self.pool {
            Some(_) => {
                Err(Error::Scene(format!("the maps of pass {pass} are in a pool; change the pass by `set_settings`")))
            }
            None => Ok(()),
        }
    }

    /// Records with `new` from the next frame on and gives back what was in use. Upload memory goes
    /// with it, and the GPU times that a technique sees of its last frame: where techniques take
    /// turns, each has a recorder of its own.
    pub fn exchange_recorder(&mut self, new: Recorder) -> Recorder {
        std::mem::replace(&mut self.recorder, new)
    }

    /// The same in place, to take turns with one that counts.
    pub fn swap_recorder(&mut self, other: &mut Recorder) {
        std::mem::swap(&mut self.recorder, other);
    }

    /// From the next frame on shades by the single-pass algorithm (PX 3.4): every light shines
    /// everywhere, and whatever is in the shadow of any of them loses this share of its light;
    /// wrong, and kept to be compared with. The first light's technique does all lights. `None`
    /// returns to the right one.
    ///
    /// # Errors
    /// [`Error::Size`].
    pub fn set_overlay(&mut self, darkness: Option<f32>) -> Result<(), Error> {
        self.overlay = darkness.map(|d| Overlay::new(&self.gpu, self.targets.size(), d)).transpose()?;
        self.light_everything();
        Ok(())
    }

    /// From the next frame on leaves out lights that light nothing the camera sees, and shades no
    /// more under each than the rectangle that it can light, as it does from the start; or, where
    /// `clips` is false, does all of the work for every light, with the same picture: to compare.
    pub fn set_clipping(&mut self, clips: bool) {
        self.clips_lights = clips;
    }

    /// Leaves the visibility of every light at 1, since an overlay's lights shine everywhere.
    fn light_everything(&mut self) {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut passes = self.recorder.begin(&mut encoder);
        for lit in &self.lights {
            if let Target::Visibility(visibility, _) = &lit.target {
                passes.render("lit", &[visibility.overwrite()], None);
            }
        }
        passes.finish();
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Has every technique drop what it keeps from frame to frame, see [`umbrage::Inside::forget`].
    pub fn forget(&mut self) {
        self.lights.iter_mut().for_each(|light| light.technique.inside_mut().forget());
    }

    /// [`umbrage::warm_up`] for this renderer's frames: after it a technique of the same settings
    /// compiles nothing for lights such as these.
    ///
    /// # Errors
    /// As [`umbrage::warm_up`].
    pub fn warm_up(&self, technique: &mut dyn Technique, lights: &[Light], camera: &Camera) -> Result<(), Error> {
        let receivers = &self.targets.receivers;
        let camera = camera.view(receivers.size.0, receivers.size.1);
        umbrage::warm_up(&self.gpu, technique, lights, receivers, &camera)
    }

    /// From the next frame on the technique of pass number `pass` draws this one of its views, see
    /// [`umbrage::Inside::inspect`].
    pub fn inspect(&mut self, pass: usize, view: Option<&str>) {
        if let Some(lit) = self.lights.get_mut(pass) {
            lit.technique.inside_mut().inspect(view);
        }
    }

    /// The scene's geometry on the GPU.
    pub fn casters(&self) -> &Casters {
        &self.casters
    }

    /// The same, to move instances, and to have others come and go.
    pub fn casters_mut(&mut self) -> &mut Casters {
        &mut self.casters
    }

    /// The light of pass number `pass`, to move it.
    pub fn light_mut(&mut self, pass: usize) -> Option<&mut Light> {
        self.lights.get_mut(pass).map(|l| &mut l.light)
    }
}

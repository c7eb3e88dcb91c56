//! One renderer for many techniques: geometry, targets and the renderer's own pipelines are made
//! once for a scene.

use crate::{bakes::Bakes, choice::Choice, error::Error, source::Source};
use umbrage::{Gpu, Recorder, Technique, baseline};
use umbrage_renderer::{LightPass, Renderer};

/// A scene at one size, on which techniques take turns.
pub(crate) struct Stage<'a> {
    gpu: Gpu,
    source: &'a Source,
    bakes: Bakes<'a>,
    size: (u32, u32),
    /// Made when it is first needed.
    renderer: Option<Renderer>,
}

/// A technique that takes turns on a [`Stage`], with a recorder of its own: what it knows of its
/// last frame stays true.
pub(crate) struct Actor {
    technique: Box<dyn Technique>,
    recorder: Recorder,
}

impl Actor {
    pub(crate) fn new(gpu: &Gpu, technique: Box<dyn Technique>) -> Self {
        Self { technique, recorder: Recorder::new(gpu) }
    }
}

impl<'a> Stage<'a> {
    pub(crate) fn new(gpu: &Gpu, source: &'a Source, size: (u32, u32), bakes: Bakes<'a>) -> Self {
        Self { gpu: gpu.clone(), source, bakes, size, renderer: None }
    }

    /// A technique of a choice. What the driver has to say against it is its error.
    ///
    /// # Errors
    /// What the adapter can't do, and what can't be baked.
    pub(crate) fn actor(&self, choice: &Choice) -> Result<Actor, Error> {
        Ok(Actor::new(&self.gpu, self.gpu.catch(|| self.bakes.make(choice, &self.gpu))?))
    }

    /// What techniques are given that want it.
    pub(crate) fn bakes(&self) -> &Bakes<'a> {
        &self.bakes
    }

    /// Does `work` with `actor` on a light, and gives the actor back. Whatever fails takes the
    /// renderer with it, so that nothing of one technique's failure is left for the next.
    ///
    /// # Errors
    /// Those of `work`, and what the driver reports meanwhile.
    pub(crate) fn act<T>(
        &mut self,
        light: usize,
        actor: Actor,
        work: impl FnOnce(&mut Renderer) -> Result<T, Error>,
    ) -> Result<(Actor, T), Error> {
        let gpu = self.gpu.clone();
        let acted = gpu.catch(|| {
            let renderer = self.renderer()?;
            let before = renderer.exchange(0, LightPass { light, technique: actor.technique })?;
            let recorder = renderer.exchange_recorder(actor.recorder);
            let done = work(renderer)?;
            let recorder = renderer.exchange_recorder(recorder);
            let LightPass { technique, .. } = renderer.exchange(0, before)?;
            Ok((Actor { technique, recorder }, done))
        });
        if acted.is_err() {
            self.renderer = None;
        }
        acted
    }

    /// The device to make actors on.
    pub(crate) fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    fn renderer(&mut self) -> Result<&mut Renderer, Error> {
        let renderer = match self.renderer.take() {
            Some(renderer) => renderer,
            None => {
                let resting = LightPass { light: 0, technique: baseline::floor(&self.gpu) };
                let (width, height) = self.size;
                let mut renderer = Renderer::new(&self.gpu, &self.source.scene, width, height, vec![resting])?;
                // As in `cell.rs`.
                renderer.set_clipping(false);
                renderer
            }
        };
        Ok(self.renderer.insert(renderer))
    }
}

/// Ends a run before its long work where none of its techniques can be made; one that can't be is
/// one cell's failure.
///
/// # Errors
/// That of the first.
pub(crate) fn check_choices(choices: &[Choice], gpu: &Gpu) -> Result<(), Error> {
    let mut first = Ok(());
    for choice in choices {
        match gpu.catch(|| choice.make(gpu)) {
            Ok(_) | Err(Error::Gpu(umbrage::Error::Unsupported { .. })) => return Ok(()),
            Err(error) => first = first.and(Err(error)),
        }
    }
    first
}

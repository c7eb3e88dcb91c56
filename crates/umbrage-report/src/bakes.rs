//! Baked transfer for the techniques that want it, baked once for each scene and settings.

use crate::{choice::Choice, error::Error, progress::Progress, source::Source};
use std::{cell::RefCell, ops::ControlFlow, path::Path, rc::Rc};
use umbrage::{Gpu, Technique};
use umbrage_bake::{Cache, Settings, bake};
use umbrage_core::transfer::{Transfer, Wanted};

/// The bakes of a scene.
pub(crate) struct Bakes<'a> {
    source: &'a Source,
    /// Where they are kept from run to run.
    folder: Option<&'a Path>,
    progress: &'a dyn Progress,
    done: RefCell<Vec<(Wanted, Rc<Transfer>)>>,
}

impl<'a> Bakes<'a> {
    pub fn new(source: &'a Source, folder: Option<&'a Path>, progress: &'a dyn Progress) -> Self {
        Self { source, folder, progress, done: RefCell::default() }
    }

    /// Makes the technique of a choice, with the transfer that it wants of the scene.
    ///
    /// # Errors
    /// As [`Choice::make`]; a scene that can't be baked, files that can't be written.
    pub fn make(&self, choice: &Choice, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        let mut technique = choice.make(gpu)?;
        if let Some(wanted) = technique.wants() {
            let transfer = self.baked(&wanted)?;
            technique.take_transfer(gpu, &transfer, &self.source.scene)?;
        }
        Ok(technique)
    }

    /// Bakes what a choice wants. What fails does so again when the technique is made, and is its
    /// error then.
    pub fn ahead(&self, choice: &Choice) {
        if let Some(wanted) = choice.settings.wants() {
            let _ = self.baked(&wanted);
        }
    }

    fn baked(&self, wanted: &Wanted) -> Result<Rc<Transfer>, Error> {
        let known = self.done.borrow().iter().find(|(of, _)| of == wanted).map(|(_, transfer)| transfer.clone());
        if let Some(transfer) = known {
            return Ok(transfer);
        }
        self.progress.begin(&format!("{}: baking transfer", self.source.scene.name), 1);
        let transfer = self.bake(wanted).map_err(|error| Error::scene(&self.source.asked, error));
        self.progress.end();
        let transfer = Rc::new(transfer?);
        self.done.borrow_mut().push((*wanted, transfer.clone()));
        Ok(transfer)
    }

    fn bake(&self, wanted: &Wanted) -> Result<Transfer, umbrage_bake::Error> {
        let Wanted { order, kind, rays, detail } = *wanted;
        let settings = Settings { order, kind, rays, detail, ..Settings::default() };
        let watch = |done: u64, all: u64| {
            self.progress.of(done, all);
            ControlFlow::Continue(())
        };
        let scene = &self.source.scene;
        match self.folder {
            None => bake(scene, &settings, &watch),
            Some(folder) => {
                let kept = Cache::new(folder).bake(scene, &settings, &watch)?;
                kept.notes.iter().for_each(|note| self.progress.note(note));
                Ok(kept.transfer)
            }
        }
    }
}

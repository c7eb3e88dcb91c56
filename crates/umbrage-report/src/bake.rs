//! Baking the transfer of a scene.

use crate::{Error, Progress, Source};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};
use umbrage_bake::{Cache, Kept, Settings, Storage};
use umbrage_io::{check_transfer_name, save_transfer};

/// A scene to be baked, and the folder that keeps the result.
#[derive(Clone, Debug)]
pub struct Bake {
    /// The scene.
    pub source: Source,
    /// How.
    pub settings: Settings,
    /// Where the transfer is kept, in full.
    pub folder: PathBuf,
    /// How it is stored in what is handed back and in `out`.
    pub storage: Storage,
    /// A file for other software, `.npz` or `.glb`.
    pub out: Option<PathBuf>,
}

impl Bake {
    /// Bakes what is not kept yet, until `stop` is set. Stopped, it continues the next time.
    ///
    /// # Errors
    /// Settings and scenes that can't be baked, files that can't be read or written, and a bake
    /// that was stopped.
    pub fn run(&self, progress: &dyn Progress, stop: &AtomicBool) -> Result<Kept, Error> {
        self.out.as_deref().map_or(Ok(()), check_transfer_name)?;
        let (name, begun) = (format!("bake {}", self.source.asked), Once::new());
        let watch = |done: u64, all: u64| {
            begun.call_once(|| progress.begin(&name, all));
            progress.at(done);
            if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let kept = Cache::new(&self.folder).bake(&self.source.scene, &self.settings, &watch);
        if begun.is_completed() {
            progress.end();
        }
        let mut kept = kept?;
        if self.storage != Storage::Full {
            kept.transfer = self.storage.apply(&kept.transfer);
        }
        let save = |path: &PathBuf| save_transfer(path, &kept.transfer, &self.source.scene);
        self.out.as_ref().map_or(Ok(()), save)?;
        Ok(kept)
    }
}

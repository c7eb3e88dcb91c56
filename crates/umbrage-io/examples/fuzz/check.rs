//! What has to be true of every input.

use crate::corpus::Case;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use umbrage_core::Scene;
use umbrage_io::{Error, open, pictures};

pub struct Check {
    folder: PathBuf,
    command: PathBuf,
    /// Inputs that opened.
    opened: Cell<u64>,
}

impl Check {
    pub fn new(folder: &Path, command: &Path) -> Self {
        Self { folder: folder.to_path_buf(), command: command.to_path_buf(), opened: Cell::new(0) }
    }

    /// How many inputs opened: where none does, their changes are too coarse to test much.
    pub fn opened(&self) -> u64 {
        self.opened.get()
    }

    /// Reads the input in this process.
    pub fn read(&self, case: &Case) -> Result<(), String> {
        let path = self.folder.join(&case.files[0].name);
        let read = || match case.files[0].name.rsplit('.').next() {
            Some("png" | "jpg" | "hdr" | "exr") => {
                let loaded = [
                    pictures::load_texture(&path).map(drop),
                    pictures::load_grey(&path).map(drop),
                    pictures::load_mask(&path).map(drop),
                    pictures::load_rgb(&path).map(drop),
                ];
                self.opened.set(self.opened.get() + u64::from(loaded.iter().any(Result::is_ok)));
                loaded.into_iter().filter_map(Result::err).try_for_each(|e| is_clear(&e, &path))
            }
            _ => match open(&path) {
                Ok(opened) => {
                    self.opened.set(self.opened.get() + 1);
                    opened.notes.iter().try_for_each(|note| is_one_line(note)).and(is_finite(&opened.scene))
                }
                Err(e) => is_clear(&e, &path),
            },
        };
        catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|panic| {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(|t| (*t).to_owned()));
            Err(format!("panic: {}", text.unwrap_or_default()))
        })
    }

    /// Runs the command on the input.
    pub fn command(&self, case: &Case) -> Result<(), String> {
        let name = &case.files[0].name;
        let mut command = Command::new(&self.command);
        command.current_dir(&self.folder).args(["info", "--json", name]).stdin(Stdio::null());
        let output = command.output().map_err(|e| format!("the command does not start: {e}"))?;
        let errors = String::from_utf8_lossy(&output.stderr);
        match output.status.code() {
            Some(0) => serde_json::from_slice::<serde_json::Value>(&output.stdout)
                .map(drop)
                .map_err(|e| format!("the command printed no JSON: {e}")),
            Some(2) if errors.trim_end().lines().count() == 1 => is_one_line(errors.trim_end()),
            Some(2) => Err(format!("the command printed not one line: {errors}")),
            _ => Err(format!("the command ended with {}: {errors}", output.status)),
        }
    }
}

/// An error is one line that names a file of the input and the remedy.
fn is_clear(error: &Error, path: &Path) -> Result<(), String> {
    let text = error.to_string();
    is_one_line(&text)?;
    let folder = path.parent().unwrap_or(Path::new("")).to_string_lossy().into_owned();
    if !text.contains(&folder) {
        return Err(format!("an error that names no file: {text}"));
    }
    if error.remedy.as_ref().is_none_or(String::is_empty) {
        return Err(format!("an error without a remedy: {text}"));
    }
    Ok(())
}

fn is_one_line(text: &str) -> Result<(), String> {
    match text.contains(char::is_control) || text.chars().count() > 1500 {
        true => Err(format!("not one short line: {}", text.chars().take(300).collect::<String>().escape_debug())),
        false => Ok(()),
    }
}

/// A scene that opens can be drawn: everything in it is finite.
fn is_finite(scene: &Scene) -> Result<(), String> {
    let bounds = scene.bounds();
    let places = [bounds.min, bounds.max, scene.camera.eye, scene.camera.target];
    let lights = scene.lights.iter().all(|l| l.shape.center().is_finite() && l.shape.radius().is_finite());
    match places.iter().all(|p| p.is_finite()) && lights && scene.camera.near > 0.0 {
        true => Ok(()),
        false => Err(format!("a scene that is not finite: {bounds:?} {:?}", scene.camera)),
    }
}

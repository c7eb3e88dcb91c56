//! Scene files, glTF and OBJ in; PNG, EXR and HDR pictures in and out.
//!
//! [`open`] reads whatever a user names: a scene file, or a model alone. Nothing here panics on bad
//! input: every [`Error`] names the file, the place in it, what is wrong, and what helps.

mod defaults;
mod error;
mod files;
mod gltf_file;
mod limits;
mod lines;
mod model;
mod mtl;
mod npz;
mod obj;
pub mod pictures;
mod placed;
mod polygon;
mod probe;
mod scene_file;
pub mod stored;
mod text;
mod transfer;

pub use error::{Error, Place};
pub use files::Bytes;
pub use probe::{Probe, open_probe, read_probe};
pub use scene_file::{change, changes};
pub use text::printable;
pub use transfer::{check_transfer_name, open_transfer, save_transfer};

use files::Files;
use std::path::Path;
use umbrage_core::Scene;

/// A scene that was read, and what there is to say about it.
#[derive(Clone, Debug)]
pub struct Opened {
    /// The scene, with a camera and at least one light.
    pub scene: Scene,
    /// Sentences for the user: what was made up or left out.
    pub notes: Vec<String>,
}

/// Reads a scene file (`.toml`), or a model (`.obj`, `.gltf`, `.glb`) as a scene of its own.
///
/// A missing camera or light is made from the bounds of the scene, and `notes` says so.
///
/// # Errors
/// Whatever is wrong with the file or with one that it refers to; a scene without a triangle.
pub fn open(path: &Path) -> Result<Opened, Error> {
    open_from(Files::OnDisk, path)
}

/// The same from bytes that are at hand, such as files dropped on a page: `path` is one of `files`,
/// and what it refers to is looked up among them, by its path or else by its name alone.
///
/// # Errors
/// As [`open`]; a file that is not among them.
pub fn open_bytes(path: &str, files: &Bytes) -> Result<Opened, Error> {
    open_from(Files::AtHand(files), Path::new(path))
}

fn open_from(files: Files<'_>, path: &Path) -> Result<Opened, Error> {
    if extension(path) == "toml" {
        let text = text::decode(path, files.read(path)?)?;
        let dir = path.parent().unwrap_or(Path::new(""));
        return scene_file::read(files, &text, dir, path);
    }
    let model = model::Model::read(files, path)?;
    let mut scene = Scene { name: title(path), ..Scene::default() };
    let bases = model.add_to(&mut scene);
    model.place(&mut scene, bases, &model::Placement::default());
    let rest_note = model.rest_note(path);
    let mut notes = model.notes;
    notes.extend(rest_note);
    match model.camera {
        Some(camera) => scene.camera = camera,
        None => defaults::add_camera(&mut scene, &mut notes),
    }
    scene.lights = model.lights;
    finish(path, scene, notes)
}

/// Reads the text of a scene file; paths in it are relative to `base_dir`, and errors call it
/// `name`.
///
/// # Errors
/// As [`open`].
pub fn open_str(toml_text: &str, base_dir: &Path, name: &str) -> Result<Opened, Error> {
    scene_file::read(Files::OnDisk, toml_text, base_dir, Path::new(name))
}

/// Characters of a scene's name.
const LONGEST_TITLE: usize = 200;

/// The last checks and additions, common to all kinds of file.
fn finish(path: &Path, mut scene: Scene, mut notes: Vec<String>) -> Result<Opened, Error> {
    if scene.triangle_count() == 0 {
        return Err(Error::new(path, "there is no triangle in it").remedy("a scene needs at least one"));
    }
    scene.name = printable(&scene.name, LONGEST_TITLE).into_owned();
    placed::check(path, &scene)?;
    if scene.lights.is_empty() && scene.environment.is_none() {
        defaults::add_light(&mut scene, &mut notes);
    }
    Ok(Opened { scene, notes })
}

/// The extension in lower case, or nothing.
fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

/// A title for a file: its name without `.scene.toml`, `.obj` and the like.
fn title(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    stem.strip_suffix(".scene").unwrap_or(&stem).to_owned()
}

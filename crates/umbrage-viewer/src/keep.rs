//! Snapshots and bundles for bug reports, written while the window stays in use.

use crate::link;
use crate::state::{COMPARED, PaneState, State};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use umbrage::{Gpu, Registry};
use umbrage_report::{Aov, Choice, Method, Picture, RAY_TRACED, Shot, Silent, Source};
use zip::write::SimpleFileOptions;

/// What is to be kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Png,
    Exr,
    Bundle,
}

/// What a file is made of.
#[derive(Clone)]
pub(crate) struct What {
    pub gpu: Gpu,
    pub registry: Registry,
    pub source: Arc<Source>,
    pub state: State,
    pub size: (u32, u32),
    /// Of the truth, for each pixel.
    pub samples: u32,
    /// Where files go.
    pub folder: PathBuf,
}

/// A file that is being written.
pub(crate) struct Keeping(Receiver<Result<PathBuf, String>>);

impl Keeping {
    /// Starts on a thread of its own. Snapshots are of pane number `active`.
    pub fn start(kind: Kind, what: What, active: usize) -> Self {
        let (send, done) = channel();
        std::thread::spawn(move || {
            let pane = &what.state.panes[active.min(what.state.panes.len() - 1)];
            let kept = match kind {
                Kind::Png => snapshot(&what, pane, "png"),
                Kind::Exr => snapshot(&what, pane, "exr"),
                Kind::Bundle => bundle(&what),
            };
            // Nobody waits where the window was closed.
            let _ = send.send(kept);
        });
        Self(done)
    }

    /// What came of it, once.
    pub fn take(&self) -> Option<Result<PathBuf, String>> {
        match self.0.try_recv() {
            Ok(kept) => Some(kept),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err("the file could not be written".into())),
        }
    }
}

/// The picture that the copied command takes, taken the same way.
pub(crate) fn picture(what: &What, pane: &PaneState) -> Result<Picture, String> {
    let text = |e: umbrage_report::Error| e.to_string();
    if COMPARED.contains(&pane.picture.as_str()) {
        return Err(format!("`{}` is a picture of a comparison: copy it as a command", pane.picture));
    }
    let change = link::change(&what.state, &what.source.scene);
    let method = if pane.technique == RAY_TRACED {
        Method::RayTraced { samples: what.samples }
    } else {
        Method::Technique(Choice::parse(&what.registry, &pane.technique, &[]).map_err(text)?)
    };
    let State { time_s, moving, path, frame, .. } = what.state;
    let source = Source::clone(&what.source).changed(Some(&change), time_s).map_err(text)?;
    let shot = Shot {
        source: source.moved(moving, path, frame, what.size.1),
        lights: what.state.shining(),
        method,
        size: what.size,
        aov: Aov::from(pane.picture.as_str()),
        overlay: None,
        bake_cache: None,
    };
    shot.take(Some(&what.gpu), &Silent).map_err(text)
}

fn snapshot(what: &What, pane: &PaneState, extension: &str) -> Result<PathBuf, String> {
    let path = free(&what.folder, &link::name(pane), extension);
    Picture::check_name(&Aov::from(pane.picture.as_str()), &path).map_err(|e| e.to_string())?;
    picture(what, pane)?.save(&path).map_err(|e| e.to_string())?;
    Ok(path)
}

/// A name that no file in the folder has.
fn free(folder: &Path, stem: &str, extension: &str) -> PathBuf {
    let named = |number: usize| match number {
        1 => folder.join(format!("{stem}.{extension}")),
        _ => folder.join(format!("{stem}-{number}.{extension}")),
    };
    // There are more numbers than files.
    (1..).map(named).find(|path| !path.exists()).unwrap_or_else(|| named(1))
}

/// All that somebody needs to see what is seen here.
fn bundle(what: &What) -> Result<PathBuf, String> {
    let path = free(&what.folder, "umbrage-bundle", "zip");
    let write = || -> Result<(), String> {
        let text = |e: &dyn std::fmt::Display| e.to_string();
        let file = std::fs::File::create(&path).map_err(|e| text(&e))?;
        let mut zip = zip::ZipWriter::new(file);
        let mut add = |name: &str, bytes: &[u8]| {
            zip.start_file(name, SimpleFileOptions::default()).map_err(|e| e.to_string())?;
            zip.write_all(bytes).map_err(|e| e.to_string())
        };
        let scene = &what.source.scene;
        add("permalink.txt", link::write(&what.state, scene).as_bytes())?;
        let command = |pane: &PaneState| link::command(&what.state, pane, scene, what.size, Some(what.samples));
        add("commands.txt", (what.state.panes.iter().map(command).collect::<Vec<_>>().join("\n") + "\n").as_bytes())?;
        add("about.txt", about(what).as_bytes())?;
        if let Ok(bytes) = std::fs::read(&what.state.scene) {
            let name = Path::new(&what.state.scene).file_name().unwrap_or_default().to_string_lossy().into_owned();
            add(&format!("scene/{name}"), &bytes)?;
        }
        for (number, pane) in what.state.panes.iter().enumerate() {
            let folder = tempfile::tempdir().map_err(|e| text(&e))?;
            let file = folder.path().join("picture.png");
            match picture(what, pane).and_then(|picture| picture.save(&file).map_err(|e| text(&e))) {
                Ok(()) => {
                    let bytes = std::fs::read(&file).map_err(|e| text(&e))?;
                    add(&format!("{number}-{}.png", link::name(pane)), &bytes)?;
                }
                Err(error) => add(&format!("{number}-{}.txt", link::name(pane)), error.as_bytes())?,
            }
        }
        zip.finish().map_err(|e| text(&e))?;
        Ok(())
    };
    write().map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(path)
}

fn about(what: &What) -> String {
    let adapter = what.gpu.adapter();
    let (device, scene) = (&what.gpu.device, &what.source.scene);
    format!(
        "umbrage {}\nadapter: {} ({}, {})\ndriver: {}\nfeatures: {:?}\nlimits: {:#?}\nscene: {}, {} triangles, {} \
         lights\nnotes: {:?}\n",
        env!("CARGO_PKG_VERSION"),
        adapter.name,
        adapter.kind,
        adapter.backend,
        adapter.driver,
        device.features(),
        device.limits(),
        what.state.scene,
        scene.triangle_count(),
        scene.lights.len(),
        what.source.notes,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let first = free(folder.path(), "pcf-color", "png");
        std::fs::write(&first, "").unwrap();
        let second = free(folder.path(), "pcf-color", "png");
        assert_eq!(second.file_name().unwrap(), "pcf-color-2.png");
    }
}

//! Bakes that are kept on disk: done once, and continued where they were stopped.

use crate::file::{decoded, decoded_state, encoded, encoded_state};
use crate::work::{State, Watch, Work};
use crate::{Error, Key, Settings};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};
use umbrage_core::{Scene, transfer::Transfer};

/// How often an unfinished bake is written down.
const EVERY: Duration = Duration::from_secs(10);

/// A folder of bakes.
#[derive(Clone, Debug)]
pub struct Cache {
    folder: PathBuf,
}

/// A transfer, and where it is from.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// The transfer.
    pub transfer: Transfer,
    /// True where it was there and nothing was baked.
    pub was_kept: bool,
    /// Where it is now.
    pub path: PathBuf,
    /// What users should know: files that were damaged and are made anew, bakes that were
    /// continued.
    pub notes: Vec<String>,
}

impl Cache {
    /// In this folder, which is made when something is kept.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_path_buf() }
    }

    /// Where a finished transfer is, or would be.
    pub fn path(&self, key: Key) -> PathBuf {
        self.folder.join(format!("{key}.transfer"))
    }

    /// Where an unfinished one is, or would be.
    pub fn unfinished_path(&self, key: Key) -> PathBuf {
        self.folder.join(format!("{key}.unfinished"))
    }

    /// What is kept of a scene and settings, or else baked and kept now. A bake that was stopped is
    /// continued; a file that is damaged, or of another version, is made anew and noted.
    ///
    /// # Errors
    /// Those of [`crate::bake`], and files that can't be read or written: then nothing is half
    /// written.
    pub fn bake(&self, scene: &Scene, settings: &Settings, watch: Watch<'_>) -> Result<Kept, Error> {
        settings.check(scene)?;
        let key = Key::new(scene, settings);
        let (path, mut notes) = (self.path(key), Vec::new());
        if let Some(bytes) = read(&path)? {
            match decoded(key, &bytes) {
                Some(transfer) => return Ok(Kept { transfer, was_kept: true, path, notes }),
                None => notes.push(damaged(&path)),
            }
        }
        let work = Work::new(scene, settings);
        let mut state = self.begun(key, &work, &mut notes)?;
        let mut last = Instant::now();
        let unfinished = self.unfinished_path(key);
        // A folder that can't be written to is known before the work and not after it.
        write_whole(&unfinished, &encoded_state(key, &state))?;
        let result = work.run(&mut state, watch, &mut |state| {
            if last.elapsed() >= EVERY {
                write_whole(&unfinished, &encoded_state(key, state))?;
                last = Instant::now();
            }
            Ok(())
        });
        if matches!(result, Err(Error::Stopped)) {
            write_whole(&unfinished, &encoded_state(key, &state))?;
        }
        result?;
        let transfer = work.finished(state);
        write_whole(&path, &encoded(key, &transfer))?;
        // It is of no use any more; that it may stay changes nothing.
        let _ = fs::remove_file(&unfinished);
        Ok(Kept { transfer, was_kept: false, path, notes })
    }

    /// Where a stopped bake was, or the beginning.
    fn begun(&self, key: Key, work: &Work, notes: &mut Vec<String>) -> Result<State, Error> {
        let path = self.unfinished_path(key);
        let Some(bytes) = read(&path)? else { return Ok(State::default()) };
        let state = decoded_state(key, &bytes).filter(|state| work.fits(state));
        notes.push(match &state {
            Some(_) => format!("{}: the bake that was stopped is continued", path.display()),
            None => damaged(&path),
        });
        Ok(state.unwrap_or_default())
    }
}

fn damaged(path: &Path) -> String {
    format!("{}: the file is damaged, or of another version or scene; it is made anew", path.display())
}

fn read(path: &Path) -> Result<Option<Vec<u8>>, Error> {
    match fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(reason) => Err(Error::File { path: path.to_path_buf(), reason }),
    }
}

/// Writes a file whole or not at all: beside its place first.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    write_with(path, |file| file.write_all(bytes))
}

fn write_with(path: &Path, write: impl FnOnce(&mut fs::File) -> io::Result<()>) -> Result<(), Error> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let failed = |reason| Error::File { path: path.to_path_buf(), reason };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.map_or(Ok(()), fs::create_dir_all).map_err(failed)?;
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let beside = path.with_extension(format!("{}.{number}.part", std::process::id()));
    let written = fs::File::create(&beside).and_then(|mut file| {
        write(&mut file)?;
        file.sync_all()
    });
    written.and_then(|()| fs::rename(&beside, path)).map_err(|error| {
        // What could not be written whole is of no use; that it may stay changes nothing.
        let _ = fs::remove_file(&beside);
        failed(error)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_leaves_what_was_there_and_nothing_else() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("x.transfer");
        write_whole(&path, b"before").unwrap();
        let full = |file: &mut fs::File| {
            file.write_all(b"half of")?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        };
        let error = write_with(&path, full).unwrap_err().to_string();
        assert!(error.contains("x.transfer") && error.contains("room"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"before");
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    }
}

//! Output that is whole or absent: places are checked before the work, files written beside and
//! renamed.

use crate::error::Error;
use serde_json::Value;
use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};
use umbrage_io::pictures::save_bytes;

/// A folder to write to.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Makes sure that files can be written there, before long work starts. A folder that is
    /// missing is made with the first file, so that work that fails leaves nothing behind.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn check(path: &Path) -> Result<Self, Error> {
        let nearest = path.ancestors().map(or_here).find(|p| p.exists()).unwrap_or(path);
        check_folder(nearest)?;
        Ok(Self { path: path.to_path_buf() })
    }

    /// Path of a file in it; `name` may hold folders, with `/`.
    pub fn path(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// The pictures that the record of an earlier run into this folder names.
    pub(crate) fn pictures_of(&self, record: &str) -> BTreeSet<String> {
        let text = fs::read(self.path(record)).unwrap_or_default();
        let mut names = BTreeSet::new();
        add_pictures(&serde_json::from_slice(&text).unwrap_or_default(), &mut names);
        names
    }

    /// The plots of an earlier sweep into this folder, which its record does not name.
    pub(crate) fn plots_of(&self, record: &str) -> BTreeSet<String> {
        let is_plot = |name: &String| name.contains("-light") && name.ends_with(".svg");
        let entries = self.path(record).is_file().then(|| fs::read_dir(self.path("plots")));
        let files = entries.into_iter().flatten().flatten().flatten();
        let names = files.map(|file| file.file_name().to_string_lossy().into_owned());
        names.filter(is_plot).map(|name| format!("plots/{name}")).collect()
    }

    /// Removes pictures of an earlier run that this one has not written anew.
    pub(crate) fn remove(&self, earlier: BTreeSet<String>, is_new: impl Fn(&str) -> bool) {
        for name in earlier.iter().filter(|name| !is_new(name)) {
            // One that is gone already, or stays, harms nobody.
            let _ = fs::remove_file(self.path(name));
        }
    }

    /// Writes a file whole or not at all.
    ///
    /// # Errors
    /// [`Error::Output`] and [`Error::File`].
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        let path = self.path(name);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(|e| Error::output(parent, e))?;
        }
        Ok(save_bytes(&path, bytes)?)
    }
}

/// Collects the names of files right below `pictures/`.
fn add_pictures(value: &Value, names: &mut BTreeSet<String>) {
    match value {
        Value::String(name) => {
            let plain = |rest: &str| !rest.contains(['/', '\\']);
            if name.strip_prefix("pictures/").is_some_and(plain) {
                names.insert(name.clone());
            }
        }
        Value::Array(values) => values.iter().for_each(|v| add_pictures(v, names)),
        Value::Object(values) => values.values().for_each(|v| add_pictures(v, names)),
        _ => {}
    }
}

/// Makes sure that `path` can be written as a file, before long work starts.
///
/// # Errors
/// [`Error::Output`] where it is a folder, or where its folder is missing or can't be written to.
pub fn check_file(path: &Path) -> Result<(), Error> {
    if path.is_dir() {
        return Err(Error::output(path, "it is a folder, not a file"));
    }
    let folder = folder_of(path);
    if !folder.is_dir() {
        return Err(Error::output(path, format!("there is no folder {}", folder.display())));
    }
    check_folder(folder)
}

fn check_folder(folder: &Path) -> Result<(), Error> {
    let probe = folder.join(format!(".umbrage-probe-{}", std::process::id()));
    fs::write(&probe, b"").and_then(|()| fs::remove_file(&probe)).map_err(|e| Error::output(folder, e))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().map_or(Path::new("."), or_here)
}

/// The path, where the empty one is the current folder.
fn or_here(path: &Path) -> &Path {
    if path.as_os_str().is_empty() { Path::new(".") } else { path }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_written_whole_and_nothing_else_stays() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::check(&place.path().join("a/b")).unwrap();
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 0, "the check left something");
        folder.write("pictures/x.png", b"one").unwrap();
        folder.write("pictures/x.png", b"two").unwrap();
        assert_eq!(fs::read(folder.path("pictures/x.png")).unwrap(), b"two");
        assert_eq!(fs::read_dir(folder.path("pictures")).unwrap().count(), 1);
        assert_eq!(fs::read_dir(place.path().join("a/b")).unwrap().count(), 1, "the probe stayed");
    }

    #[test]
    fn pictures_of_an_earlier_run_go_and_others_stay() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::check(place.path()).unwrap();
        for name in ["pictures/old.png", "pictures/both.png", "pictures/mine.png", "mine.png"] {
            folder.write(name, b"").unwrap();
        }
        let record = r#"{"a": ["pictures/old.png", {"b": "pictures/both.png"}], "c": "pictures/../mine.png"}"#;
        folder.write("report.json", record.as_bytes()).unwrap();
        let earlier = folder.pictures_of("report.json");
        folder.remove(earlier, |name| name == "pictures/both.png");
        let is_there = |name: &str| folder.path(name).exists();
        assert!(!is_there("pictures/old.png") && is_there("pictures/both.png"));
        assert!(is_there("pictures/mine.png") && is_there("mine.png"));
    }

    #[test]
    fn a_file_in_the_way_is_named() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("file");
        fs::write(&file, b"").unwrap();
        let text = Folder::check(&file.join("deeper")).unwrap_err().to_string();
        assert!(text.contains("file") && text.contains("can't write"), "{text}");
        assert!(check_file(place.path()).unwrap_err().to_string().contains("folder"));
        assert!(check_file(&place.path().join("none/x.png")).unwrap_err().to_string().contains("none"));
        assert!(check_file(&place.path().join("x.png")).is_ok());
    }
}

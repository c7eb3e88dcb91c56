//! The one error of this crate: what is wrong, where, and what helps.

use crate::limits::MOST_BYTES;
use crate::text;
use std::fmt::{self, Display};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// What went wrong with a file. Displayed as one line: file, place, what, remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{place}: {what}{}", shown(.file), .remedy.as_ref().map(|r| format!("; {r}")).unwrap_or_default())]
pub struct Error {
    /// The file.
    pub file: PathBuf,
    /// Where in the file.
    pub place: Place,
    /// What is wrong there.
    pub what: String,
    /// What to do about it, where something is known to help.
    pub remedy: Option<String>,
}

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line, and in it a column where known; both from 1.
    Line(usize, Option<usize>),
    /// A part with a name, such as `mesh 3, primitive 0`.
    Part(String),
}

impl Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Line(line, None) => write!(f, ":{line}"),
            Self::Line(line, Some(column)) => write!(f, ":{line}:{column}"),
            Self::Part(part) => write!(f, ": {}", line(part)),
        }
    }
}

impl Error {
    /// An error of the file as a whole.
    pub fn new(file: impl Into<PathBuf>, what: impl Display) -> Self {
        Self { file: file.into(), place: Place::File, what: line(&what.to_string()), remedy: None }
    }

    /// The same error at `place`.
    pub fn at(self, place: Place) -> Self {
        Self { place, ..self }
    }

    /// The same error with a remedy.
    pub fn remedy(self, remedy: impl Into<String>) -> Self {
        Self { remedy: Some(line(&remedy.into())), ..self }
    }

    /// The same error in the words of `inner`, about a file that this one names, with its remedy.
    pub(crate) fn passing_on(self, inner: &Self) -> Self {
        let what = line(&format!("{} {}", self.what, Self { remedy: None, ..inner.clone() }));
        Self { what, remedy: inner.remedy.clone().or(self.remedy), ..self }
    }

    /// The same error with the known name nearest to `name` as its remedy, or all of them where
    /// none is near.
    pub fn did_you_mean<'a>(self, name: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        let known: Vec<&str> = known.into_iter().collect();
        match nearest(name, known.iter().copied()) {
            Some(near) => self.remedy(format!("did you mean `{near}`?")),
            None => self.remedy(format!("known are: {}", known.join(", "))),
        }
    }
}

/// The name out of `known` that `name` is probably a slip of, if any.
fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let lower = name.to_lowercase();
    let score = |k: &str| strsim::jaro_winkler(&lower, &k.to_lowercase());
    known.map(|k| (score(k), k)).filter(|(s, _)| *s > 0.8).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k)
}

/// Longer parts of a message repeat a damaged file, and are cut off.
const LONGEST: usize = 600;

/// A part of a message on one line, whatever files and other crates put into it.
pub(crate) fn line(text: &str) -> String {
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    text::printable(&words, LONGEST).into_owned()
}

/// The name of a file as messages show it.
pub(crate) fn shown(path: &Path) -> String {
    text::printable(&path.to_string_lossy(), LONGEST).into_owned()
}

/// True where nothing at all has this name.
pub(crate) fn is_missing(path: &Path) -> bool {
    std::fs::metadata(path).is_err_and(|e| e.kind() == ErrorKind::NotFound)
}

/// The bytes of a file. Where it is missing, the error names the file beside it with the nearest
/// name. Devices and pipes are refused: they may have no end.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Error> {
    let about = std::fs::metadata(path).map_err(|e| unreadable(path, &e))?;
    if about.is_dir() {
        return Err(Error::new(path, "cannot be read: it is a folder").remedy("name a file in it"));
    }
    if !about.is_file() {
        let error = Error::new(path, "cannot be read: it is a device, a pipe or a socket");
        return Err(error.remedy("save what it holds as a file, and name that"));
    }
    if about.len() > MOST_BYTES {
        let what = format!("is {} bytes long; at most {MOST_BYTES} are read", about.len());
        return Err(Error::new(path, what).remedy("split it, or export less into it"));
    }
    std::fs::read(path).map_err(|e| unreadable(path, &e))
}

fn unreadable(path: &Path, e: &std::io::Error) -> Error {
    let error = Error::new(path, format!("cannot be read: {e}"));
    if e.kind() != ErrorKind::NotFound {
        return error.remedy("check the path and its permissions");
    }
    let dir = path.parent().filter(|d| !d.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let beside: Vec<String> = std::fs::read_dir(dir)
        .map(|entries| entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()).collect())
        .unwrap_or_default();
    match nearest(&name, beside.iter().map(String::as_str)) {
        Some(near) => error.remedy(format!("did you mean `{near}`?")),
        None => error.remedy("check the path"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_one_line_with_file_place_what_and_remedy() {
        let e = Error::new("a.toml", "unknown\n key").at(Place::Line(3, Some(7)));
        assert_eq!(e.to_string(), "a.toml:3:7: unknown key");
        let e = e.did_you_mean("raduis", ["position", "radius"]);
        assert_eq!(e.to_string(), "a.toml:3:7: unknown key; did you mean `radius`?");
        let e = e.did_you_mean("xyz", ["position", "radius"]);
        assert_eq!(e.to_string(), "a.toml:3:7: unknown key; known are: position, radius");
    }

    #[test]
    fn an_error_is_short_and_harmless_whatever_it_repeats() {
        let e = Error::new("a\u{1b}[31m.obj", "x".repeat(9999)).at(Place::Part("mesh \u{7}".repeat(999)));
        let e = e.did_you_mean(&"y".repeat(9999), ["\u{9b}2J"]).to_string();
        assert!(e.starts_with("a\\u{1b}[31m.obj: mesh \\u{7}mesh"), "{e}");
        assert!(e.len() < 2500 && !e.contains(char::is_control), "{e}");
    }

    #[cfg(unix)]
    #[test]
    fn only_regular_files_are_read() {
        for (path, part) in [("/dev/zero", "is a device"), ("/dev", "is a folder; name a file in it")] {
            let e = read(Path::new(path)).unwrap_err().to_string();
            assert!(e.contains(part), "{e}");
        }
    }

    #[test]
    fn a_missing_file_is_reported_with_the_nearest_name() {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("bunny.obj"), "").unwrap();
        let e = read(&dir.path().join("buny.obj")).unwrap_err().to_string();
        assert!(e.contains("buny.obj: cannot be read") && e.ends_with("did you mean `bunny.obj`?"), "{e}");
    }
}

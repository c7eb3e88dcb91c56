//! Where files are read from: the file system, or bytes that are at hand under their names.

use crate::error::{self, Error, shown};
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// Files by their names, with `/` between folders: what was dropped on a window or a page.
pub type Bytes = BTreeMap<String, Vec<u8>>;

/// Where a path leads.
#[derive(Clone, Copy)]
pub(crate) enum Files<'a> {
    OnDisk,
    AtHand(&'a Bytes),
}

impl Files<'_> {
    /// The bytes of a file.
    pub fn read(self, path: &Path) -> Result<Vec<u8>, Error> {
        match self {
            Self::OnDisk => error::read(path),
            Self::AtHand(bytes) => at_hand(bytes, path).map(|(_, bytes)| bytes.clone()).ok_or_else(|| {
                let error = Error::new(path, "is not among the files that were given");
                error.remedy(format!("give `{}` together with the others", shown(path)))
            }),
        }
    }

    /// True where nothing at all has this name.
    pub fn is_missing(self, path: &Path) -> bool {
        match self {
            Self::OnDisk => error::is_missing(path),
            Self::AtHand(bytes) => at_hand(bytes, path).is_none(),
        }
    }

    /// One name for a file that may be named in several ways.
    pub fn one_name(self, path: &Path) -> PathBuf {
        let name = match self {
            Self::OnDisk => path.canonicalize().ok(),
            Self::AtHand(bytes) => at_hand(bytes, path).map(|(name, _)| name.into()),
        };
        name.unwrap_or_else(|| path.to_path_buf())
    }
}

/// The file that a path names, without regard to `.` and `..`, or else the only one of the same
/// name in whatever folder: browsers drop files without their folders.
fn at_hand<'a>(bytes: &'a Bytes, path: &Path) -> Option<(&'a String, &'a Vec<u8>)> {
    let wanted = plain(path);
    let named = || bytes.iter().filter(|(name, _)| plain(Path::new(name)) == wanted);
    let alike = || bytes.iter().filter(|(name, _)| Path::new(name).file_name() == wanted.file_name());
    let only = |mut found: Box<dyn Iterator<Item = _> + 'a>| found.next().filter(|_| found.next().is_none());
    named().next().or_else(|| only(Box::new(alike().collect::<Vec<_>>().into_iter())))
}

/// A path without `.`, and without `..` where a folder stands before it.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if plain.file_name().is_some() => {
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(names: &[&str], path: &str) -> Option<String> {
        let bytes: Bytes = names.iter().map(|name| ((*name).to_string(), Vec::new())).collect();
        at_hand(&bytes, Path::new(path)).map(|(name, _)| name.clone())
    }

    #[test]
    fn a_file_is_found_by_its_path_or_by_a_name_that_no_other_has() {
        let names = ["a/room.obj", "a/wood.png", "b/wood.png", "leaf.png"];
        assert_eq!(found(&names, "a/./x/../wood.png").as_deref(), Some("a/wood.png"));
        assert_eq!(found(&names, "textures/leaf.png").as_deref(), Some("leaf.png"));
        assert_eq!(found(&names, "room.obj").as_deref(), Some("a/room.obj"));
        assert_eq!(found(&names, "c/wood.png"), None);
        assert_eq!(found(&names, ""), None);
    }
}

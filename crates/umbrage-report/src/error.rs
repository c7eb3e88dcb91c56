//! What can go wrong around a comparison, each in one line with the remedy.

use std::path::{Path, PathBuf};

/// An error of a run. Its text is one line that says what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file or folder of the output can't be written.
    #[error("{}: can't write here ({reason}); choose another place with -o", path.display())]
    Output {
        /// Where.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// A name that is not known.
    #[error("{0}")]
    Name(String),
    /// The scene can't be used for this.
    #[error("{scene}: {reason}")]
    Scene {
        /// Name or path as given.
        scene: String,
        /// What is wrong, and the remedy.
        reason: String,
    },
    /// A scene file, a model or a picture can't be read.
    #[error(transparent)]
    File(#[from] umbrage_io::Error),
    /// The graphics library refused.
    #[error(transparent)]
    Gpu(#[from] umbrage::Error),
    /// A transfer can't be baked.
    #[cfg(not(target_family = "wasm"))]
    #[error(transparent)]
    Bake(#[from] umbrage_bake::Error),
    /// Pictures can't be compared.
    #[error(transparent)]
    Metrics(#[from] umbrage_metrics::Error),
}

impl Error {
    /// An [`Error::Output`] for `path`.
    pub fn output(path: &Path, reason: impl ToString) -> Self {
        Self::Output { path: path.to_path_buf(), reason: reason.to_string() }
    }

    /// An [`Error::Name`] for a word that is none of `names`.
    pub(crate) fn one_of(word: &str, names: &[&str]) -> Self {
        let guess = umbrage::nearest(word, names.iter().copied());
        let guess = guess.map_or(String::new(), |name| format!("; did you mean `{name}`?"));
        Self::Name(format!("write one of {}{guess}", names.join(", ")))
    }

    /// An [`Error::Scene`].
    pub fn scene(scene: &str, reason: impl ToString) -> Self {
        Self::Scene { scene: scene.into(), reason: reason.to_string() }
    }
}

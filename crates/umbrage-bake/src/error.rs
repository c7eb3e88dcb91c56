//! What can go wrong.

use std::path::PathBuf;

/// Why nothing was baked, or nothing kept. The text names what, and the remedy.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A setting out of its range.
    #[error("the bake can't be done: {0}")]
    Settings(String),
    /// A scene that can't be baked.
    #[error("the scene can't be baked: {0}")]
    Scene(String),
    /// Whoever watched wanted no more. What was done is kept where there is a folder.
    #[error("the bake was stopped; started again with the same folder, it continues")]
    Stopped,
    /// A file or folder that can't be read or written. Nothing is half written.
    #[error("{}: {reason}; is there room, and may it be written?", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// What the system says.
        reason: std::io::Error,
    },
}

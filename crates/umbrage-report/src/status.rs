//! How cells end.

use crate::error::Error;
use serde::Serialize;

/// How a technique's cell ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// Rendered and scored.
    Ok,
    /// The technique can't do this light; `reason` says so.
    Unsupported,
    /// Something went wrong; `reason` says what.
    Failed,
}

impl Status {
    /// Of a cell that met this error, and why.
    pub(crate) fn of(error: &Error) -> (Self, String) {
        match error {
            Error::Gpu(umbrage::Error::Unsupported { what, .. }) => (Self::Unsupported, format!("not for {what}")),
            other => (Self::Failed, other.to_string()),
        }
    }
}

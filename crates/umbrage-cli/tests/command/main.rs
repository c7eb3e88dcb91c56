//! The command as its users run it.

mod broken_input;
mod common;
mod listing;
mod pictures;
mod readme;
mod sweep;

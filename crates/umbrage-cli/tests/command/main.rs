//! The command as its users run it.

mod bake;
mod broken_input;
mod common;
mod docs;
mod listing;
mod pictures;
mod streams;
mod sweep;
mod truth_cache;

//! Pictures in and out of files.

mod load;

pub use load::{load_texture, texture_from_bytes};

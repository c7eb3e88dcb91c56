//! The laboratory without a window. Needs a graphics adapter.

mod bad;
mod common;
mod first;
mod see;
mod keep;
mod walk;

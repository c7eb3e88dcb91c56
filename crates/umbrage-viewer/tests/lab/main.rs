//! The laboratory without a window. Needs a graphics adapter.

mod bad;
mod common;
mod first;
mod hands;
mod keep;
mod see;
mod soak;
mod walk;

//! Tests that draw: they need a graphics adapter, a software one will do.

mod cache;
mod common;
mod filters;
mod golden;
mod host;
mod layouts;
mod penumbra;
mod poses;
mod robust;
mod shared_references;
mod steady;
mod volume;

//! Tests that draw: they need a graphics adapter, a software one will do.

mod cache;
mod cascaded;
mod common;
mod dark;
mod filters;
mod golden;
mod host;
mod layouts;
mod light_mask;
mod limits;
mod masks;
mod outside;
mod own_maps;
mod pcf_blur;
mod penumbra;
mod poses;
mod robust;
mod settings;
mod shared_references;
mod solids;
mod steady;
mod volume;
mod warped;
mod wedges;
mod wedges_tables;
mod wedges_views;

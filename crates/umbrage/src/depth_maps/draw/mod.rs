//! From views to maps: chooses what each layer has to draw, keeps what did not change, and draws
//! the rest.

mod cache;
mod caster_pass;
mod drawer;
mod edge_pass;
mod layer;
mod layouts;
mod movers;
mod pipelines;
mod submission;
mod textures;
mod view;

pub use caster_pass::CasterPass;
pub(super) use drawer::Drawer;
pub use edge_pass::{EdgeDraw, EdgePass, EdgeTarget};
pub(super) use pipelines::SHADERS;
pub(super) use view::SHARED;

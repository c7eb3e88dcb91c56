//! From views to maps: chooses what each layer has to draw, keeps what did not change, and draws
//! the rest.

mod cache;
mod caster_pass;
mod contour;
mod drawer;
mod edge_pass;
mod layer;
mod layouts;
mod movers;
mod pipelines;
mod textures;
mod view;

use crate::shader::Shared;
pub use caster_pass::CasterPass;
pub(crate) use contour::CONTOUR_SHADER;
pub(super) use drawer::Drawer;
pub use edge_pass::{EdgeDraw, EdgePass, EdgeTarget};
pub(super) use pipelines::SHADERS;
pub(super) const SHARED: [Shared; 3] = [view::SHARED, contour::SHARED, contour::SHARED_EDGES];

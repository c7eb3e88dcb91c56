//! The scene's triangles on the GPU, drawn in as few calls as there are meshes.
//!
//! All meshes share one vertex and one index buffer. Instances lie in a storage buffer, relative to
//! the middle of the scene, so that single precision is enough wherever the scene is. A draw is one
//! mesh with a list of instance numbers as its per-instance vertex buffer: culling writes that list
//! alone.

mod batches;
mod before_eye;
mod changed;
mod check;
mod draw_list;
mod drawn_by_host;
mod edges;
mod extents;
mod eye_tree;
mod follow;
mod form;
mod geometry;
mod host;
mod ids;
mod instances;
mod journal;
mod lending;
mod lent;
mod looks;
mod material;
mod moves;
mod pipeline;
mod placed;
mod places;
mod planes;
mod poses;
#[cfg(test)]
mod read_back;
mod record;
mod region;
mod seen;
mod sides;
mod store;
mod things;
mod vertices;
mod world;
pub(crate) use before_eye::before_eye;
pub(crate) use draw_list::{DrawList, InstanceNumbers, Light, Surface};
pub(crate) use edges::{Edges, MeshEdges, Reads};
pub(crate) use eye_tree::largest_stretch;
pub(crate) use form::{ByForm, Form};
pub use geometry::Vertices;
pub(crate) use host::refuse as refuse_host_casters;
pub use host::{CasterView, HostCasters, Needs};
pub use ids::{InstanceId, MaterialId, MeshId, TextureId};
pub use instances::Placement;
pub use lent::{LentIndices, LentInstances, LentMatrices, LentMesh, LentShape, LentVertices, MatrixForm};
pub(crate) use material::texture_layout;
pub(crate) use pipeline::CasterDraw;
pub(crate) use placed::Placed;
pub(crate) use places::Places;
pub(crate) use planes::{ScenePlane, ScenePlanes};
pub use seen::{SeenCasters, SeenSurface};
pub use world::Casters;

use crate::shader::{Shader, Shared};

/// What the host has to agree on with the modules of this folder.
pub(crate) const SHARED: &[Shared] = &[placed::SHARED, material::SHARED, edges::SHARED, poses::SHARED];

/// All shaders of this folder.
pub(crate) fn shaders() -> impl Iterator<Item = &'static Shader> {
    poses::SHADERS.iter().chain(lent::SHADERS)
}

//! Vertices, indices and instances in buffers of a host's own, which the library draws from where
//! they are.

mod bounds;
mod check;
mod follow;
mod instances;
mod mesh;

pub(super) use bounds::check_bounds;
pub(super) use check::{check_instances, check_mesh};
pub(super) use follow::Following;
pub(crate) use follow::SHADERS;
pub(super) use instances::Many;
pub use instances::{LentInstances, LentMatrices, MatrixForm};
pub(crate) use mesh::Lent;
pub use mesh::{LentIndices, LentMesh, LentShape, LentVertices};

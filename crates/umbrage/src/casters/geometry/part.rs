//! One mesh: where it lies, and what the CPU knows of it.

use crate::casters::form::{Form, Stream, Uvs};
use crate::casters::lent::{Lent, LentMatrices};
use std::{ops::Range, sync::Arc};
use umbrage_core::glam::DVec4;
use umbrage_core::{Bounds, Mesh};

/// A mesh and where it lies in the shared buffers.
pub(crate) struct MeshPart {
    /// Without appearance where it has no joints; of a posed instance as it was bound. Empty where
    /// nothing is.
    pub mesh: Arc<Mesh>,
    pub first_index: u32,
    pub base_vertex: u32,
    /// Another one after every change of its vertices or triangles; 0 where nothing is.
    pub version: u64,
    /// Of a posed instance's own mesh, the mesh that it is made of.
    pub source: Option<u32>,
    /// Where it is drawn from, where that is not here. Vertices and triangles that are known are
    /// here as well, for edges.
    pub lent: Option<Lent>,
    pub bounds: Bounds,
    pub(in crate::casters) plane: Option<DVec4>,
    /// It is the surface of a convex body.
    pub(in crate::casters) solid: bool,
    /// What tells its place in the order of draws.
    pub(in crate::casters) order: u64,
    /// Of one that has been deformed: its indices with one vertex for all at a place.
    pub(super) welded: Option<Vec<u32>>,
    /// Where its weights lie, see [`weights`].
    pub(in crate::casters) weights: Range<u32>,
    /// Places of the instances that it is the mesh of.
    pub(in crate::casters) members: Vec<u32>,
    /// How many of them cast shadows.
    pub(in crate::casters) casting: u32,
    pub(super) vertices: Range<u32>,
    pub(super) indices: Range<u32>,
}

impl MeshPart {
    pub(super) fn nothing() -> Self {
        Self {
            mesh: Arc::default(),
            first_index: 0,
            base_vertex: 0,
            version: 0,
            source: None,
            lent: None,
            bounds: Bounds::EMPTY,
            plane: None,
            solid: false,
            order: 0,
            welded: None,
            weights: 0..0,
            members: Vec::new(),
            casting: 0,
            vertices: 0..0,
            indices: 0..0,
        }
    }

    /// How many indices are drawn.
    pub fn index_count(&self) -> u32 {
        self.lent.as_ref().map_or(self.mesh.indices.len() as u32, |lent| lent.indices.range.len() as u32)
    }

    /// The GPU alone knows where its vertices are.
    pub fn is_moving(&self) -> bool {
        self.lent.as_ref().is_some_and(|lent| lent.is_moving)
    }

    /// Nobody knows its triangles.
    pub fn is_unknown(&self) -> bool {
        self.lent.as_ref().is_some_and(|lent| lent.is_unknown)
    }

    /// Indices to draw, of the buffer that [`Geometry::bind`] binds.
    pub(in crate::casters) fn drawn(&self) -> Range<u32> {
        match &self.lent {
            Some(lent) => lent.indices.range.clone(),
            None => self.first_index..self.first_index + self.mesh.indices.len() as u32,
        }
    }

    /// What is added to these.
    pub(in crate::casters) fn drawn_from(&self) -> i32 {
        self.lent.as_ref().map_or(self.base_vertex, |lent| lent.indices.base_vertex) as i32
    }

    /// The buffers that are drawn from.
    pub(in crate::casters) fn form(&self, matrices: Option<&LentMatrices>) -> Form {
        let matrices = matrices.map(|m| (m.form, m.stride));
        let Some(lent) = &self.lent else { return Form { matrices, ..Form::OWN } };
        let uvs = lent.uvs.as_ref().map_or(Uvs::Nothing, |uvs| Uvs::Lent(Stream::of(uvs)));
        Form { positions: Stream::of(&lent.positions), uvs, matrices }
    }
}

/// Where the vertices of an instance lie in the library's buffers. They may lie elsewhere after
/// meshes or instances came or went: ask again in every frame.
#[derive(Clone, Copy, Debug)]
pub struct Vertices<'a> {
    /// Three 32-bit floats each, in mesh space; of an instance with joints as these have bent it.
    pub positions: wgpu::BufferSlice<'a>,
    /// Six 32-bit floats each: the normal, the texture coordinate, and the opacity.
    pub attributes: wgpu::BufferSlice<'a>,
    /// Three 32-bit numbers a triangle, the first vertex being 0.
    pub indices: wgpu::BufferSlice<'a>,
    /// How many vertices there are.
    pub vertex_count: u32,
    /// How many indices there are.
    pub index_count: u32,
}

//! Meshes that a host lends, and what of the library's a host may read.

use super::{Geometry, MeshPart, Vertices};
use crate::casters::form::{ATTRIBUTES, POSITIONS};
use crate::casters::journal::Journal;
use crate::casters::lent::{Lent, LentMesh, LentShape};
use crate::{error::Error, gpu::Gpu};
use std::{ops::Range, sync::Arc};
use umbrage_core::{Bounds, Mesh, solid::is_convex_solid};

impl Geometry {
    /// Adds a mesh that is lent; its number.
    pub fn lend(&mut self, gpu: &Gpu, journal: &mut Journal, mesh: &LentMesh<'_>) -> Result<u32, Error> {
        let parts = self.take(gpu, journal, counts(mesh))?;
        let number = self.slot();
        self.changes += 1;
        self.meshes[number as usize] = MeshPart { order: self.changes, ..MeshPart::nothing() };
        self.fill_lent(journal, number, mesh, parts);
        Ok(number)
    }

    /// Puts a mesh that is lent in the place of one, which stays as it is where there is an error.
    pub fn lend_again(
        &mut self,
        gpu: &Gpu,
        journal: &mut Journal,
        number: u32,
        mesh: &LentMesh<'_>,
    ) -> Result<(), Error> {
        let parts = self.take(gpu, journal, counts(mesh))?;
        self.clear(number);
        self.fill_lent(journal, number, mesh, parts);
        Ok(())
    }

    /// What is known of a mesh that is lent.
    fn fill_lent(
        &mut self,
        journal: &mut Journal,
        number: u32,
        mesh: &LentMesh<'_>,
        [vertices, indices]: [Range<u32>; 2],
    ) {
        self.changes += 1;
        let part = &mut self.meshes[number as usize];
        (part.first_index, part.base_vertex) = (indices.start, vertices.start);
        (part.vertices, part.indices) = (vertices, indices);
        (part.version, part.welded) = (self.changes, None);
        part.lent = Some(Lent::of(mesh));
        part.bounds = mesh.shape.bounds();
        (part.plane, part.solid) = match mesh.shape {
            LentShape::Rigid(known) => (known.plane(), is_convex_solid(known)),
            _ => (None, false),
        };
        let known = mesh.shape.mesh().map(|known| Mesh {
            positions: known.positions.clone(),
            indices: known.indices.clone(),
            ..Mesh::default()
        });
        let known = known.unwrap_or_default();
        self.positions.write(journal, part.base_vertex, &known.positions);
        self.indices.write(journal, part.first_index, &known.indices);
        part.mesh = Arc::new(known);
    }

    /// Has draws read the vertices and indices of a mesh, in buffers as [`MeshPart::form`] says.
    pub fn bind(&self, pass: &mut wgpu::RenderPass<'_>, part: &MeshPart, reads_uvs: bool) {
        let Some(Lent { positions, uvs, indices, .. }) = &part.lent else {
            pass.set_vertex_buffer(POSITIONS, self.positions.buffer().slice(..));
            pass.set_vertex_buffer(ATTRIBUTES, self.attributes.buffer().slice(..));
            // Small meshes cost what their vertices cost, and a box has three times as many as
            // places.
            let indices = if reads_uvs { &self.indices } else { &self.welded };
            pass.set_index_buffer(indices.buffer().slice(..), wgpu::IndexFormat::Uint32);
            return;
        };
        pass.set_vertex_buffer(POSITIONS, positions.buffer.slice(positions.offset..));
        match uvs {
            Some(uvs) => pass.set_vertex_buffer(ATTRIBUTES, uvs.buffer.slice(uvs.offset..)),
            None => pass.set_vertex_buffer(ATTRIBUTES, self.nothing.slice(..)),
        }
        pass.set_index_buffer(indices.buffer.slice(..), indices.format);
    }

    /// Where draws of a host's own find a mesh.
    pub fn vertices(&self, part: &MeshPart) -> Vertices<'_> {
        let (vertex_count, index_count) = (part.mesh.positions.len() as u32, part.index_count());
        Vertices {
            positions: self.positions.slice(part.base_vertex, vertex_count),
            attributes: self.attributes.slice(part.base_vertex, vertex_count),
            indices: self.indices.slice(part.first_index, index_count),
            vertex_count,
            index_count,
        }
    }

    /// Another box around a lent mesh that has moved.
    pub fn touch(&mut self, number: u32, bounds: Bounds) {
        self.changes += 1;
        let part = &mut self.meshes[number as usize];
        (part.version, part.bounds) = (self.changes, bounds);
    }
}

/// Vertices and indices that there has to be room for.
fn counts(mesh: &LentMesh<'_>) -> [usize; 2] {
    mesh.shape.mesh().map_or([0; 2], |known| [known.positions.len(), known.indices.len()])
}

//! The meshes in shared buffers: where each lies, and what the CPU knows of it.

use super::form::{ATTRIBUTES, Form, POSITIONS, Stream, Uvs};
use super::ids::Slots;
use super::journal::Journal;
use super::lent::{Lent, LentMatrices, LentMesh, LentShape};
use super::store::{Parts, Store};
use super::vertices::{attributes, weights};
use crate::{error::Error, gpu::Gpu};
use std::{ops::Range, sync::Arc};
use umbrage_core::glam::DVec4;
use umbrage_core::{Bounds, Mesh, solid::is_convex_solid};

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
    pub(super) bounds: Bounds,
    pub(super) plane: Option<DVec4>,
    /// It is the surface of a convex body.
    pub(super) solid: bool,
    /// What tells its place in the order of draws.
    pub(super) order: u64,
    /// Where its weights lie, see [`weights`].
    pub(super) weights: Range<u32>,
    /// Places of the instances that it is the mesh of.
    pub(super) members: Vec<u32>,
    /// How many of them cast shadows.
    pub(super) casting: u32,
    vertices: Range<u32>,
    indices: Range<u32>,
}

impl MeshPart {
    fn nothing() -> Self {
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
    pub(super) fn drawn(&self) -> Range<u32> {
        match &self.lent {
            Some(lent) => lent.indices.range.clone(),
            None => self.first_index..self.first_index + self.mesh.indices.len() as u32,
        }
    }

    /// What is added to these.
    pub(super) fn drawn_from(&self) -> i32 {
        self.lent.as_ref().map_or(self.base_vertex, |lent| lent.indices.base_vertex) as i32
    }

    /// The buffers that are drawn from.
    pub(super) fn form(&self, matrices: Option<&LentMatrices>) -> Form {
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

/// All meshes.
pub(super) struct Geometry {
    pub positions: Store,
    pub attributes: Store,
    pub indices: Store,
    /// The same with one vertex for all at its place: for draws that need nothing but places.
    pub welded: Store,
    /// Joints and weights of the meshes that have some.
    pub weights: Store,
    /// By number: those of scenes and hosts, and those of posed instances.
    pub meshes: Vec<MeshPart>,
    pub slots: Slots,
    /// Texture coordinates of lent meshes that have none.
    nothing: wgpu::Buffer,
    parts: [Parts; 3],
    changes: u64,
}

/// How much there has to be room for.
#[derive(Clone, Copy, Default)]
pub(super) struct Sizes {
    pub vertices: u64,
    pub indices: u64,
    pub weights: u64,
}

impl Geometry {
    pub fn new(gpu: &Gpu, of: u32, sizes: Sizes) -> Result<Self, Error> {
        use wgpu::BufferUsages as Usage;
        // Only techniques that draw edges bind vertices to shaders, and say themselves what fits.
        let of_vertices = Usage::VERTEX | Usage::STORAGE;
        Ok(Self {
            positions: Store::drawn(gpu, ("positions", 12, sizes.vertices), of_vertices)?,
            attributes: Store::drawn(gpu, ("normals and texture coordinates", 24, sizes.vertices), of_vertices)?,
            indices: Store::drawn(gpu, ("indices", 4, sizes.indices), Usage::INDEX | Usage::STORAGE)?,
            welded: Store::drawn(gpu, ("welded indices", 4, sizes.indices), Usage::INDEX)?,
            weights: Store::new(gpu, "weights", 4, sizes.weights)?,
            meshes: Vec::new(),
            slots: Slots::new("mesh", of),
            nothing: gpu.buffer("no texture coordinates", &[0_f32; 4], Usage::VERTEX),
            parts: [Parts::new(), Parts::new(), Parts::new()],
            changes: 0,
        })
    }

    pub fn bytes(&self) -> u64 {
        let Self { positions, attributes, indices, welded, weights, .. } = self;
        [positions, attributes, indices, welded, weights].iter().map(|s| s.bytes()).sum()
    }

    /// Adds a mesh; its number.
    pub fn add(&mut self, gpu: &Gpu, journal: &mut Journal, mesh: &Mesh) -> Result<u32, Error> {
        check(mesh)?;
        let [vertices, indices, weights] = self.take_all(gpu, journal, mesh)?;
        let number = self.slot();
        self.changes += 1;
        self.meshes[number as usize] = MeshPart {
            first_index: indices.start,
            base_vertex: vertices.start,
            vertices,
            indices,
            weights,
            order: self.changes,
            ..MeshPart::nothing()
        };
        self.fill(journal, number, mesh);
        self.write_triangles(journal, number, mesh);
        Ok(number)
    }

    /// Room for the vertices, indices and weights of a mesh: for all or none.
    fn take_all(&mut self, gpu: &Gpu, journal: &mut Journal, mesh: &Mesh) -> Result<[Range<u32>; 3], Error> {
        let [mut vertices, mut indices] = self.take(gpu, journal, [mesh.positions.len(), mesh.indices.len()])?;
        match self.take_weights(gpu, journal, mesh) {
            Ok(weights) => Ok([vertices, indices, weights]),
            Err(e) => {
                self.give_back([&mut vertices, &mut indices]);
                Err(e)
            }
        }
    }

    /// Adds vertices for an instance whose mesh is bent; as they are filled by the GPU.
    pub fn add_posed(
        &mut self,
        gpu: &Gpu,
        journal: &mut Journal,
        source: u32,
        (posed, bounds): (&Mesh, Bounds),
    ) -> Result<u32, Error> {
        let [vertices, _] = self.take(gpu, journal, [posed.positions.len(), 0])?;
        let number = self.slot();
        self.changes += 1;
        let MeshPart { mesh, first_index, .. } = &self.meshes[source as usize];
        self.meshes[number as usize] = MeshPart {
            mesh: mesh.clone(),
            first_index: *first_index,
            base_vertex: vertices.start,
            version: self.changes,
            source: Some(source),
            bounds,
            vertices,
            order: self.changes,
            ..MeshPart::nothing()
        };
        self.write_vertices(journal, number, posed);
        Ok(number)
    }

    /// Puts another mesh in the place of one, which stays as it is where there is an error.
    pub fn replace(&mut self, gpu: &Gpu, journal: &mut Journal, number: u32, mesh: &Mesh) -> Result<(), Error> {
        check(mesh)?;
        let [vertices, indices, weights] = self.take_all(gpu, journal, mesh)?;
        self.clear(number);
        let part = &mut self.meshes[number as usize];
        (part.first_index, part.base_vertex) = (indices.start, vertices.start);
        (part.vertices, part.indices, part.weights) = (vertices, indices, weights);
        part.lent = None;
        self.fill(journal, number, mesh);
        self.write_triangles(journal, number, mesh);
        Ok(())
    }

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

    /// Gives the memory of a mesh back.
    fn clear(&mut self, number: u32) {
        let part = &mut self.meshes[number as usize];
        let old = [&mut part.vertices, &mut part.indices, &mut part.weights].map(std::mem::take);
        self.parts.iter_mut().zip(old).for_each(|(parts, part)| parts.give_back(part));
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
        part.version = self.changes;
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

    /// Gives a mesh other vertices, as many as it has.
    pub fn deform(&mut self, journal: &mut Journal, number: u32, mesh: &Mesh) {
        self.fill(journal, number, mesh);
        // Vertices that were in one place may have parted.
        let part = &self.meshes[number as usize];
        self.welded.write(journal, part.first_index, &mesh.welded_indices());
    }

    pub fn remove(&mut self, number: u32) {
        let removed = std::mem::replace(&mut self.meshes[number as usize], MeshPart::nothing());
        let parts = [removed.vertices, removed.indices, removed.weights];
        self.parts.iter_mut().zip(parts).for_each(|(parts, part)| parts.give_back(part));
        self.slots.remove(number);
    }

    /// A number with nothing there yet.
    fn slot(&mut self) -> u32 {
        let (number, _) = self.slots.insert();
        if number as usize == self.meshes.len() {
            self.meshes.push(MeshPart::nothing());
        }
        number
    }

    fn take(&mut self, gpu: &Gpu, journal: &mut Journal, counts: [usize; 2]) -> Result<[Range<u32>; 2], Error> {
        let [vertices, indices] = counts.map(|count| u32::try_from(count).unwrap_or(u32::MAX));
        let ends = [self.parts[0].end(), self.parts[1].end()];
        let (vertices, indices) = (self.parts[0].take(vertices), self.parts[1].take(indices));
        let mut taken = [vertices.clone().unwrap_or_default(), indices.clone().unwrap_or_default()];
        let mut fit = || {
            if vertices.is_none() || indices.is_none() {
                let size = ends.iter().zip(counts).map(|(end, count)| u64::from(*end) + count as u64).max();
                let limit = i32::MAX as u64;
                let what = "the number of vertices or indices".into();
                return Err(Error::Size { what, size: size.unwrap_or_default(), limit });
            }
            let (vertices, indices) = (u64::from(self.parts[0].end()), u64::from(self.parts[1].end()));
            self.attributes.check(vertices)?;
            self.positions.fit(gpu, vertices, journal)?;
            self.attributes.fit(gpu, vertices, journal)?;
            self.indices.fit(gpu, indices, journal)?;
            self.welded.fit(gpu, indices, journal)
        };
        if let Err(error) = fit() {
            let [vertices, indices] = &mut taken;
            self.give_back([vertices, indices]);
            return Err(error);
        }
        Ok(taken)
    }

    fn give_back(&mut self, parts: [&mut Range<u32>; 2]) {
        self.parts.iter_mut().zip(parts).for_each(|(parts, part)| parts.give_back(std::mem::take(part)));
    }

    fn take_weights(&mut self, gpu: &Gpu, journal: &mut Journal, mesh: &Mesh) -> Result<Range<u32>, Error> {
        let count = if mesh.weights.is_empty() { 0 } else { weights(mesh, 0).len() };
        let part = self.parts[2].take(u32::try_from(count).unwrap_or(u32::MAX)).ok_or_else(|| Error::Size {
            what: "the weights of all meshes".into(),
            size: count as u64,
            limit: i32::MAX as u64,
        })?;
        if let Err(error) = self.weights.fit(gpu, u64::from(self.parts[2].end()), journal) {
            self.parts[2].give_back(part);
            return Err(error);
        }
        if count > 0 {
            self.weights.write(journal, part.start, &weights(mesh, part.start));
        }
        Ok(part)
    }

    /// What is known of a mesh, and its vertices.
    fn fill(&mut self, journal: &mut Journal, number: u32, mesh: &Mesh) {
        self.changes += 1;
        let part = &mut self.meshes[number as usize];
        part.mesh = Arc::new(match mesh.weights.is_empty() {
            true => Mesh { positions: mesh.positions.clone(), indices: mesh.indices.clone(), ..Mesh::default() },
            false => mesh.clone(),
        });
        part.version = self.changes;
        (part.bounds, part.plane, part.solid) = (mesh.bounds(), mesh.plane(), is_convex_solid(mesh));
        self.write_vertices(journal, number, mesh);
    }

    pub fn write_vertices(&self, journal: &mut Journal, number: u32, mesh: &Mesh) {
        let part = &self.meshes[number as usize];
        self.positions.write(journal, part.base_vertex, &mesh.positions);
        self.attributes.write(journal, part.base_vertex, &attributes(mesh));
    }

    fn write_triangles(&self, journal: &mut Journal, number: u32, mesh: &Mesh) {
        let part = &self.meshes[number as usize];
        self.indices.write(journal, part.first_index, &mesh.indices);
        self.welded.write(journal, part.first_index, &mesh.welded_indices());
    }
}

/// Vertices and indices that there has to be room for.
fn counts(mesh: &LentMesh<'_>) -> [usize; 2] {
    mesh.shape.mesh().map_or([0; 2], |known| [known.positions.len(), known.indices.len()])
}

/// Indices that lead somewhere.
pub(super) fn check(mesh: &Mesh) -> Result<(), Error> {
    let beyond = mesh.indices.iter().any(|&i| i as usize >= mesh.positions.len());
    if beyond {
        return Err(Error::Scene(format!("mesh `{}` has an index beyond its vertices", mesh.name)));
    }
    Ok(())
}

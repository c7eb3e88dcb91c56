//! The meshes in shared buffers: where each lies, and what the CPU knows of it.

mod lending;
mod part;

use super::ids::Slots;
use super::journal::Journal;
use super::store::{Parts, Store};
use super::vertices::{attributes, weights};
use crate::{error::Error, gpu::Gpu};
pub(crate) use part::MeshPart;
pub use part::Vertices;
use std::{ops::Range, sync::Arc};
use umbrage_core::{Bounds, Mesh, solid::is_convex_solid};

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

    /// Gives the memory of a mesh back.
    fn clear(&mut self, number: u32) {
        let part = &mut self.meshes[number as usize];
        let old = [&mut part.vertices, &mut part.indices, &mut part.weights].map(std::mem::take);
        self.parts.iter_mut().zip(old).for_each(|(parts, part)| parts.give_back(part));
    }

    /// Gives a mesh other vertices, as many as it has.
    pub fn deform(&mut self, journal: &mut Journal, number: u32, mesh: &Mesh) {
        let part = &mut self.meshes[number as usize];
        let known = part.welded.take().unwrap_or_else(|| part.mesh.welded_indices());
        self.fill(journal, number, mesh);
        // Vertices that were in one place may have parted, and triangles may have lost their area.
        let welded = mesh.welded_indices();
        let part = &mut self.meshes[number as usize];
        if welded != known {
            self.welded.write(journal, part.first_index, &welded);
        }
        part.welded = Some(welded);
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
        (part.version, part.welded) = (self.changes, None);
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

/// Indices that lead somewhere.
pub(super) fn check(mesh: &Mesh) -> Result<(), Error> {
    let beyond = mesh.indices.iter().any(|&i| i as usize >= mesh.positions.len());
    if beyond {
        return Err(Error::Scene(format!("mesh `{}` has an index beyond its vertices", mesh.name)));
    }
    Ok(())
}

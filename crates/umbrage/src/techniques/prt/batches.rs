//! Which draws a frame takes: neighbours in the buffers that look alike are one.

use super::baked::Mesh;
use super::fits::is_there;
use super::pipelines::{HIDDEN, PrtMesh};
use crate::casters::Casters;
use std::ops::Range;

/// Triangles with one texture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Batch {
    pub texture: Option<u32>,
    pub is_masked: bool,
    pub indices: Range<u32>,
}

/// What is drawn in a frame.
#[derive(Default)]
pub(super) struct Batches {
    pub draws: Vec<Batch>,
    /// How the meshes stand.
    pub table: Vec<PrtMesh>,
    /// Those that are drawn.
    pub shown: u32,
}

impl Batches {
    /// Starts a frame.
    pub fn clear(&mut self) {
        self.draws.clear();
        self.table.clear();
        self.shown = 0;
    }

    /// Adds a mesh whose light begins at `light`. What receives nothing is not drawn.
    pub fn add(&mut self, casters: &Casters, mesh: &Mesh, light: u32) {
        let placed = casters.placed().get(mesh.instance);
        let shown = placed.filter(|p| p.shown && p.receives && is_there(casters, mesh.instance));
        let Some(placed) = shown else {
            self.table.push(PrtMesh { instance: HIDDEN, ..PrtMesh::default() });
            return;
        };
        let is_mirrored = placed.world_from_mesh.matrix3.determinant() < 0.0;
        let turned = u32::from(mesh.is_turned != is_mirrored);
        self.table.push(PrtMesh { instance: mesh.instance as u32, light, turned, spare: 0 });
        self.shown += 1;
        let (texture, is_masked) = (casters.texture_of(mesh.instance as u32), placed.masked);
        match self.draws.last_mut() {
            Some(last)
                if (last.texture, last.is_masked, last.indices.end) == (texture, is_masked, mesh.indices.start) =>
            {
                last.indices.end = mesh.indices.end;
            }
            _ => self.draws.push(Batch { texture, is_masked, indices: mesh.indices.clone() }),
        }
    }

    /// Triangles of all draws.
    pub fn triangles(&self) -> u64 {
        self.draws.iter().map(|draw| draw.indices.len() as u64 / 3).sum()
    }
}

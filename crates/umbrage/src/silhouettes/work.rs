//! What a frame's casters need: their chunks, room for what may be found, and the CPU's own search.

use super::buffers::Needs;
use super::caster::{self, AWAY, CHUNK, Caster, DARK_CAP, HEADER, LIGHT_CAP, Throw, Z_FAIL};
use super::shape::{Part, Shape};
use crate::casters::{Casters, Edges};
use crate::error::Error;
use std::ops::Range;
use umbrage_core::glam::{Vec3, Vec4};
use umbrage_core::silhouette::{Rule, facing, multiplicity};

/// A frame's casters. Keeps its memory.
#[derive(Default)]
pub(super) struct Work {
    pub casters: Vec<Caster>,
    /// The header; the caster of each chunk of edges, then of triangles; and where the CPU finds
    /// silhouettes, the lists of the three parts, one after the other as `room` lays them out.
    pub list: Vec<u32>,
    chunks: u32,
    /// Chunks of edges of casters counted from the eye, of all casters.
    pass_chunks: u32,
    pub edge_chunks: u32,
    /// Most entries that each part may need.
    room: [u32; 3],
    counts: [u32; 3],
    /// Of each caster the entries of sides, where the CPU found them.
    pub sides: Vec<Range<u32>>,
    edges: u64,
    triangles: u64,
}

/// More entries than this do not fit their numbering.
const MOST: u64 = 1 << 29;

impl Work {
    pub fn clear(&mut self) {
        self.casters.clear();
        self.list.clear();
        self.list.resize(HEADER as usize, 0);
        (self.chunks, self.pass_chunks, self.edge_chunks) = (0, 0, 0);
        self.room = [0; 3];
        (self.edges, self.triangles) = (0, 0);
    }

    pub fn add(&mut self, casters: &Casters, edges: &Edges, throw: &Throw, weighted: bool) {
        let Some(mut new) = caster::caster(casters, edges, throw) else { return };
        new.edge_chunk = self.edge_chunks;
        let chunks = new.edge_count.div_ceil(CHUNK);
        self.add_chunks(self.casters.len() as u32, chunks);
        self.edge_chunks += chunks;
        if !throw.z_fail {
            self.pass_chunks = self.edge_chunks;
        }
        // Without weights a side that counts twice is there twice; under `Rule::Away` none does.
        let times = if weighted || throw.rule == Rule::Away { 1 } else { 2 };
        let part = if throw.z_fail { Part::FailSides } else { Part::PassSides };
        let room = &mut self.room[part as usize];
        *room = room.saturating_add(times * new.edge_count);
        self.edges += u64::from(new.edge_count);
        self.casters.push(new);
    }

    fn add_chunks(&mut self, caster: u32, count: u32) {
        self.list.extend(std::iter::repeat_n(caster, count as usize));
        self.chunks += count;
    }

    /// Adds the chunks of triangles.
    pub fn finish(&mut self, shape: Shape) -> Result<(), Error> {
        for number in 0..self.casters.len() {
            let caster = &mut self.casters[number];
            caster.triangle_chunk = self.chunks;
            let has_cap = caster.flags & LIGHT_CAP != 0 || (shape.dark_caps && caster.flags & DARK_CAP != 0);
            if caster.flags & Z_FAIL != 0 && has_cap {
                let triangles = caster.triangle_count;
                let room = &mut self.room[Part::Caps as usize];
                *room = room.saturating_add(triangles);
                self.triangles += u64::from(triangles);
                self.add_chunks(number as u32, triangles.div_ceil(CHUNK));
            }
        }
        let size = self.entries().max(u64::from(self.chunks) * u64::from(CHUNK));
        if size > MOST {
            return Err(Error::Size { what: "the edges of all casters".into(), size, limit: MOST });
        }
        Part::ALL.iter().for_each(|part| self.list[2 * *part as usize] = self.first(*part));
        Ok(())
    }

    /// Most entries of all parts.
    fn entries(&self) -> u64 {
        self.room.iter().map(|r| u64::from(*r)).sum()
    }

    /// Finds everything on the CPU.
    pub fn list(&mut self, edges: &Edges, casters: &Casters, throws: &[Throw], shape: Shape) {
        self.list.resize(self.list.len() + self.entries() as usize, 0);
        self.counts = [0; 3];
        self.sides.clear();
        for (i, throw) in throws.iter().enumerate() {
            let of = self.casters[i];
            let number = casters.placed()[throw.place as usize].mesh;
            let mesh = edges.of_mesh(number);
            let planes = casters.planes(number, mesh);
            let light = Vec4::from_array(of.light);
            let part = if throw.z_fail { Part::FailSides } else { Part::PassSides };
            let before = self.counts[part as usize];
            for (slot, edge) in (of.edge_chunk * CHUNK..).zip(&mesh.adjacency.edges) {
                let times = multiplicity(edge, planes, light, throw.rule);
                if times != 0 {
                    let twice = times.abs() == 2;
                    let entry = slot << 2 | u32::from(twice) << 1 | u32::from(times < 0);
                    self.push(part, entry, if twice && !shape.weighted { 2 } else { 1 });
                }
            }
            self.sides.push(before..self.counts[part as usize]);
            let chunk = (of.triangle_chunk < self.chunks).then(|| self.list[(HEADER + of.triangle_chunk) as usize]);
            if !throw.z_fail || chunk != Some(i as u32) || of.triangle_chunk < self.edge_chunks {
                continue;
            }
            for (&number, plane) in mesh.adjacency.numbers.iter().zip(planes) {
                let f = facing(*plane, light);
                if plane.truncate() != Vec3::ZERO && !(f > 0 && throw.rule == Rule::Away) {
                    self.push(Part::Caps, (of.triangle_chunk * CHUNK + number) << 2 | u32::from(f < 0), 1);
                }
            }
        }
        Part::ALL.iter().zip(self.counts).for_each(|(part, count)| self.list[2 * *part as usize + 1] = count);
    }

    fn push(&mut self, part: Part, entry: u32, times: u32) {
        for _ in 0..times {
            let at = self.first(part) + self.counts[part as usize];
            self.list[at as usize] = entry;
            self.counts[part as usize] += 1;
        }
    }

    /// Where the entries of a part start.
    fn first(&self, part: Part) -> u32 {
        HEADER + self.chunks + self.room[..part as usize].iter().sum::<u32>()
    }

    /// Groups of what the CPU found, an instance each.
    pub fn listed(&self, part: Part) -> Range<u32> {
        0..self.counts[part as usize].div_ceil(CHUNK)
    }

    /// Chunks of all edges or triangles of a part, an instance each.
    pub fn all(&self, part: Part) -> Range<u32> {
        match part {
            Part::PassSides => 0..self.pass_chunks,
            Part::FailSides => self.pass_chunks..self.edge_chunks,
            Part::Caps => self.edge_chunks..self.chunks,
        }
    }

    /// How often every edge is drawn for those that count twice.
    pub fn repeats(&self, part: Part, shape: Shape) -> u32 {
        let once = part == Part::Caps || shape.weighted || self.casters.iter().all(|c| c.flags & AWAY != 0);
        if once { 1 } else { 2 }
    }

    pub fn needs(&self, listed: bool) -> Needs {
        let entries = if listed { self.entries() } else { 0 };
        Needs {
            casters: self.casters.len() as u64 * size_of::<Caster>() as u64,
            list: 4 * (u64::from(HEADER + self.chunks) + entries),
        }
    }

    /// Chunks of triangles.
    pub fn triangle_chunks(&self) -> u32 {
        self.chunks - self.edge_chunks
    }

    pub fn room(&self, part: Part) -> u32 {
        self.room[part as usize]
    }

    pub fn looked_at(&self) -> (u64, u64) {
        (self.edges, self.triangles)
    }

    /// Numbers in the mesh's list of edges, and whether they count twice, of what the CPU found.
    pub fn side(&self, caster: usize, number: u32) -> (u32, bool) {
        let entry = self.list[(self.first(Part::PassSides) + number) as usize];
        ((entry >> 2) - self.casters[caster].edge_chunk * CHUNK, entry & 2 != 0)
    }

    pub fn counts(&self) -> [u32; 3] {
        self.counts
    }
}

//! Which casters throw shadows into the view, which of them may shadow the eye, and through which the eye may see.

use super::light::Anchor;
use super::light::Form;
use crate::casters::{self, Casters, Edges, MeshEdges, Placed};
use crate::silhouettes::Throw;
use crate::{error::Error, gpu::Gpu, view::View};
use std::ops::Range;
use umbrage_core::Bounds;
use umbrage_core::adjacency::Adjacency;
use umbrage_core::glam::DVec4;
use umbrage_core::shadow_hull::{segment_touches, shadow_end, soft_shadow_hull};
use umbrage_core::silhouette::Rule;

/// A mesh with no more open edges than this, and no flatter, is a body with holes and not a sheet.
const MOST_OPEN: f64 = 0.05;
const MOST_FLAT: f64 = 0.1;

/// Sides end behind what is seen by this share of its size: more than the rasteriser's own rounding of corners comes to.
const BEHIND: f64 = 2e-3;

/// Triangles that are looked at together, see `surface.wgsl`.
pub(super) const CHUNK: u32 = 64;

/// What is done with a chunk, see `surface.wgsl`.
const COUNTS: u32 = 1;
const NEAR_ALONE: u32 = 2;

/// How the eye may see through a caster's surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Opening {
    /// Anywhere, as it is not all among the receivers.
    Anywhere,
    /// Where the near plane cuts it.
    Near,
}

/// The casters of a frame. Keeps its memory.
#[derive(Default)]
pub(super) struct Selection {
    pub throws: Vec<Throw>,
    /// Of each throw where its silhouette is seen from.
    pub anchors: Vec<Anchor>,
    /// Chunks of triangles that may be between eye and light or that the eye may see through: the number of the throw, their first
    /// triangle, where they count and what is done with them, see `surface.wgsl`.
    pub chunks: Vec<[u32; 4]>,
    /// How many of them, the first ones, are surfaces that the eye may see through.
    pub caps: u32,
    openings: Vec<Option<Opening>>,
    found: Vec<u32>,
}

impl Selection {
    /// Chooses.
    pub fn choose(
        &mut self,
        gpu: &Gpu,
        view: &View<'_>,
        form: &Form,
        rounding: f64,
        unseen: bool,
    ) -> Result<(), Error> {
        self.throws.clear();
        self.anchors.clear();
        self.chunks.clear();
        self.caps = 0;
        self.openings.clear();
        self.found.clear();
        let casters = view.casters;
        if !view.light.casts || casters.casting().is_empty() {
            return Ok(());
        }
        let edges = casters.edges(gpu)?;
        let hull = form.hull();
        let receivers = casters.receivers_bounds();
        if let Some(body) = soft_shadow_hull(&view.camera, &receivers, &hull) {
            casters.casting().query(&body, &mut self.found);
        }
        self.found.sort_unstable();
        // Segments from the eye to what is seen stay in this box. One plane a caster, so that neighbours share corners.
        let seen = view.seen().with(view.camera.eye);
        let seen = seen.grown(BEHIND * seen.size().length());
        let around_eye = view.around_eye().grown(4.0 * rounding * seen.largest_coordinate());
        let lights: Vec<_> = hull.iter().map(|center| casters::Light { center: *center, receivers }).collect();
        for &place in &self.found {
            let placed = &casters.placed()[place as usize];
            let is_empty = placed.bounds.is_empty() || placed.sides.is_none();
            if is_empty || lights.iter().all(|light| placed.shadows_nothing(light)) {
                continue;
            }
            let mesh = edges.of_mesh(placed.mesh);
            if !mesh.adjacency.edges.is_empty() {
                let (anchor, axis) = form.anchor(placed.bounds.center());
                let light = form.in_world(anchor);
                let end = shadow_end(&seen, &placed.bounds, light);
                let holds_eye = placed.bounds.overlaps(&around_eye);
                let opening = match unseen || placed.masked {
                    true => Some(Opening::Anywhere),
                    false => (holds_eye && may_be_cut(casters, placed, mesh, &around_eye)).then_some(Opening::Near),
                };
                let shows_inside = holds_eye || opening.is_some();
                self.throws.push(throw(place, light, &mesh.adjacency, end, shows_inside));
                self.openings.push(opening);
                let [place, axis] = [anchor, axis].map(|v| v.as_vec3().to_array());
                self.anchors.push(Anchor { place, axis, ..Anchor::default() });
            }
        }
        self.list_chunks(casters, edges, view, rounding);
        Ok(())
    }

    /// Surfaces that the eye may see through first.
    fn list_chunks(&mut self, casters: &Casters, edges: &Edges, view: &View<'_>, rounding: f64) {
        for caps in [true, false] {
            for ((number, throw), opening) in (0..).zip(&self.throws).zip(&self.openings) {
                let placed = &casters.placed()[throw.place as usize];
                let largest = placed.bounds.largest_coordinate().max(view.camera.eye.abs().max_element());
                let counts = segment_touches(view.camera.eye, throw.light, &placed.bounds, 8.0 * rounding * largest);
                if caps != opening.is_some() || !(caps || counts) {
                    continue;
                }
                let near = if *opening == Some(Opening::Near) { NEAR_ALONE } else { 0 };
                let todo = near | if counts { COUNTS } else { 0 };
                let triangles = edges.of_mesh(placed.mesh).triangle_count;
                self.chunks.extend((0..triangles.div_ceil(CHUNK)).map(|i| [number, i * CHUNK, 0, todo]));
            }
            if caps {
                self.caps = self.chunks.len() as u32;
            }
        }
    }

    /// The chunks of a throw's surface that the eye may see through.
    pub fn caps_of(&self, throw: u32) -> Range<u32> {
        let caps = &self.chunks[..self.caps as usize];
        let first = caps.partition_point(|chunk| chunk[0] < throw);
        first as u32..caps.partition_point(|chunk| chunk[0] <= throw) as u32
    }
}

/// Whether the near plane may cut a caster open.
fn may_be_cut(casters: &Casters, placed: &Placed, mesh: &MeshEdges, around_eye: &Bounds) -> bool {
    let (Some(sides), false) = (&placed.sides, placed.posed) else { return true };
    let part = &casters.meshes()[placed.mesh as usize].mesh;
    mesh.eye_tree(part).may_touch(&around_eye.transformed(&sides.mesh_from_world))
}

/// A closed body throws the shadow of its far side: both sides would cover the light twice. Of one with holes, or whose inside is seen, both
/// count apart. Every other mesh is a sheet, which covers the light once wherever it is.
fn throw(place: u32, light: DVec4, mesh: &Adjacency, end: DVec4, shows_inside: bool) -> Throw {
    let has_holes = mesh.open_share <= MOST_OPEN && mesh.flatness <= MOST_FLAT;
    Throw {
        place,
        light,
        rule: if mesh.is_closed && !shows_inside { Rule::Away } else { Rule::All },
        is_body: if mesh.is_closed { shows_inside } else { has_holes },
        z_fail: false,
        light_cap: false,
        dark_cap: false,
        end,
        reach: 0.0,
    }
}

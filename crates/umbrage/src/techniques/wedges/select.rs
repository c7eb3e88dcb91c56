//! Which casters throw shadows into the view, and which of them may shadow the eye.

use super::light::Anchor;
use super::light::Form;
use crate::casters::{self, Casters, Edges};
use crate::silhouettes::Throw;
use crate::{error::Error, gpu::Gpu, view::View};
use umbrage_core::adjacency::Adjacency;
use umbrage_core::glam::DVec4;
use umbrage_core::shadow_hull::{segment_touches, shadow_end, soft_shadow_hull};
use umbrage_core::silhouette::Rule;

/// A mesh with no more open edges than this, and no flatter, is a body with holes and not a sheet.
const MOST_OPEN: f64 = 0.05;
const MOST_FLAT: f64 = 0.1;

/// Sides end behind what is seen by this share of its size: more than the rasteriser's own rounding of corners comes to.
const BEHIND: f64 = 2e-3;

/// Triangles that are searched together, see `eye.wgsl`.
const CHUNK: u32 = 64;

/// The casters of a frame. Keeps its memory.
#[derive(Default)]
pub(super) struct Selection {
    pub throws: Vec<Throw>,
    /// Of each throw where its silhouette is seen from.
    pub anchors: Vec<Anchor>,
    /// For chunks of triangles that may be between eye and light the number of the throw, their first triangle and where they
    /// count, see `eye.wgsl`.
    pub eye_chunks: Vec<[u32; 4]>,
    found: Vec<u32>,
}

impl Selection {
    /// Chooses.
    pub fn choose(&mut self, gpu: &Gpu, view: &View<'_>, form: &Form, rounding: f64) -> Result<(), Error> {
        self.throws.clear();
        self.anchors.clear();
        self.eye_chunks.clear();
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
                self.throws.push(throw(place, light, &mesh.adjacency, end));
                let [place, axis] = [anchor, axis].map(|v| v.as_vec3().to_array());
                self.anchors.push(Anchor { place, axis, ..Anchor::default() });
            }
        }
        self.search_eye(casters, edges, view, rounding);
        Ok(())
    }

    fn search_eye(&mut self, casters: &Casters, edges: &Edges, view: &View<'_>, rounding: f64) {
        for (number, throw) in (0..).zip(&self.throws) {
            let placed = &casters.placed()[throw.place as usize];
            let margin = 8.0 * rounding * placed.bounds.largest_coordinate().max(view.camera.eye.abs().max_element());
            if segment_touches(view.camera.eye, throw.light, &placed.bounds, margin) {
                let triangles = edges.of_mesh(placed.mesh).triangle_count;
                self.eye_chunks.extend((0..triangles.div_ceil(CHUNK)).map(|i| [number, i * CHUNK, 0, 0]));
            }
        }
    }
}

/// A closed body throws the shadow of its far side: both sides would cover the light twice. Of one with holes both count apart. Every
/// other mesh is a sheet, which covers the light once wherever it is.
fn throw(place: u32, light: DVec4, mesh: &Adjacency, end: DVec4) -> Throw {
    Throw {
        place,
        light,
        rule: if mesh.is_closed { Rule::Away } else { Rule::All },
        is_body: !mesh.is_closed && mesh.open_share <= MOST_OPEN && mesh.flatness <= MOST_FLAT,
        z_fail: false,
        light_cap: false,
        dark_cap: false,
        end,
        reach: 0.0,
    }
}

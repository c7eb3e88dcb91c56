//! Which casters cast shadows into the view, and from where each is counted.

use super::cuts::{Touched, cut};
use super::options::Options;
use super::records::{CHUNK, Cut};
use crate::area_light::{Form, casters_in_view, may_touch};
use crate::casters::{MeshEdges, Placed, before_eye};
use crate::silhouettes::Throw;
use crate::{error::Error, gpu::Gpu, view::View};
use std::ops::Range;
use umbrage_core::Bounds;
use umbrage_core::adjacency::Adjacency;
use umbrage_core::glam::DVec4;
use umbrage_core::shadow_hull::{segment_touches, shadow_end};
use umbrage_core::silhouette::Rule;

/// A mesh with no more open edges than this, and no flatter, is a body with holes and not a sheet.
const MOST_OPEN: f64 = 0.05;
const MOST_FLAT: f64 = 0.1;

/// Sides end behind what is seen by this share of its size: more than the rasteriser's own rounding
/// of corners amounts to.
const BEHIND: f64 = 2e-3;

/// The casters of a frame. Keeps its memory.
#[derive(Default)]
pub(super) struct Selection {
    pub throws: Vec<Throw>,
    /// Of each caster the shadows that the eye is in: of its sides that face the light, and of
    /// those that face away, see `Wedge::weights`. `None`: it is counted from infinity.
    pub eye_counts: Vec<Option<[u32; 2]>>,
    /// Of casters that are counted from infinity, chunks of triangles: the number of the caster and
    /// the first triangle.
    pub caps: Vec<[u32; 2]>,
    /// What the light cuts of casters.
    pub cuts: Vec<Cut>,
    found: Vec<u32>,
}

/// What choosing goes by, the same for all casters.
struct Scope<'a> {
    view: &'a View<'a>,
    form: &'a Form,
    /// Where shadows are seen.
    seen: Bounds,
    /// How far rounding moves things, metres.
    rounding: f64,
    around_eye: Bounds,
    /// Of [`Options`](super::options::Options).
    unseen: bool,
}

impl Selection {
    /// Chooses.
    pub fn choose(&mut self, gpu: &Gpu, view: &View<'_>, form: &Form, options: &Options) -> Result<(), Error> {
        self.throws.clear();
        self.eye_counts.clear();
        self.caps.clear();
        self.cuts.clear();
        casters_in_view(view, form, options.leaves_masked, &mut self.found);
        if self.found.is_empty() {
            return Ok(());
        }
        let edges = view.casters.edges(gpu)?;
        // Segments from the eye to what is seen stay in this box. One plane a caster, so that
        // neighbours share corners.
        let seen = if view.camera.is_parallel() { view.seen() } else { view.seen().with(view.camera.eye) };
        let seen = seen.grown(BEHIND * seen.size().length());
        let rounding = view.rounding();
        let around_eye = view.around_eye().grown(rounding);
        let scope = Scope { view, form, seen, rounding, around_eye, unseen: options.unseen };
        for i in 0..self.found.len() {
            let place = self.found[i];
            let placed = &view.casters.placed()[place as usize];
            let mesh = edges.of_mesh(placed.mesh);
            if !mesh.adjacency.edges.is_empty() {
                self.add(&scope, place, placed, mesh);
            }
        }
        Ok(())
    }

    fn add(&mut self, scope: &Scope<'_>, place: u32, placed: &Placed, mesh: &MeshEdges) {
        let Scope { view, form, .. } = scope;
        let (anchor, axis) = form.anchor(placed.bounds.center());
        let light = form.in_world(anchor);
        let bounds = placed.bounds.grown(scope.rounding);
        let holds_eye = bounds.overlaps(&scope.around_eye);
        let is_cut = || holds_eye && may_touch(view.casters, placed, mesh, &scope.around_eye);
        let is_open_to_eye = scope.unseen || placed.masked || is_cut();
        let is_cut_by_light = self.is_touched(scope, placed, mesh);
        let holds_light = light.w != 0.0 && bounds.contains(light.truncate());
        let shows_inside = holds_eye || is_open_to_eye || holds_light || is_cut_by_light;
        let end = shadow_end(&scope.seen, &placed.bounds, light);
        let throw = Throw {
            anchor: [anchor, axis].map(|v| v.as_vec3()),
            ..throw(place, light, &mesh.adjacency, end, shows_inside)
        };
        // Parallel lines of sight start at no eye.
        let eye_count = if is_open_to_eye || view.camera.is_parallel() {
            None
        } else if segment_touches(view.camera.eye, light, &bounds, scope.rounding) {
            before_eye(view, placed, mesh, light, scope.rounding).map(|count| weights(&throw, count))
        } else {
            Some([0; 2])
        };
        if is_cut_by_light {
            let part = &view.casters.meshes()[placed.mesh as usize].mesh;
            let touched = Touched { placed, part, mesh: &mesh.adjacency, throw: &throw };
            cut(view, form, &touched, &mut self.cuts);
        }
        self.push(throw, eye_count, mesh.triangle_count);
    }

    /// Whether the light may touch a caster whose triangles are known here. Pieces of discs and
    /// spheres are left out: their shares are found in another way.
    fn is_touched(&self, scope: &Scope<'_>, placed: &Placed, mesh: &MeshEdges) -> bool {
        let Scope { view, form, .. } = scope;
        if form.center.w == 0.0 || form.is_point() || form.cell.is_some() || placed.posed {
            return false;
        }
        let around = form.bounds().grown(scope.rounding);
        placed.bounds.overlaps(&around) && may_touch(view.casters, placed, mesh, &around)
    }

    /// What is counted from infinity has its surface drawn, and where its shadow ends.
    fn push(&mut self, throw: Throw, eye_count: Option<[u32; 2]>, triangles: u32) {
        if eye_count.is_none() {
            let number = self.throws.len() as u32;
            self.caps.extend((0..triangles.div_ceil(CHUNK)).map(|i| [number, i * CHUNK]));
        }
        self.throws.push(Throw { from_infinity: eye_count.is_none(), ..throw });
        self.eye_counts.push(eye_count);
    }

    /// The chunks of a caster's surface.
    pub fn caps_of(&self, throw: u32) -> Range<u32> {
        let first = self.caps.partition_point(|chunk| chunk[0] < throw);
        first as u32..self.caps.partition_point(|chunk| chunk[0] <= throw) as u32
    }
}

/// How often a caster's triangles of both sides count among those of either.
fn weights(throw: &Throw, [facing, away]: [u32; 2]) -> [u32; 2] {
    match throw.rule {
        Rule::Away => [away; 2],
        Rule::All if throw.is_body => [facing, away],
        Rule::All => [facing + away; 2],
    }
}

/// A closed body casts the shadow of its far side: both sides would cover the light twice. Of one
/// with holes, or whose inside is seen, both count apart. Every other mesh is a sheet, which covers
/// the light once wherever it is.
fn throw(place: u32, light: DVec4, mesh: &Adjacency, end: DVec4, shows_inside: bool) -> Throw {
    let has_holes = mesh.open_share <= MOST_OPEN && mesh.flatness <= MOST_FLAT;
    Throw {
        place,
        light,
        rule: if mesh.is_closed && !shows_inside { Rule::Away } else { Rule::All },
        is_body: if mesh.is_closed { shows_inside } else { has_holes },
        from_infinity: false,
        z_fail: false,
        light_cap: false,
        dark_cap: false,
        end,
        reach: 0.0,
        anchor: Default::default(),
    }
}

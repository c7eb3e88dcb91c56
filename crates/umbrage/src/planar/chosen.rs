//! What a frame draws: planes of a light, and the casters of each.

use super::MOST;
use super::lit::{Between, LitPlane};
use super::outline::Shadow;
use super::screen::{Clipper, Screen};
use super::seen::SeenPlanes;
use crate::casters::{Casters, DrawList, Form, InstanceNumbers, Light, Placed, Surface};
use crate::{gpu::Gpu, passes::Passes, view::View};
use umbrage_core::glam::{DVec2, DVec3};

/// What of a scene a technique wants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wanted {
    /// At most this many planes, the largest on the screen.
    pub planes: u32,
    /// Points so far off a plane are in it, metres.
    pub tolerance: f64,
    /// Leaves out casters whose shadow falls beside what is seen of the plane.
    pub cull: bool,
}

/// Keeps its memory from frame to frame.
#[derive(Default)]
pub(crate) struct Chosen {
    seen: SeenPlanes,
    planes: Vec<LitPlane>,
    /// Planes that the light shines on from behind.
    behind: Vec<LitPlane>,
    /// By plane: the pixels that may be in shadow.
    rects: Vec<[u32; 4]>,
    /// Around the planes behind, on the screen.
    quads: Vec<[DVec2; 4]>,
    clipper: Clipper,
    lists: Vec<DrawList>,
    numbers: InstanceNumbers,
    found: Vec<u32>,
    pierced: Vec<u32>,
    tally: Tally,
}

/// What became of the planes in view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Tally {
    seen: u64,
    unlit: u64,
    unshadowed: u64,
    left_out: u64,
    receivers_without: u64,
}

/// More casters than this are not worth looking at to see where their shadows end.
const MOST_ENCLOSED: usize = 256;

/// Shadows of fewer pixels are not worth their draws.
const LEAST_AREA: f64 = 1.0;

/// For each plane that is wanted, so many are searched for casters.
const SEARCHED: usize = 4;

impl Chosen {
    /// Chooses planes for the light of `view`.
    ///
    /// `margin` tells how far beyond what is seen of a plane shadows may matter, metres.
    pub fn update(&mut self, gpu: &Gpu, view: &View<'_>, wanted: &Wanted, margin: impl Fn(&LitPlane) -> f64) {
        self.planes.clear();
        self.behind.clear();
        self.rects.clear();
        self.quads.clear();
        self.tally = Tally::default();
        let casters = view.casters;
        if !view.light.casts || casters.casting().is_empty() {
            return;
        }
        self.seen.update(view, wanted.tolerance);
        let most = (wanted.planes as usize).min(MOST);
        self.lists.resize_with(most, DrawList::default);
        self.numbers.clear(gpu, casters, most as u32);
        let (origin, mut light) = (casters.origin(), view.light.shape.center());
        let of_scene = Light { center: light, receivers: casters.receivers_bounds() };
        light -= (origin * light.w).extend(0.0);
        let eye = view.camera.eye - origin;
        let least = casters.receiver_planes().flatness() + wanted.tolerance;
        self.tally.receivers_without = casters.receiver_planes().receivers_without();
        let screen = Screen::of(view);
        for seen in self.seen.list() {
            self.tally.seen += 1;
            let lit = LitPlane::of(seen, origin, light, least);
            let Some(mut lit) = lit else {
                self.tally.unlit += 1;
                continue;
            };
            if !lit.is_before(eye) {
                self.tally.unlit += 1;
                if self.behind.len() < MOST {
                    self.behind.push(lit);
                }
                continue;
            }
            if self.planes.len() == most || self.planes.len() + self.tally.unshadowed as usize >= SEARCHED * most {
                self.tally.left_out += 1;
                continue;
            }
            let margin = margin(&lit);
            lit.grow(margin);
            find(casters, &of_scene, &mut lit, wanted.cull, [&mut self.found, &mut self.pierced]);
            let list = &mut self.lists[self.planes.len()];
            self.numbers.list(casters, &self.found, None, Some(&self.pierced), list);
            // What falls beside the screen shadows nothing, unless it is blurred into it; where a
            // wall stands in the floor, a strip under the floor is in the floor's shadow.
            let around = lit.corners(lit.low - margin, lit.high + margin);
            if list.draws() == 0 || screen.area(self.clipper.clip(&screen, around)) < LEAST_AREA {
                self.tally.unshadowed += 1;
            } else {
                self.planes.push(lit);
            }
        }
        let mut rect = |corners| screen.rect(self.clipper.clip(&screen, corners));
        self.rects.extend(self.planes.iter().map(|plane| rect(plane.corners(plane.low, plane.high))));
        for plane in &self.behind {
            let corners = plane.corners(plane.low, plane.high);
            self.quads.push(screen.quad(&corners.map(|(p, _)| p), rect(corners)));
        }
    }

    /// The planes with shadows.
    pub fn planes(&self) -> &[LitPlane] {
        &self.planes
    }

    /// Planes in view that the light shines on from behind.
    pub fn behind(&self) -> &[LitPlane] {
        &self.behind
    }

    /// Where on the screen shadows of each plane may be: x, y, width, height in pixels.
    pub fn rects(&self) -> &[[u32; 4]] {
        &self.rects
    }

    /// Quads around the planes behind, in normalised device coordinates.
    pub fn quads(&self) -> &[[DVec2; 4]] {
        &self.quads
    }

    /// Casters that may shadow a plane, by its number in [`Chosen::planes`].
    pub fn lists(&self) -> &[DrawList] {
        &self.lists[..self.planes.len()]
    }

    /// Sends the lists to the GPU, before the first draw.
    pub fn upload(&self, passes: &mut Passes<'_>) {
        if !self.planes.is_empty() {
            self.numbers.upload(passes);
        }
    }

    /// Draws the casters of a plane.
    pub fn draw<'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        casters: &Casters,
        plane: usize,
        pipeline: impl Fn(Surface, &Form) -> Option<&'p wgpu::RenderPipeline>,
    ) {
        if let Some(list) = self.lists().get(plane) {
            self.numbers.draw(pass, casters, list, false, |surface, _, form| pipeline(surface, form));
        }
    }

    /// For [`crate::Inside::counts`].
    pub fn counts(&self) -> Vec<(&'static str, u64)> {
        vec![
            ("planes in view", self.tally.seen),
            ("planes drawn", self.planes.len() as u64),
            ("planes not facing the light", self.tally.unlit),
            ("planes without casters", self.tally.unshadowed),
            ("planes left out", self.tally.left_out),
            ("receivers without planes", self.tally.receivers_without),
        ]
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        self.numbers.bytes()
    }
}

/// Fills `found` with the casters that may shadow a plane, and `pierced`, in order, with those that
/// have to be cut. What is wanted of the plane shrinks to where their shadows fall.
fn find(casters: &Casters, light: &Light, plane: &mut LitPlane, cull: bool, [found, pierced]: [&mut Vec<u32>; 2]) {
    found.clear();
    if cull {
        casters.casting().query(&*plane, found);
    } else {
        found.extend(casters.casting_places());
    }
    let between = |plane: &LitPlane, place: u32| plane.between(&casters.placed()[place as usize]);
    // The floor under everything stands across every wall.
    let is_idle = |place: u32| casters.placed()[place as usize].shadows_nothing(light);
    found.retain(|place| between(plane, *place) != Between::Nothing && !is_idle(*place));
    if found.len() <= MOST_ENCLOSED {
        enclose(casters, plane, cull, found);
    } else {
        plane.highest = plane.reach_of(&casters.casting().content());
    }
    pierced.clear();
    pierced.extend(found.iter().copied().filter(|place| between(plane, *place) == Between::Part));
    pierced.sort_unstable();
}

/// Drops casters whose shadow falls beside what is wanted of a plane, which shrinks to where the
/// others fall.
fn enclose(casters: &Casters, plane: &mut LitPlane, cull: bool, found: &mut Vec<u32>) {
    let wanted = [plane.low, plane.high];
    let (mut all, mut area) = ((DVec2::INFINITY, DVec2::NEG_INFINITY), 0.0);
    plane.highest = 0.0;
    found.retain(|place| {
        let placed = &casters.placed()[*place as usize];
        let shadow = Shadow::of_box(plane, &corners(casters, placed));
        let outline = shadow.outline();
        let leaves = outline.as_ref().is_some_and(|outline| outline.leaves(wanted, plane.least));
        if cull && (leaves || shadow.is_beside(wanted, plane.least)) {
            return false;
        }
        let everywhere = (DVec2::NEG_INFINITY, DVec2::INFINITY);
        let (from, to) = outline.map_or(everywhere, |outline| outline.around());
        all = (all.0.min(from), all.1.max(to));
        area += (to.min(wanted[1]) - from.max(wanted[0])).max(DVec2::ZERO).element_product();
        plane.highest = plane.highest.max(plane.reach_of(&placed.bounds));
        true
    });
    plane.shrink(all);
    plane.depth = area / (plane.high - plane.low).element_product();
}

/// Of the box around a caster, as its mesh lies in it.
fn corners(casters: &Casters, placed: &Placed) -> [DVec3; 8] {
    let part = &casters.meshes()[placed.mesh as usize];
    // Of what moves by itself the host or a pose knows where it may be in the world.
    if placed.posed {
        return placed.bounds.corners();
    }
    part.bounds.corners().map(|p| placed.world_from_mesh.transform_point3(p))
}

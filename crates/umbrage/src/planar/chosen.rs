//! What a frame draws: planes of a light, and the casters of each.

use super::MOST;
use super::lit::{Between, LitPlane};
use super::screen::{Clipper, Screen};
use super::seen::SeenPlanes;
use crate::casters::{Casters, DrawList, Form, InstanceNumbers, Surface};
use crate::{gpu::Gpu, passes::Passes, view::View};

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
    /// By plane: the pixels that may be in shadow; then those of the planes behind.
    rects: Vec<[u32; 4]>,
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
            find(casters, &mut lit, wanted.cull, &mut self.found, &mut self.pierced);
            let list = &mut self.lists[self.planes.len()];
            self.numbers.list(casters, &self.found, None, Some(&self.pierced), list);
            // What falls beside the screen shadows nothing, unless it is blurred into it.
            let around = lit.corners(lit.low - margin, lit.high + margin);
            if list.draws() == 0 || self.clipper.clip(&screen, around).len() < 3 {
                self.tally.unshadowed += 1;
            } else {
                self.planes.push(lit);
            }
        }
        for plane in self.planes.iter().chain(&self.behind) {
            self.rects.push(screen.rect(self.clipper.clip(&screen, plane.corners(plane.low, plane.high))));
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

    /// Where on the screen shadows of each plane may be: x, y, width, height in pixels; then where
    /// the planes behind are.
    pub fn rects(&self) -> &[[u32; 4]] {
        &self.rects
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
            self.numbers.draw(pass, casters, list, false, pipeline);
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
fn find(casters: &Casters, plane: &mut LitPlane, cull: bool, found: &mut Vec<u32>, pierced: &mut Vec<u32>) {
    found.clear();
    if cull {
        casters.casting().query(&*plane, found);
    } else {
        found.extend(casters.casting_places());
    }
    let between = |place: u32| plane.between(&casters.placed()[place as usize]);
    found.retain(|place| between(*place) != Between::Nothing);
    pierced.clear();
    pierced.extend(found.iter().copied().filter(|place| between(*place) == Between::Part));
    pierced.sort_unstable();
    if found.len() <= MOST_ENCLOSED {
        plane.shrink(found.iter().map(|place| &casters.placed()[*place as usize].bounds));
    } else {
        plane.highest = plane.reach_of(&casters.casting().content());
    }
}

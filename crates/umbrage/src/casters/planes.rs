//! The planes that shadows fall on: flat parts of receivers, where those of several instances that
//! lie in one plane are one. Found once a scene; what changes is found again.
//!
//! A part joins the first plane that holds it, in the order in which instances came, or starts a
//! new one. Whatever comes and goes, the planes are those that this order gives: so who leaves
//! takes a plane along that it started, and who is put between others may start one that these
//! would have joined. All parts that may have to do with that are then put in planes anew; mostly
//! none are.

use super::geometry::MeshPart;
use super::placed::Placed;
use super::places::Places;
use super::region::Region;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use umbrage_core::facets::{Facet, facets};
use umbrage_core::glam::{DVec2, DVec3, DVec4};

/// All planes of a scene, relative to [`super::Casters::origin`].
pub(crate) struct ScenePlanes {
    origin: DVec3,
    /// By mesh.
    facets: HashMap<u32, Arc<[Facet]>>,
    planes: Vec<ScenePlane>,
    /// Parts of receivers, by direction and offset in coarse steps; those in a cell are in planes
    /// of the cell, or of one beside it.
    cells: BTreeMap<Cell, Vec<Flat>>,
    /// Numbers of the planes that parts in a cell started, in their order.
    started: HashMap<Cell, Vec<u32>>,
    /// Numbers of planes without members.
    spare: Vec<u32>,
    /// Cells and planes of each instance that has some, by place.
    of_place: HashMap<u32, Vec<(Cell, u32)>>,
    /// Points may be off by so much and be in a plane, metres.
    flatness: f64,
    /// Steps of [`Cell`] in metres.
    step: f64,
    version: u64,
    /// Receivers without a plane.
    without: Places,
    without_count: u64,
    /// Places of instances that have changed.
    noted: Vec<u32>,
}

/// Direction, then offset.
type Cell = [i64; 4];

/// When the instance of a part came, and which part of it this is.
type Rank = (u64, u32);

/// A flat part of an instance, as it waits for a plane.
#[derive(Clone)]
struct Flat {
    rank: Rank,
    place: u32,
    corners: [DVec3; 4],
    share: f64,
    /// The middle of a convex body that hides the part from its own side.
    body: Option<DVec3>,
}

/// One of them.
pub(crate) struct ScenePlane {
    /// Unit normal and offset: n · p + w = 0. Either side may be lit.
    pub plane: DVec4,
    /// Unit vectors in the plane.
    pub right: DVec3,
    pub up: DVec3,
    /// Around all of its members, along `right` and `up`, metres.
    pub low: DVec2,
    pub high: DVec2,
    area: f64,
    members: Vec<Member>,
    /// Some of them show their backs: from the normal's side, and from the other.
    seen_from: [bool; 2],
    cell: Cell,
    /// Of the part that started it.
    pub rank: (u64, u32),
}

/// A flat part of an instance in its plane.
struct Member {
    rank: Rank,
    place: u32,
    low: DVec2,
    high: DVec2,
    area: f64,
    /// Which side of the plane the body is on, where it is a convex one that hides the facet from
    /// there; else 0.
    body: f64,
}

/// Flatness over the largest coordinate: vertices are placed in single precision, too.
const FLATNESS: f64 = 1e-6;

/// Told apart by whoever keeps something made of planes: no two sets have the same.
static NEXT_VERSION: AtomicU64 = AtomicU64::new(1);

fn next_version() -> u64 {
    NEXT_VERSION.fetch_add(1, Ordering::Relaxed)
}

impl ScenePlanes {
    pub(super) fn new(region: &Region, meshes: &[MeshPart], placed: &[Placed], solid: &Places) -> Self {
        // Of the coordinates that a scene of this region may have, about the largest.
        let flatness = FLATNESS * region.reach() / 3.0;
        let mut planes = Self {
            origin: region.origin,
            facets: HashMap::new(),
            planes: Vec::new(),
            cells: BTreeMap::new(),
            started: HashMap::new(),
            spare: Vec::new(),
            of_place: HashMap::new(),
            flatness,
            step: 1e2 * flatness,
            version: next_version(),
            without: Places::default(),
            without_count: 0,
            noted: Vec::new(),
        };
        let mut receivers: Vec<u32> = (0..).zip(placed).filter(|(_, p)| p.receives).map(|(place, _)| place).collect();
        receivers.sort_unstable_by_key(|place| placed[*place as usize].order);
        receivers.into_iter().for_each(|place| planes.insert(place, meshes, &placed[place as usize], solid));
        planes
    }

    /// The planes; those whose receivers have moved away are empty.
    pub fn all(&self) -> &[ScenePlane] {
        &self.planes
    }

    /// Another one after every change.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Points may be off by so much and be in a plane, metres.
    pub fn flatness(&self) -> f64 {
        self.flatness
    }

    /// How many instances that receive shadows have no plane: they are curved, or posed.
    pub fn receivers_without(&self) -> u64 {
        self.without_count
    }

    /// An instance has changed; [`ScenePlanes::follow`] sees to it.
    pub(super) fn note(&mut self, place: u32) {
        self.noted.push(place);
    }

    /// A mesh has changed, or is gone.
    pub(super) fn forget_mesh(&mut self, mesh: u32) {
        self.facets.remove(&mesh);
    }

    /// After changes that were noted; `solid` are convex bodies, wound outwards.
    pub(super) fn follow(&mut self, meshes: &[MeshPart], placed: &[Placed], solid: &Places) {
        if self.noted.is_empty() {
            return;
        }
        let mut noted = std::mem::take(&mut self.noted);
        noted.sort_unstable_by_key(|place| (placed[*place as usize].order, *place));
        noted.dedup();
        let known = self.of_place.len();
        noted.iter().for_each(|place| self.remove(*place));
        let mut is_changed = known != self.of_place.len();
        for &place in &noted {
            let of = &placed[place as usize];
            if of.receives {
                self.insert(place, meshes, of, solid);
                is_changed |= self.of_place.contains_key(&place);
            }
        }
        noted.clear();
        self.noted = noted;
        if is_changed {
            self.version = next_version();
        }
    }

    fn remove(&mut self, place: u32) {
        self.without_count -= u64::from(self.without.has(place));
        self.without.remove(place);
        let mut again = BTreeSet::new();
        for (cell, number) in self.of_place.remove(&place).unwrap_or_default() {
            if let Some(flats) = self.cells.get_mut(&cell) {
                flats.retain(|flat| flat.place != place);
                if flats.is_empty() {
                    self.cells.remove(&cell);
                }
            }
            let plane = &mut self.planes[number as usize];
            let is_started_by = plane.members.first().is_some_and(|first| first.place == place);
            plane.remove(place);
            if is_started_by {
                // Others may be in it that would not have started it.
                again.extend([-1, 0, 1].map(|step| beside(cell, step)));
                again.insert(plane.cell);
            }
        }
        self.join_again(again);
    }

    fn insert(&mut self, place: u32, meshes: &[MeshPart], placed: &Placed, solid: &Places) {
        let mut has_some = false;
        let facets = match placed.posed {
            true => Arc::default(),
            false => {
                let made = || facets(&meshes[placed.mesh as usize].mesh).into();
                self.facets.entry(placed.mesh).or_insert_with(made).clone()
            }
        };
        for (number, facet) in (0..).zip(facets.iter()) {
            let corners = facet.corners.map(|p| placed.world_from_mesh.transform_point3(p) - self.origin);
            let body = solid.has(place).then(|| placed.bounds.center() - self.origin);
            let flat = Flat { rank: (placed.order, number), place, corners, share: facet.share, body };
            let Some((cell, plane)) = self.cell_of(&corners) else { continue };
            has_some = true;
            let flats = self.cells.entry(cell).or_default();
            let at = flats.partition_point(|other| other.rank < flat.rank);
            flats.insert(at, flat.clone());
            if !self.join(cell, plane, &flat) {
                self.join_again(BTreeSet::from([cell]));
            }
        }
        if !has_some {
            self.without.make_room(place);
            self.without_count += u64::from(self.without.insert(place));
        }
    }

    /// Puts a part into the first plane that holds it, or a new one; false where that might be one
    /// that later ones would have joined.
    fn join(&mut self, cell: Cell, plane: DVec4, flat: &Flat) -> bool {
        let mut found = None;
        let mut is_last = true;
        for near in [0, -1, 1].map(|step| beside(cell, step)) {
            for &number in self.started.get(&near).into_iter().flatten() {
                let other = &self.planes[number as usize];
                if found.is_none() && other.rank < flat.rank && other.holds(&flat.corners, self.flatness) {
                    found = Some(number);
                }
            }
            let last = self.cells.get(&near).and_then(|flats| flats.last());
            is_last &= last.is_none_or(|last| last.rank <= flat.rank);
        }
        let number = match found {
            Some(number) => number,
            None if is_last => self.start(cell, plane, flat),
            None => return false,
        };
        let plane = &mut self.planes[number as usize];
        plane.add(Member::new(plane, flat));
        let of = self.of_place.entry(flat.place).or_default();
        if !of.contains(&(cell, number)) {
            of.push((cell, number));
        }
        true
    }

    fn start(&mut self, cell: Cell, plane: DVec4, flat: &Flat) -> u32 {
        let [a, b, ..] = flat.corners;
        let new = ScenePlane { rank: flat.rank, ..ScenePlane::new(plane, b - a, cell) };
        let number = self.spare.pop().unwrap_or(self.planes.len() as u32);
        self.started.entry(cell).or_default().push(number);
        match self.planes.get_mut(number as usize) {
            Some(spare) => *spare = new,
            None => self.planes.push(new),
        }
        number
    }

    /// Puts all parts into planes anew that are in these cells, or in cells that are joined to them
    /// by others.
    fn join_again(&mut self, mut cells: BTreeSet<Cell>) {
        let mut run = BTreeSet::new();
        while let Some(cell) = cells.pop_first() {
            if run.insert(cell) && self.cells.contains_key(&cell) {
                cells.extend([-1, 1].map(|step| beside(cell, step)));
            }
        }
        let mut flats: Vec<(Cell, Flat)> = Vec::new();
        for &cell in &run {
            for number in self.started.remove(&cell).unwrap_or_default() {
                self.planes[number as usize].clear();
                self.spare.push(number);
            }
            flats.extend(self.cells.remove(&cell).into_iter().flatten().map(|flat| (cell, flat)));
        }
        for (_, flat) in &flats {
            if let Some(of) = self.of_place.get_mut(&flat.place) {
                of.retain(|(cell, _)| !run.contains(cell));
            }
        }
        flats.sort_by_key(|(_, flat)| flat.rank);
        for (cell, flat) in flats {
            if let Some((_, plane)) = self.cell_of(&flat.corners) {
                self.join(cell, plane, &flat);
                self.cells.entry(cell).or_default().push(flat);
            }
        }
    }

    /// The plane through four corners, and its cell.
    fn cell_of(&self, corners: &[DVec3; 4]) -> Option<(Cell, DVec4)> {
        let [a, b, c, d] = *corners;
        let normal = (c - a).cross(d - b).try_normalize().filter(|n| n.is_finite())?;
        let largest = normal.to_array().into_iter().max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
        let normal = normal * largest.signum();
        let middle = (a + b + c + d) * 0.25;
        let plane = normal.extend(-normal.dot(middle));
        let [x, y, z] = (normal * 1e3).round().to_array().map(|v| v as i64);
        Some(([x, y, z, (plane.w / self.step).round() as i64], plane))
    }
}

fn beside([x, y, z, step]: Cell, by: i64) -> Cell {
    [x, y, z, step.saturating_add(by)]
}

impl ScenePlane {
    fn new(plane: DVec4, along: DVec3, cell: Cell) -> Self {
        let right = along.normalize_or(plane.truncate().any_orthonormal_vector());
        let up = plane.truncate().cross(right);
        Self {
            plane,
            right,
            up,
            low: DVec2::INFINITY,
            high: DVec2::NEG_INFINITY,
            area: 0.0,
            members: Vec::new(),
            seen_from: [false; 2],
            cell,
            rank: (0, 0),
        }
    }

    /// Without members.
    fn clear(&mut self) {
        self.members.clear();
        (self.low, self.high, self.area) = (DVec2::INFINITY, DVec2::NEG_INFINITY, 0.0);
        self.seen_from = [false; 2];
    }

    /// No receiver is in it.
    pub fn is_empty(&self) -> bool {
        self.members.is_empty()
    }

    /// False where the eye, relative to the origin, sees none of it: bodies are in between.
    pub fn may_be_seen(&self, eye: DVec3, placed: &[Placed], origin: DVec3) -> bool {
        let is_inside = |m: &Member| placed[m.place as usize].bounds.contains(eye + origin);
        let is_behind = self.plane.dot(eye.extend(1.0)) < 0.0;
        self.seen_from[usize::from(is_behind)] || self.members.iter().any(is_inside)
    }

    /// True where the points are in this plane within so many metres.
    fn holds(&self, points: &[DVec3], tolerance: f64) -> bool {
        points.iter().all(|p| self.plane.dot(p.extend(1.0)).abs() <= tolerance)
    }

    /// The corners of its rectangle.
    pub fn corners(&self) -> [DVec3; 4] {
        let [low, high] = [self.low, self.high];
        [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)].map(|p| self.at(p))
    }

    /// A point of the plane.
    fn at(&self, p: DVec2) -> DVec3 {
        self.plane.truncate() * -self.plane.w + self.right * p.x + self.up * p.y
    }

    /// What share of the rectangle its members cover, were none over another.
    pub fn share(&self) -> f64 {
        let size = self.high - self.low;
        (self.area / (size.x * size.y)).clamp(0.0, 1.0)
    }

    /// Adds a part where its rank is among the others: sums go by that order.
    fn add(&mut self, member: Member) {
        let at = self.members.partition_point(|other| other.rank < member.rank);
        if at == self.members.len() {
            self.take_in(&member);
            self.members.push(member);
        } else {
            self.members.insert(at, member);
            self.sum_up();
        }
    }

    /// Takes out what belongs to an instance.
    fn remove(&mut self, place: u32) {
        self.members.retain(|member| member.place != place);
        self.sum_up();
    }

    fn sum_up(&mut self) {
        let members = std::mem::take(&mut self.members);
        self.clear();
        members.iter().for_each(|member| self.take_in(member));
        self.members = members;
    }

    fn take_in(&mut self, member: &Member) {
        (self.low, self.high) = (self.low.min(member.low), self.high.max(member.high));
        self.area += member.area;
        self.seen_from[0] |= member.body <= 0.0;
        self.seen_from[1] |= member.body >= 0.0;
    }
}

impl Member {
    fn new(plane: &ScenePlane, flat: &Flat) -> Self {
        let at = flat.corners.map(|p| DVec2::new(plane.right.dot(p), plane.up.dot(p)));
        let low = at.into_iter().fold(DVec2::INFINITY, DVec2::min);
        let high = at.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
        let [a, b, _, d] = flat.corners;
        let body = flat.body.map_or(0.0, |middle| plane.plane.dot(middle.extend(1.0)).signum());
        let area = (b - a).cross(d - a).length() * flat.share;
        Self { rank: flat.rank, place: flat.place, low, high, area, body }
    }
}

#[cfg(test)]
mod tests;

//! The planes that shadows fall on: flat parts of receivers, where those of several instances that
//! lie in one plane are one. Found once a scene; who moves is found again.

use super::placed::Placed;
use super::places::Places;
use super::vertices::MeshPart;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::atomic::{AtomicU64, Ordering};
use umbrage_core::facets::{Facet, facets};
use umbrage_core::glam::{DVec2, DVec3, DVec4};

/// All planes of a scene, relative to [`super::Casters::origin`].
pub(crate) struct ScenePlanes {
    origin: DVec3,
    /// By mesh.
    facets: Vec<Vec<Facet>>,
    planes: Vec<ScenePlane>,
    /// Numbers of planes, by direction and offset in coarse steps.
    cells: HashMap<Cell, Vec<u32>>,
    /// Numbers of planes without members.
    spare: Vec<u32>,
    /// Numbers of planes, by place in [`super::Casters::placed`].
    of_place: Vec<Vec<u32>>,
    /// Points may be off by so much and be in a plane, metres; more where receivers move far out.
    flatness: f64,
    /// Steps of [`Cell`] in metres, which stay.
    step: f64,
    version: u64,
    /// Receivers without a plane.
    without: u64,
}

type Cell = [i64; 4];

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
}

/// A flat part of an instance.
struct Member {
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
    pub(super) fn new(origin: DVec3, meshes: &[MeshPart], placed: &[Placed], solid: &Places) -> Self {
        let receives = |mesh: usize| placed.iter().any(|p| p.receives && !p.posed && p.mesh as usize == mesh);
        let of_mesh = |(number, part): (usize, &MeshPart)| match receives(number) {
            true => facets(&part.mesh),
            false => Vec::new(),
        };
        let flatness = placed.iter().map(|p| flatness(origin, p)).fold(0.0, f64::max);
        let mut planes = Self {
            origin,
            facets: meshes.iter().enumerate().map(of_mesh).collect(),
            planes: Vec::new(),
            cells: HashMap::new(),
            spare: Vec::new(),
            of_place: vec![Vec::new(); placed.len()],
            flatness,
            step: 1e2 * flatness,
            version: next_version(),
            without: 0,
        };
        (0..).zip(placed).for_each(|(place, p)| planes.insert(place, p, solid.has(place)));
        let without = placed.iter().zip(&planes.of_place).filter(|(p, of)| p.receives && of.is_empty());
        planes.without = without.count() as u64;
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
        self.without
    }

    /// After an instance has moved; `solid` where it is a convex body, wound outwards.
    pub(super) fn update(&mut self, place: u32, placed: &Placed, solid: bool) {
        // What joints bend has no planes.
        if placed.posed {
            return;
        }
        self.flatness = self.flatness.max(flatness(self.origin, placed));
        for number in std::mem::take(&mut self.of_place[place as usize]) {
            let plane = &mut self.planes[number as usize];
            plane.remove(place);
            if plane.is_empty() {
                if let Entry::Occupied(mut found) = self.cells.entry(plane.cell) {
                    found.get_mut().retain(|n| *n != number);
                    if found.get().is_empty() {
                        found.remove();
                    }
                }
                self.spare.push(number);
            }
        }
        self.insert(place, placed, solid);
        self.version = next_version();
    }

    fn insert(&mut self, place: u32, placed: &Placed, solid: bool) {
        if !placed.receives || placed.posed {
            return;
        }
        let facets = std::mem::take(&mut self.facets[placed.mesh as usize]);
        for facet in &facets {
            let corners = facet.corners.map(|p| placed.world_from_mesh.transform_point3(p) - self.origin);
            if let Some(number) = self.plane_of(&corners) {
                let plane = &mut self.planes[number as usize];
                let body = plane.plane.dot((placed.bounds.center() - self.origin).extend(1.0)).signum();
                let body = if solid { body } else { 0.0 };
                plane.add(Member { body, ..Member::new(plane, place, &corners, facet.share) });
                let of = &mut self.of_place[place as usize];
                if !of.contains(&number) {
                    of.push(number);
                }
            }
        }
        self.facets[placed.mesh as usize] = facets;
    }

    /// The plane through four corners, an old one where they lie in one.
    fn plane_of(&mut self, corners: &[DVec3; 4]) -> Option<u32> {
        let [a, b, c, d] = *corners;
        let normal = (c - a).cross(d - b).try_normalize().filter(|n| n.is_finite())?;
        let largest = normal.to_array().into_iter().max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
        let normal = normal * largest.signum();
        let middle = (a + b + c + d) * 0.25;
        let plane = normal.extend(-normal.dot(middle));
        let [x, y, z] = (normal * 1e3).round().to_array().map(|v| v as i64);
        let step = (plane.w / self.step).round() as i64;
        for near in [step, step.saturating_sub(1), step.saturating_add(1)] {
            let found = self.cells.get(&[x, y, z, near]).into_iter().flatten();
            let fits = |i: &&u32| self.planes[**i as usize].holds(corners, self.flatness);
            if let Some(&number) = found.into_iter().find(fits) {
                return Some(number);
            }
        }
        let new = ScenePlane::new(plane, b - a, [x, y, z, step]);
        let number = self.spare.pop().unwrap_or(self.planes.len() as u32);
        self.cells.entry(new.cell).or_default().push(number);
        match self.planes.get_mut(number as usize) {
            Some(spare) => *spare = new,
            None => self.planes.push(new),
        }
        Some(number)
    }
}

/// How far off its planes an instance may be by rounding, metres.
fn flatness(origin: DVec3, placed: &Placed) -> f64 {
    let far = (placed.bounds.min - origin).abs().max((placed.bounds.max - origin).abs()).max_element();
    if placed.bounds.is_empty() { 0.0 } else { FLATNESS * far }
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
        }
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

    fn add(&mut self, member: Member) {
        (self.low, self.high) = (self.low.min(member.low), self.high.max(member.high));
        self.area += member.area;
        self.seen_from[0] |= member.body <= 0.0;
        self.seen_from[1] |= member.body >= 0.0;
        self.members.push(member);
    }

    /// Takes out what belongs to an instance.
    fn remove(&mut self, place: u32) {
        let mut members = std::mem::take(&mut self.members);
        members.retain(|member| member.place != place);
        (self.low, self.high, self.area) = (DVec2::INFINITY, DVec2::NEG_INFINITY, 0.0);
        self.seen_from = [false; 2];
        members.into_iter().for_each(|member| self.add(member));
    }
}

impl Member {
    fn new(plane: &ScenePlane, place: u32, corners: &[DVec3; 4], share: f64) -> Self {
        let at = corners.map(|p| DVec2::new(plane.right.dot(p), plane.up.dot(p)));
        let low = at.into_iter().fold(DVec2::INFINITY, DVec2::min);
        let high = at.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
        let [a, b, _, d] = *corners;
        Self { place, low, high, area: (b - a).cross(d - a).length() * share, body: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::ScenePlane;
    use crate::{Casters, Gpu};
    use umbrage_core::glam::{DAffine3, DVec3};
    use umbrage_core::{Material, Scene, primitive};

    /// Two tiles of a floor, and a box on it.
    fn scene() -> Scene {
        let mut scene = Scene::default();
        let (tile, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
        let material = scene.add_material(Material::default());
        let far = DVec3::new(1e7, 0.0, 3e6);
        for x in [0.0, 1.0] {
            scene.place(tile, material, DAffine3::from_translation(far + DVec3::X * x));
        }
        scene.place(cube, material, DAffine3::from_translation(far + DVec3::new(0.2, 0.5, 0.0)));
        scene
    }

    #[test]
    fn planes_are_used_again_by_one_alone() {
        let gpu = Gpu::request(None).expect("this test needs a graphics adapter");
        let mut scene = scene();
        // Both of its sides are in one plane.
        scene.place(
            1,
            0,
            DAffine3::from_scale_rotation_translation(
                DVec3::new(1.0, 1e-9, 1.0),
                Default::default(),
                DVec3::new(1e7, 2.0, 3e6),
            ),
        );
        let mut casters = Casters::new(&gpu, &scene).expect("casters");
        casters.receiver_planes();
        for i in 0..50 {
            for instance in [3, 0] {
                let up = DAffine3::from_translation(DVec3::Y * 0.01 * f64::from(i));
                casters.move_instance(&gpu, instance, &(up * scene.instances[instance].world_from_mesh));
            }
        }
        let planes = casters.receiver_planes();
        let mut spare = planes.spare.clone();
        spare.sort_unstable();
        spare.dedup();
        assert_eq!(spare.len(), planes.spare.len(), "a plane is spare twice");
        assert!(spare.iter().all(|&number| planes.all()[number as usize].is_empty()), "a spare plane is in use");
        assert!(planes.all().len() < 20, "{} planes", planes.all().len());
    }

    #[test]
    fn coplanar_receivers_share_a_plane_and_movers_change_theirs() {
        let gpu = Gpu::request(None).expect("this test needs a graphics adapter");
        let scene = scene();
        let mut casters = Casters::new(&gpu, &scene).expect("casters");
        let count = |casters: &Casters| casters.receiver_planes().all().iter().filter(|p| !p.is_empty()).count();
        // The floor has the bottom of the box, too.
        assert_eq!(count(&casters), 6);
        let area = |p: &ScenePlane| if p.is_empty() { 0.0 } else { (p.high - p.low).element_product() };
        let largest = casters.receiver_planes().all().iter().map(area).fold(0.0, f64::max);
        assert!((largest - 2.0).abs() < 1e-6, "{largest}");
        let version = casters.receiver_planes().version();
        let up = DAffine3::from_translation(DVec3::Y * 0.3) * scene.instances[2].world_from_mesh;
        casters.move_instance(&gpu, 2, &up);
        assert_eq!(count(&casters), 7);
        assert_ne!(casters.receiver_planes().version(), version);
        casters.move_instance(&gpu, 2, &scene.instances[2].world_from_mesh);
        assert_eq!(count(&casters), 6);
        for i in 1..50 {
            let up = DAffine3::from_translation(DVec3::Y * 0.01 * f64::from(i)) * scene.instances[2].world_from_mesh;
            casters.move_instance(&gpu, 2, &up);
        }
        assert_eq!((count(&casters), casters.receiver_planes().all().len()), (7, 7), "planes are used again");
    }
}

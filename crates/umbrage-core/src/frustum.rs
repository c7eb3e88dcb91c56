//! View volumes as planes: culling of boxes, and the part of a box that is inside.

use crate::bounds::Bounds;
use crate::volume::Side;
use glam::{DMat4, DVec3, DVec4};

/// The planes of a clip volume. A point p is inside where `plane · (p, 1) ≥ 0` for all of them.
#[derive(Clone, Debug)]
pub struct Frustum {
    /// Unit normals with the offset in `w`. An infinite far plane is left out.
    planes: Vec<DVec4>,
    corners: Vec<DVec3>,
}

impl Frustum {
    /// The volume of WebGPU's clip space (x, y in [−w, w], z in [0, w]) seen from the space
    /// `clip_from` starts in.
    pub fn of(clip_from: &DMat4) -> Self {
        let row = |i: usize| clip_from.row(i);
        let w = row(3);
        let planes = [w + row(0), w - row(0), w + row(1), w - row(1), row(2), w - row(2)]
            .into_iter()
            .filter_map(|p| {
                let length = p.truncate().length();
                (length > 1e-12 * p.abs().max_element()).then(|| p / length)
            })
            .collect();
        Self::bounded_by(planes)
    }

    /// The part that is in both.
    pub fn and(mut self, other: &Self) -> Self {
        self.planes.extend(&other.planes);
        Self::bounded_by(self.planes)
    }

    /// With every plane `margin` farther out.
    pub fn grown(&self, margin: f64) -> Self {
        Self::bounded_by(self.planes.iter().map(|plane| *plane + DVec4::W * margin).collect())
    }

    /// Inside of all these planes, unit normals with the offset in `w`.
    pub(crate) fn bounded_by(planes: Vec<DVec4>) -> Self {
        let corners = corners(&planes);
        Self { planes, corners }
    }

    /// False only where the box is surely outside.
    pub fn may_see(&self, bounds: &Bounds) -> bool {
        self.may_see_by(bounds, !0)
    }

    /// By the planes whose bits are set, and those after the 64th.
    pub(crate) fn may_see_by(&self, bounds: &Bounds, planes: u64) -> bool {
        if bounds.is_empty() {
            return false;
        }
        let (center, half) = (bounds.center(), bounds.size() * 0.5);
        self.numbered(planes).all(|(_, plane)| {
            let (height, reach) = height_and_reach(plane, center, half);
            height + reach >= 0.0
        })
    }

    /// By the planes whose bits are set; leaves those that cut the box.
    pub(crate) fn side_of(&self, bounds: &Bounds, planes: &mut u64) -> Side {
        if bounds.is_empty() {
            return Side::Outside;
        }
        let (center, half) = (bounds.center(), bounds.size() * 0.5);
        let (mut cutting, mut side) = (0, Side::Inside);
        for (i, plane) in self.numbered(*planes) {
            let (height, reach) = height_and_reach(plane, center, half);
            // A number that isn't one is on no side.
            if height + reach < 0.0 || height.is_nan() {
                return Side::Outside;
            }
            if height - reach < 0.0 {
                side = Side::Partly;
                cutting |= bit(i);
            }
        }
        *planes = cutting;
        side
    }

    fn numbered(&self, bits: u64) -> impl Iterator<Item = (usize, &DVec4)> {
        self.planes.iter().enumerate().filter(move |(i, _)| *i >= 64 || bits & bit(*i) != 0)
    }

    /// True where the whole box is inside.
    pub fn holds(&self, bounds: &Bounds) -> bool {
        self.planes.iter().all(|plane| holds(plane, bounds))
    }

    /// Appends the corners of box ∩ frustum, a convex body, to `points`.
    ///
    /// Corners may come more than once. Nothing is appended where the intersection is empty.
    pub fn clip_box(&self, bounds: &Bounds, points: &mut Vec<DVec3>) {
        if !self.may_see(bounds) {
            return;
        }
        let c = bounds.corners();
        let cutting = || self.planes.iter().filter(|plane| !holds(plane, bounds));
        if cutting().next().is_none() {
            points.extend(c);
            return;
        }
        // The faces of the box, cut by every plane; and the edges of the frustum, cut by the box,
        // come out of the same polygons only where they lie in a face, so the frustum's own corners
        // inside the box are added too.
        const FACES: [[usize; 4]; 6] =
            [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];
        let (mut polygon, mut cut) = (Vec::with_capacity(16), Vec::with_capacity(16));
        for face in FACES {
            polygon.clear();
            polygon.extend(face.map(|i| c[i]));
            for plane in cutting() {
                cut.clear();
                clip(&polygon, *plane, &mut cut);
                std::mem::swap(&mut polygon, &mut cut);
            }
            points.extend(&polygon);
        }
        let inside = bounds.grown(1e-9 * bounds.size().max_element());
        points.extend(self.corners.iter().copied().filter(|p| p.cmpge(inside.min).all() && p.cmple(inside.max).all()));
    }

    /// The points where three planes meet inside the volume: eight, or four for an infinite far
    /// plane.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }
}

/// The bit of a plane, if it has one.
fn bit(plane: usize) -> u64 {
    if plane < 64 { 1 << plane } else { 0 }
}

/// How far a box's middle is over a plane, and how far the box reaches from there.
fn height_and_reach(plane: &DVec4, center: DVec3, half: DVec3) -> (f64, f64) {
    let normal = plane.truncate();
    (normal.dot(center) + plane.w, normal.abs().dot(half))
}

/// True where the whole box is on the inner side of a plane.
fn holds(plane: &DVec4, bounds: &Bounds) -> bool {
    let (height, reach) = height_and_reach(plane, bounds.center(), bounds.size() * 0.5);
    height - reach >= 0.0
}

fn corners(planes: &[DVec4]) -> Vec<DVec3> {
    let mut corners = Vec::new();
    let n = planes.len();
    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                let [a, b, c] = [planes[i], planes[j], planes[k]];
                let (na, nb, nc) = (a.truncate(), b.truncate(), c.truncate());
                let det = na.dot(nb.cross(nc));
                if det.abs() < 1e-12 {
                    continue;
                }
                let p = -(nb.cross(nc) * a.w + nc.cross(na) * b.w + na.cross(nb) * c.w) / det;
                let slack = 1e-9 * (1.0 + p.abs().max_element());
                if planes.iter().all(|q| q.truncate().dot(p) + q.w >= -slack) {
                    corners.push(p);
                }
            }
        }
    }
    corners
}

/// The part of a convex polygon on the inner side of `plane` (Sutherland–Hodgman).
pub fn clip_polygon(polygon: &[DVec3], plane: DVec4) -> Vec<DVec3> {
    let mut out = Vec::with_capacity(polygon.len() + 1);
    clip(polygon, plane, &mut out);
    out
}

/// The same, appended to `out`.
fn clip(polygon: &[DVec3], plane: DVec4, out: &mut Vec<DVec3>) {
    let side = |p: DVec3| plane.truncate().dot(p) + plane.w;
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (da, db) = (side(a), side(b));
        if da >= 0.0 {
            out.push(a);
        }
        if (da >= 0.0) != (db >= 0.0) {
            out.push(a + (b - a) * (da / (da - db)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;

    fn frustum() -> Frustum {
        let c = Camera { eye: DVec3::ZERO, target: DVec3::NEG_Z, fov_y_deg: 90.0, near: 1.0, ..Camera::default() };
        Frustum::of(&c.view(100, 100).clip_from_world())
    }

    #[test]
    fn an_infinite_frustum_has_five_planes_and_four_corners() {
        let f = frustum();
        assert_eq!(f.planes.len(), 5);
        let corners = f.corners();
        assert_eq!(corners.len(), 4);
        assert!(corners.iter().all(|c| (c.z + 1.0).abs() < 1e-9 && (c.x.abs() - 1.0).abs() < 1e-9));
    }

    #[test]
    fn boxes_are_told_apart() {
        let f = frustum();
        let at = |z: f64, r: f64| Bounds { min: DVec3::new(-r, -r, z - r), max: DVec3::new(r, r, z + r) };
        assert!(f.holds(&at(-10.0, 1.0)));
        assert!(f.may_see(&at(-10.0, 100.0)) && !f.holds(&at(-10.0, 100.0)));
        assert!(!f.may_see(&at(10.0, 1.0)));
        assert!(!f.may_see(&Bounds::EMPTY));
    }

    #[test]
    fn a_clipped_box_is_the_intersection() {
        // A slab that reaches far to both sides: cut to |x|, |y| ≤ 5 at z = −5 and 10 at z = −10.
        let slab = Bounds { min: DVec3::new(-1e3, -1e3, -10.0), max: DVec3::new(1e3, 1e3, -5.0) };
        let mut points = Vec::new();
        frustum().clip_box(&slab, &mut points);
        let b = Bounds::of(points);
        assert!((b.min - DVec3::new(-10.0, -10.0, -10.0)).length() < 1e-6, "{b:?}");
        assert!((b.max - DVec3::new(10.0, 10.0, -5.0)).length() < 1e-6, "{b:?}");
    }

    #[test]
    fn a_box_around_the_eye_keeps_the_near_plane() {
        let around = Bounds { min: DVec3::splat(-4.0), max: DVec3::splat(4.0) };
        let mut points = Vec::new();
        frustum().clip_box(&around, &mut points);
        let b = Bounds::of(points);
        assert!((b.max.z + 1.0).abs() < 1e-9 && (b.min.z + 4.0).abs() < 1e-9, "{b:?}");
    }
}

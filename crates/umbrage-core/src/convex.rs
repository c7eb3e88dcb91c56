//! Convex bodies from a few points, some of them perhaps at infinity.

use crate::{
    bounds::Bounds,
    volume::{Side, Volume},
};
use glam::{DVec3, DVec4};

/// A convex body as planes: a point p is inside where `plane · (p, 1) ≥ 0` for all of them. Without
/// planes it is all of space.
#[derive(Clone, Debug, PartialEq)]
pub struct Convex {
    planes: Vec<DVec4>,
}

/// Planes that a point is outside of by less than this share of its distance are kept, and moved
/// out to it. Too large a value costs planes that bound nothing, too small a one faces that
/// rounding has bent.
const BENT: f64 = 1e-7;

/// Three points are taken to be on a line where the sine of the angle at one of them is less.
const STRAIGHT: f64 = 1e-10;

/// Planes are moved out by this share of the size of things, so that rounding cuts nothing off.
const SLACK: f64 = 1e-12;

impl Convex {
    /// The convex hull of homogeneous points, at most about a dozen: points with w ≠ 0, directions
    /// to points at infinity with w = 0. The body is never smaller than the hull, however
    /// degenerate that is. Without a point that is finite, or with one that is not a number, it is
    /// all of space.
    ///
    /// Besides the faces of the hull there are the planes that touch it along an edge and parallel
    /// to an axis, or in a point and perpendicular to one: with them the test of a box misses no
    /// separating plane (Gottschalk's separating axis theorem), and a hull without thickness needs
    /// no case of its own.
    pub fn hull(points: &[DVec4]) -> Self {
        let finite = points.iter().find(|p| p.w != 0.0);
        let origin = finite.map_or(DVec3::ZERO, |p| p.truncate() / p.w);
        let relative: Vec<_> = points.iter().map(|p| (p.truncate() - origin * p.w).extend(p.w)).collect();
        Self::hull_about(origin, &relative)
    }

    /// The same for points relative to `origin`: what is small and near it keeps its precision.
    pub(crate) fn hull_about(origin: DVec3, points: &[DVec4]) -> Self {
        let hull = Hull::new(origin, points);
        let mut planes = Vec::with_capacity(32);
        if !hull.points.iter().all(|p| p.is_finite()) || !origin.is_finite() {
            return Self { planes };
        }
        let all = hull.points.len();
        for i in 0..hull.finite {
            for j in i + 1..all {
                for k in j + 1..all {
                    hull.add_planes([i, j, k], &mut planes);
                }
            }
        }
        Self { planes }
    }

    /// Unit normals that point inwards, with the offset in `w`. Some may bound nothing that others
    /// don't.
    pub fn planes(&self) -> &[DVec4] {
        &self.planes
    }

    /// False only where the box is surely outside.
    pub fn may_touch(&self, bounds: &Bounds) -> bool {
        !bounds.is_empty() && self.planes.iter().all(|plane| height(*plane, bounds.max, bounds.min) >= 0.0)
    }

    fn holds(&self, bounds: &Bounds) -> bool {
        self.planes.iter().all(|plane| height(*plane, bounds.min, bounds.max) >= 0.0)
    }
}

impl Volume for Convex {
    fn side(&self, bounds: &Bounds) -> Side {
        Side::of(self.may_touch(bounds), || self.holds(bounds))
    }

    fn may_touch(&self, bounds: &Bounds) -> bool {
        self.may_touch(bounds)
    }
}

/// Height over a plane of the corner made of `ahead` where the normal points up an axis and of
/// `behind` elsewhere. It is rounded up, for a body may reach far from where its points are.
fn height(plane: DVec4, ahead: DVec3, behind: DVec3) -> f64 {
    let normal = plane.truncate();
    let corner = DVec3::select(normal.cmpge(DVec3::ZERO), ahead, behind);
    normal.dot(corner) + plane.w + 8.0 * f64::EPSILON * corner.abs().max_element()
}

struct Hull {
    origin: DVec3,
    /// Relative to the origin: finite points, directions, and the axes as directions.
    points: Vec<DVec4>,
    /// How many are finite.
    finite: usize,
    /// How many of the points belong to the hull: all but the axes.
    own: usize,
    slack: f64,
}

impl Hull {
    fn new(origin: DVec3, given: &[DVec4]) -> Self {
        let mut points = Vec::with_capacity(given.len() + 3);
        points.extend(given.iter().filter(|p| p.w != 0.0).map(|p| (p.truncate() / p.w).extend(1.0)));
        let finite = points.len();
        let size = points.iter().map(|p| p.truncate().length()).fold(0.0, f64::max);
        let directions = given.iter().filter(|p| p.w == 0.0 && p.truncate() != DVec3::ZERO);
        points.extend(directions.map(|p| p.truncate().normalize().extend(0.0)));
        let own = points.len();
        points.extend([DVec4::X, DVec4::Y, DVec4::Z]);
        Self { origin, points, finite, own, slack: SLACK * (size + origin.abs().max_element()) }
    }

    /// Adds the plane through three points, the first of them finite, with either side where
    /// nothing is beyond it.
    fn add_planes(&self, [i, j, k]: [usize; 3], planes: &mut Vec<DVec4>) {
        let base = self.points[i].truncate();
        let from_base = |p: DVec4| p.truncate() - base * p.w;
        let (u, v) = (from_base(self.points[j]), from_base(self.points[k]));
        let normal = u.cross(v);
        let length = normal.length();
        if length <= STRAIGHT * u.length() * v.length() {
            return;
        }
        let normal = normal / length;
        let (mut none_below, mut none_above) = (true, true);
        for point in &self.points[..self.own] {
            let v = from_base(*point);
            let height = normal.dot(v);
            let bent = height * height <= BENT * BENT * v.length_squared();
            none_below &= bent || height > 0.0;
            none_above &= bent || height < 0.0;
            if !none_below && !none_above {
                return;
            }
        }
        for (wanted, normal) in [(none_below, normal), (none_above, -normal)] {
            let known = |p: &DVec4| p.truncate().distance_squared(normal) < BENT * BENT;
            if wanted && !planes.iter().any(known) {
                planes.extend(self.supporting(normal));
            }
        }
    }

    /// The plane with this normal that has all points inside; `None` where a direction leads out of
    /// it, against which no offset helps. That costs little: the planes beside it stay.
    fn supporting(&self, normal: DVec3) -> Option<DVec4> {
        let directions = &self.points[self.finite..self.own];
        if directions.iter().any(|d| normal.dot(d.truncate()) < -4.0 * f64::EPSILON) {
            return None;
        }
        let heights = self.points[..self.finite].iter().map(|p| normal.dot(p.truncate()));
        let lowest = heights.fold(f64::INFINITY, f64::min);
        Some(normal.extend(self.slack - lowest - normal.dot(self.origin)))
    }
}

//! The planes that a camera sees, the largest on the screen first: found once for each camera.

use super::screen::{Clipper, Corner, Screen};
use crate::casters::{ScenePlane, ScenePlanes};
use crate::view::View;
use umbrage_core::CameraView;
use umbrage_core::glam::{DVec2, DVec3, DVec4};

/// A plane with receivers in view, relative to [`crate::Casters::origin`].
#[derive(Clone, Debug)]
pub(crate) struct SeenPlane {
    /// Unit normal and offset: n · p + w = 0.
    pub plane: DVec4,
    pub right: DVec3,
    pub up: DVec3,
    /// Around what is seen of its receivers, along `right` and `up`, metres.
    pub low: DVec2,
    pub high: DVec2,
    /// How far it reaches where some of it is behind the eye, in heights of the eye over it; else
    /// 0.
    pub reach: f64,
    /// How many pixels its receivers would cover, were nothing before them.
    pub pixels: f64,
    /// Tells planes apart in the order in which their receivers came.
    pub rank: (u64, u32),
}

/// All of them.
#[derive(Default)]
pub(crate) struct SeenPlanes {
    of: Option<Key>,
    list: Vec<SeenPlane>,
    clipper: Clipper,
}

/// What the list depends on.
#[derive(PartialEq)]
struct Key {
    camera: CameraView,
    size: (u32, u32),
    planes: u64,
    tolerance: f64,
}

/// Planes that cover less of the picture are not worth their draws.
const LEAST_SHARE: f64 = 5e-4;

/// Planes that are looked through for such that coincide.
const MOST_COMPARED: usize = 128;

impl SeenPlanes {
    /// Finds them for the view's camera. Planes within `tolerance` metres of each other are one.
    pub fn update(&mut self, view: &View<'_>, tolerance: f64) {
        let planes = view.casters.receiver_planes();
        let key = Key { camera: view.camera, size: view.receivers.size, planes: planes.version(), tolerance };
        if self.of.as_ref() == Some(&key) {
            return;
        }
        self.list.clear();
        self.find(view, planes);
        self.sort();
        self.unite(tolerance + planes.flatness());
        self.sort();
        self.of = Some(key);
    }

    /// The largest on the screen first.
    pub fn list(&self) -> &[SeenPlane] {
        &self.list
    }

    /// Of planes that are as large as each other the older one comes first.
    fn sort(&mut self) {
        self.list.sort_by(|a, b| b.pixels.total_cmp(&a.pixels).then(a.rank.cmp(&b.rank)));
    }

    fn find(&mut self, view: &View<'_>, planes: &ScenePlanes) {
        let screen = Screen::of(view);
        let least = LEAST_SHARE * f64::from(view.receivers.size.0) * f64::from(view.receivers.size.1);
        let (origin, placed) = (view.casters.origin(), view.casters.placed());
        let eye = view.camera.eye - origin;
        let may_be_seen = |plane: &&ScenePlane| !plane.is_empty() && plane.may_be_seen(eye, placed, origin);
        for plane in planes.all().iter().filter(may_be_seen) {
            let ScenePlane { plane: equation, right, up, .. } = *plane;
            let corners = plane.corners().map(|p| (p, DVec2::new(right.dot(p), up.dot(p))));
            let polygon = self.clipper.clip(&screen, corners);
            let around = |(low, high): (DVec2, DVec2), (_, p): &Corner| (low.min(*p), high.max(*p));
            let (low, high) = polygon.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), around);
            let pixels = screen.area(polygon) * plane.share();
            if polygon.len() > 2 && pixels >= least {
                let farthest = plane.corners().iter().map(|p| p.distance(eye)).fold(0.0, f64::max);
                let is_before = screen.has_before(&plane.corners());
                let reach = if is_before { 0.0 } else { farthest / equation.dot(eye.extend(1.0)).abs() };
                self.list.push(SeenPlane { plane: equation, right, up, low, high, reach, pixels, rank: plane.rank });
            }
        }
    }

    /// Makes one of planes that coincide: a pixel belongs to one plane alone.
    fn unite(&mut self, tolerance: f64) {
        let mut i = 0;
        while i < self.list.len().min(MOST_COMPARED) {
            let mut plane = self.list[i].clone();
            let mut place = 0;
            self.list.retain(|other| {
                place += 1;
                place - 1 <= i || !plane.take(other, tolerance)
            });
            self.list[i] = plane;
            i += 1;
        }
    }
}

impl SeenPlane {
    /// Grows to hold another plane that coincides with it; false where it does not.
    fn take(&mut self, other: &Self, tolerance: f64) -> bool {
        let corners = other.corners();
        let coincides = corners.iter().all(|p| self.plane.dot(p.extend(1.0)).abs() <= tolerance)
            && self.corners().iter().all(|p| other.plane.dot(p.extend(1.0)).abs() <= tolerance);
        if coincides {
            for p in corners {
                let at = DVec2::new(self.right.dot(p), self.up.dot(p));
                (self.low, self.high) = (self.low.min(at), self.high.max(at));
            }
            self.pixels += other.pixels;
            self.reach = self.reach.max(other.reach);
        }
        coincides
    }

    /// Corners of what is seen.
    fn corners(&self) -> [DVec3; 4] {
        rectangle(self.plane, [self.right, self.up], [self.low, self.high])
    }
}

/// Corners, in order, of a rectangle in a plane, from its lowest and its highest corner along two
/// directions.
pub(super) fn rectangle(plane: DVec4, [right, up]: [DVec3; 2], [low, high]: [DVec2; 2]) -> [DVec3; 4] {
    let on_plane = plane.truncate() * -plane.w;
    [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)].map(|p| on_plane + right * p.x + up * p.y)
}

//! Volumes that boxes are tested against.

use crate::{bounds::Bounds, frustum::Frustum};
use glam::DVec3;

/// Where a box is as seen from a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// No point of the box is in the volume.
    Outside,
    /// Some of the box may be in the volume.
    Partly,
    /// All of the box is in the volume.
    Inside,
}

/// A volume that a [`crate::SceneTree`] can be asked about.
pub trait Volume {
    /// Where `bounds` is. `Outside` and `Inside` only where that is certain, and then the same, but
    /// for rounding, for every box within `bounds`. An empty box is outside.
    fn side(&self, bounds: &Bounds) -> Side;

    /// False where `bounds` is surely outside: less work than [`Volume::side`] where that is all
    /// one wants to know.
    fn may_touch(&self, bounds: &Bounds) -> bool {
        self.side(bounds) != Side::Outside
    }

    /// [`Volume::side`] of a box within others that were asked about. `cutting` has a bit for each
    /// plane, or what else bounds the volume, that cuts those others and so may cut this one: all
    /// to begin with. Only those are looked at, and those that don't cut this box are taken out.
    fn side_within(&self, bounds: &Bounds, cutting: &mut u64) -> Side {
        _ = cutting;
        self.side(bounds)
    }

    /// The same for [`Volume::may_touch`].
    fn may_touch_within(&self, bounds: &Bounds, cutting: u64) -> bool {
        _ = cutting;
        self.may_touch(bounds)
    }
}

impl Side {
    pub(crate) fn of(may_touch: bool, holds: impl FnOnce() -> bool) -> Self {
        match may_touch {
            false => Self::Outside,
            true if holds() => Self::Inside,
            true => Self::Partly,
        }
    }
}

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its middle, metres.
    pub center: DVec3,
    /// Its radius, metres, not negative; infinity is everything.
    pub radius: f64,
}

impl Volume for Sphere {
    fn side(&self, bounds: &Bounds) -> Side {
        let (below, above) = (bounds.min - self.center, self.center - bounds.max);
        let nearest = below.max(above).max(DVec3::ZERO);
        let farthest = below.abs().max(above.abs());
        let square = self.radius * self.radius;
        let misses = bounds.is_empty() || nearest.length_squared() > square;
        Side::of(!misses, || farthest.length_squared() <= square)
    }
}

impl Volume for Bounds {
    fn side(&self, bounds: &Bounds) -> Side {
        let touches = bounds.min.cmple(self.max).all() && bounds.max.cmpge(self.min).all();
        Side::of(touches && !bounds.is_empty() && !self.is_empty(), || {
            bounds.min.cmpge(self.min).all() && bounds.max.cmple(self.max).all()
        })
    }
}

impl Volume for Frustum {
    fn side(&self, bounds: &Bounds) -> Side {
        self.side_of(bounds, &mut { !0 })
    }

    fn may_touch(&self, bounds: &Bounds) -> bool {
        self.may_see(bounds)
    }

    fn side_within(&self, bounds: &Bounds, cutting: &mut u64) -> Side {
        self.side_of(bounds, cutting)
    }

    fn may_touch_within(&self, bounds: &Bounds, cutting: u64) -> bool {
        self.may_see_by(bounds, cutting)
    }
}

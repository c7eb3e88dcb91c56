//! A plane under a light, and the volume of what may shadow it.

use super::seen::{SeenPlane, rectangle};
use crate::casters::Placed;
use crate::view::View;
use umbrage_core::Bounds;
use umbrage_core::glam::{DVec2, DVec3, DVec4};
use umbrage_core::scene_tree::{Side, Volume};

/// See the module. All of it is relative to `origin`.
#[derive(Clone, Debug)]
pub(crate) struct LitPlane {
    pub origin: DVec3,
    /// Unit normal on the light's side, and offset.
    pub plane: DVec4,
    pub right: DVec3,
    pub up: DVec3,
    /// Around what is seen of the receivers, along `right` and `up`, metres.
    pub low: DVec2,
    pub high: DVec2,
    /// As that of [`SeenPlane`].
    pub reach: f64,
    /// The light's centre over its height: the way back along a ray for each metre of height. It
    /// is a point where `inverse_height` is not 0, else a direction.
    pub light: DVec3,
    /// One over the height of the light, 0 for parallel light.
    pub inverse_height: f64,
    /// What is no higher than this lies in the plane, metres.
    pub least: f64,
    /// Around the shadows of all casters, as far as that is known, along `right` and `up`, metres.
    pub shadows: (DVec2, DVec2),
    /// The largest that a caster has of h / (1 − h / H), H that of the light.
    pub highest: f64,
    /// Rectangles around all shadows, over that around what is seen: about how often shadows lie on
    /// each other. Infinite where that is not known.
    pub depth: f64,
}

/// Least sine of the angle between parallel light and a plane.
const LEAST_SINE: f64 = 1e-6;

/// Share of the light's height up to which a caster counts as below the light.
const BELOW: f64 = 0.999;

/// What of a caster is between plane and light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Between {
    Nothing,
    /// Some of it may be.
    Part,
    All,
}

impl LitPlane {
    /// `None` where the light is in the plane. `light` is a point or a direction, relative to
    /// `origin`.
    pub fn of(seen: &SeenPlane, origin: DVec3, light: DVec4, least: f64) -> Option<Self> {
        let height = seen.plane.dot(light);
        let is_above = if light.w == 0.0 { height.abs() > LEAST_SINE } else { height.abs() > least };
        let SeenPlane { plane, right, up, low, high, reach, .. } = *seen;
        is_above.then(|| Self {
            origin,
            plane: plane * height.signum(),
            right,
            up,
            low,
            high,
            reach,
            light: light.truncate() / height.abs(),
            inverse_height: light.w / height.abs(),
            least,
            shadows: (DVec2::NEG_INFINITY, DVec2::INFINITY),
            highest: f64::INFINITY,
            depth: f64::INFINITY,
        })
    }

    /// True where a point, relative to the origin, is on the light's side.
    pub fn is_before(&self, p: DVec3) -> bool {
        self.plane.dot(p.extend(1.0)) > 0.0
    }

    /// A point of the plane, relative to the origin.
    pub fn at(&self, p: DVec2) -> DVec3 {
        self.plane.truncate() * -self.plane.w + self.right * p.x + self.up * p.y
    }

    /// Corners of a part of the plane, relative to the origin, with their places in it.
    pub fn corners(&self, low: DVec2, high: DVec2) -> [(DVec3, DVec2); 4] {
        rectangle(self.plane, [self.right, self.up], [low, high])
            .map(|p| (p, DVec2::new(self.right.dot(p), self.up.dot(p))))
    }

    /// The plane's equation for points relative to the eye.
    pub fn relative_to(&self, view: &View<'_>) -> DVec4 {
        let eye = view.camera.eye - self.origin;
        self.plane.truncate().extend(self.plane.dot(eye.extend(1.0)))
    }

    /// The lowest and the highest point of a box over the plane.
    fn heights(&self, bounds: &Bounds) -> [f64; 2] {
        let normal = self.plane.truncate();
        let middle = normal.dot(bounds.center() - self.origin) + self.plane.w;
        let reach = normal.abs().dot(bounds.size() * 0.5);
        [middle - reach, middle + reach]
    }

    /// Where the shadow of a point falls, homogeneous, along `right` and `up`, and the height of
    /// the point.
    pub(super) fn project(&self, p: DVec3) -> (DVec3, f64) {
        let p = p - self.origin;
        let height = self.plane.dot(p.extend(1.0));
        let on_plane = p - self.light * height;
        (DVec3::new(self.right.dot(on_plane), self.up.dot(on_plane), 1.0 - self.inverse_height * height), height)
    }

    /// The same; the point is below the light.
    fn shadow(&self, p: DVec3) -> DVec2 {
        let (at, _) = self.project(p);
        at.truncate() / at.z
    }

    /// A rectangle around the shadow of a box; `None` where that may reach any distance.
    fn shadow_of(&self, bounds: &Bounds) -> Option<(DVec2, DVec2)> {
        let [_, high] = self.heights(bounds);
        let around = |(low, high): (DVec2, DVec2), p: DVec2| (low.min(p), high.max(p));
        let shadow = || bounds.corners().map(|p| self.shadow(p));
        (high * self.inverse_height < BELOW)
            .then(|| shadow().into_iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), around))
    }

    /// Makes the rectangle no larger than all shadows.
    pub(super) fn shrink(&mut self, (low, high): (DVec2, DVec2)) {
        self.shadows = (low - self.least, high + self.least);
        (self.low, self.high) = (self.shadows.0.clamp(self.low, self.high), self.shadows.1.clamp(self.low, self.high));
    }

    /// The largest h / (1 − h / H) in a box; infinite where that is level with the light.
    pub fn reach_of(&self, bounds: &Bounds) -> f64 {
        let [_, high] = self.heights(bounds);
        let share = 1.0 - self.inverse_height * high;
        if share > 1.0 - BELOW { high.max(0.0) / share } else { f64::INFINITY }
    }

    /// Grows what is seen by so many metres to each side.
    pub fn grow(&mut self, margin: f64) {
        (self.low, self.high) = (self.low - margin, self.high + margin);
    }

    /// Where a caster stands.
    pub(super) fn between(&self, placed: &Placed) -> Between {
        let [low, high] = self.heights(&placed.bounds);
        if placed.bounds.is_empty() || high <= self.least || low * self.inverse_height >= 1.0 {
            return Between::Nothing;
        }
        let is_whole = low >= -self.least && high * self.inverse_height < BELOW;
        if is_whole { Between::All } else { Between::Part }
    }
}

/// The volume of what may shadow the visible rectangle.
impl Volume for LitPlane {
    fn side(&self, bounds: &Bounds) -> Side {
        if self.may_touch(bounds) { Side::Partly } else { Side::Outside }
    }

    fn may_touch(&self, bounds: &Bounds) -> bool {
        let [low, high] = self.heights(bounds);
        if bounds.is_empty() || high <= self.least || low * self.inverse_height >= 1.0 {
            return false;
        }
        let Some((from, to)) = self.shadow_of(bounds) else { return true };
        from.cmple(self.high + self.least).all() && to.cmpge(self.low - self.least).all()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn floor() -> SeenPlane {
        let (low, high) = (DVec2::splat(-5.0), DVec2::splat(5.0));
        SeenPlane {
            plane: DVec4::Y,
            right: DVec3::X,
            up: DVec3::NEG_Z,
            low,
            high,
            reach: 0.0,
            pixels: 1.0,
            rank: (0, 0),
        }
    }

    fn lit(light: DVec4) -> Option<LitPlane> {
        LitPlane::of(&floor(), DVec3::ZERO, light, 1e-5)
    }

    fn cube(x: f64, y: f64) -> Bounds {
        let center = DVec3::new(x, y, 0.0);
        Bounds { min: center - 0.5, max: center + 0.5 }
    }

    #[test]
    fn shadows_fall_where_rays_meet_the_plane() {
        for light in [DVec4::new(1.0, 4.0, -2.0, 1.0), DVec4::new(0.3, 0.5, -0.2, 0.0)] {
            let lit = lit(light).expect("the light is above");
            let p = DVec3::new(0.7, 1.5, 0.4);
            let away = p * light.w - light.truncate();
            let hit = p + away * (p.y / -away.y);
            assert!(lit.shadow(p).distance(DVec2::new(hit.x, -hit.z)) < 1e-12, "{light}");
            // A point of the plane stays, as M x ∝ x says.
            assert!(lit.shadow(DVec3::X).distance(DVec2::X) < 1e-12);
        }
    }

    #[test]
    fn lights_in_a_plane_light_nothing_and_those_behind_the_other_side() {
        assert!(lit(DVec4::new(2.0, 0.0, 0.0, 1.0)).is_none() && lit(DVec4::new(1.0, 0.0, 0.0, 0.0)).is_none());
        let behind = lit(DVec4::new(2.0, -3.0, 0.0, 1.0)).expect("a light under the floor");
        assert!(!behind.is_before(DVec3::Y) && behind.is_before(DVec3::NEG_Y));
    }

    #[test]
    fn only_what_is_between_plane_and_light_may_shadow_it() {
        let lit = lit(DVec4::new(0.0, 4.0, 0.0, 1.0)).expect("the light is above");
        assert!(lit.may_touch(&cube(0.0, 1.0)), "above the floor");
        assert!(!lit.may_touch(&cube(0.0, -0.5)), "below it, its top in the plane");
        assert!(!lit.may_touch(&cube(0.0, 5.0)), "above the light");
        assert!(lit.may_touch(&cube(60.0, 3.9)), "level with the light");
        assert!(!lit.may_touch(&cube(9.0, 1.0)), "its shadow falls beside what is seen");
        assert!(lit.may_touch(&cube(0.0, 0.0)), "through the plane");
    }
}

//! The outline of a box's shadow on a plane, which tells more than the rectangle around it.

use super::lit::LitPlane;
use umbrage_core::glam::{DVec2, DVec3};

/// What of a box is between a plane and a light, projected: its corners, homogeneous, along the
/// plane's axes.
pub(super) struct Shadow {
    corners: [DVec3; ROOM],
    count: usize,
}

/// A convex polygon, counter-clockwise.
pub(super) struct Outline {
    corners: [DVec2; ROOM],
    count: usize,
}

/// A box has eight corners, and two planes cut at most six edges each. The hull of at most thirteen
/// has to have room for all of them twice while it is made.
const ROOM: usize = 32;

impl Shadow {
    /// Of a box whose corners are in the order of [`umbrage_core::Bounds::corners`].
    pub fn of_box(plane: &LitPlane, corners: &[DVec3; 8]) -> Self {
        // What is no higher than that lies in the plane.
        let projected = corners.map(|p| plane.project(p)).map(|(corner, height)| (corner, height - plane.least));
        let mut shadow = Self { corners: [DVec3::ZERO; ROOM], count: 0 };
        for (i, &(corner, height)) in projected.iter().enumerate() {
            if height >= 0.0 && corner.z >= 0.0 {
                shadow.add(corner);
            }
            for other in [1, 2, 4].map(|bit| i ^ bit).into_iter().filter(|other| *other > i) {
                let (end, end_height) = projected[other];
                for (here, there) in [(height, end_height), (corner.z, end.z)] {
                    let cut = here / (here - there);
                    let (height, cut) = (height + (end_height - height) * cut, corner.lerp(end, cut));
                    if (here >= 0.0) != (there >= 0.0) && height >= -ROUNDING && cut.z >= -ROUNDING {
                        shadow.add(cut);
                    }
                }
            }
        }
        shadow
    }

    fn add(&mut self, corner: DVec3) {
        self.corners[self.count] = corner;
        self.count += 1;
    }

    fn corners(&self) -> &[DVec3] {
        &self.corners[..self.count]
    }

    /// `None` where it may reach any distance.
    pub fn outline(&self) -> Option<Outline> {
        let is_near = self.corners().iter().all(|corner| corner.z > LEAST_W);
        let mut outline = Outline { corners: [DVec2::ZERO; ROOM], count: 0 };
        self.corners().iter().filter(|_| is_near).for_each(|corner| outline.add(corner.truncate() / corner.z));
        outline.wrap();
        is_near.then_some(outline)
    }

    /// Whether all of it is beyond one of the sides of a rectangle by `slack`.
    pub fn is_beside(&self, [low, high]: [DVec2; 2], slack: f64) -> bool {
        let (low, high) = (low - slack, high + slack);
        let sides: [&dyn Fn(&DVec3) -> f64; 4] =
            [&|p| p.x - high.x * p.z, &|p| low.x * p.z - p.x, &|p| p.y - high.y * p.z, &|p| low.y * p.z - p.y];
        sides.iter().any(|beyond| self.corners().iter().all(|p| beyond(p) > 0.0))
    }
}

/// A point where an edge is cut may be off the one plane, or the other.
const ROUNDING: f64 = 1e-9;

/// Of what has an outline: what is higher has its shadow a thousand times as far away.
const LEAST_W: f64 = 1e-3;

impl Outline {
    /// Its lowest and its highest coordinates.
    pub fn around(&self) -> (DVec2, DVec2) {
        let around = |(low, high): (DVec2, DVec2), p: &DVec2| (low.min(*p), high.max(*p));
        self.corners().iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), around)
    }

    /// Whether all of a rectangle is beyond one of its sides by `slack`.
    pub fn leaves(&self, [low, high]: [DVec2; 2], slack: f64) -> bool {
        let mut sides = self.corners().iter().zip(self.corners().iter().cycle().skip(1));
        sides.any(|(&a, &b)| {
            let outward = (a - b).perp().normalize_or_zero();
            // The corner of the rectangle that is farthest inwards.
            let corner = DVec2::select(outward.cmpgt(DVec2::ZERO), low, high);
            outward.dot(corner - a) > slack
        })
    }

    fn corners(&self) -> &[DVec2] {
        &self.corners[..self.count]
    }

    fn add(&mut self, corner: DVec2) {
        self.corners[self.count] = corner;
        self.count += 1;
    }

    /// Leaves the convex hull: one side from left to right, the other one back (Andrew 1979).
    fn wrap(&mut self) {
        let (mut all, count) = (self.corners, self.count);
        if count < 2 {
            return;
        }
        all[..count].sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        self.count = 0;
        for is_back in [false, true] {
            let first = self.count;
            for i in 0..count {
                let corner = all[if is_back { count - 1 - i } else { i }];
                while self.count >= first + 2 && !self.turns_left_to(corner) {
                    self.count -= 1;
                }
                self.add(corner);
            }
            // The other side starts there.
            self.count -= 1;
        }
    }

    fn turns_left_to(&self, corner: DVec2) -> bool {
        let [a, b] = [self.corners[self.count - 2], self.corners[self.count - 1]];
        (b - a).perp_dot(corner - b) > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::super::seen::SeenPlane;
    use super::*;
    use umbrage_core::Bounds;
    use umbrage_core::glam::DVec4;

    /// A floor of two metres under a light four metres above its middle.
    fn floor() -> LitPlane {
        let seen = SeenPlane {
            plane: DVec4::Y,
            right: DVec3::X,
            up: DVec3::NEG_Z,
            low: DVec2::splat(-1.0),
            high: DVec2::splat(1.0),
            reach: 0.0,
            pixels: 1.0,
            rank: (0, 0),
        };
        LitPlane::of(&seen, DVec3::ZERO, DVec4::new(0.0, 4.0, 0.0, 1.0), 1e-5).expect("the light is above")
    }

    fn shadow(min: DVec3, max: DVec3) -> Shadow {
        Shadow::of_box(&floor(), &Bounds { min, max }.corners())
    }

    fn square(x: f64, y: f64) -> [DVec2; 2] {
        [DVec2::new(x, y), DVec2::new(x + 0.2, y + 0.2)]
    }

    #[test]
    fn the_outline_is_that_of_the_part_above_the_plane() {
        // What is under the floor has no shadow there; the top, half way to the light, has twice
        // its size.
        let found = shadow(DVec3::new(0.0, -3.0, 0.0), DVec3::new(1.0, 2.0, 1.0)).outline().expect("below the light");
        assert_eq!(found.around(), (DVec2::new(0.0, -2.0), DVec2::new(2.0, 0.0)), "all but its foot");
        assert_eq!(found.corners().len(), 4, "{:?}", found.corners());
    }

    #[test]
    fn rectangles_beside_a_slanted_shadow_are_left_out() {
        // The shadow of an upright post away from the light is a slanted strip.
        let post = shadow(DVec3::new(1.0, 0.0, 1.0), DVec3::new(1.1, 2.0, 1.1));
        let outline = post.outline().expect("it is below the light");
        assert!(shadow(DVec3::new(0.0, -1.0, 0.0), DVec3::X).is_beside(square(0.0, 0.0), 0.0), "it is in the plane");
        let touches = |square: [DVec2; 2], slack: f64| !post.is_beside(square, slack) && !outline.leaves(square, slack);
        assert!(touches(square(1.5, -1.7), 0.0), "in its middle");
        assert!(!touches(square(1.9, -1.3), 0.0), "beside it, within the rectangle around it");
        assert!(touches(square(1.9, -1.3), 0.5), "near it");
        assert!(!touches(square(3.0, -3.0), 0.1), "beyond its end");
    }

    #[test]
    fn shadows_of_what_is_level_with_the_light_go_to_one_side() {
        let post = shadow(DVec3::new(1.0, 2.0, -0.1), DVec3::new(1.1, 5.0, 0.1));
        assert!(post.outline().is_none());
        assert!(!post.is_beside(square(50.0, 0.0), 0.0), "however far away");
        assert!(post.is_beside(square(-1.0, 0.0), 0.0), "on the other side of the light");
        assert!(post.is_beside(square(1.0, 0.0), 0.0), "nearer than its lowest part");
    }
}

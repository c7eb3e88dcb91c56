//! Where in the world a scene is, in coarse steps: what single precision and the scene trees go by.

use umbrage_core::glam::DVec3;
use umbrage_core::{Bounds, scene_tree::SceneTree};

/// A cube around a scene. It depends on nothing but the box around everything, and hardly on that:
/// it stays while casters come and go, until the box's longest edge crosses a power of two, or the
/// box is elsewhere. That it goes by the past in nothing, not even to stay where a box swings about
/// such a border, is what makes changed casters those of a new scene, to the bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Region {
    /// What GPU world space is relative to.
    pub origin: DVec3,
    /// Origins are multiples of this, metres: two to four times the longest edge of the box.
    step: f64,
}

/// Edge of the smallest box that is told from a point, metres, and as a share of its coordinates.
const LEAST: f64 = 1e-3;
const LEAST_SHARE: f64 = 1e-9;

impl Region {
    pub fn of(content: &Bounds) -> Self {
        let size = content.size().max_element().max(LEAST_SHARE * content.largest_coordinate()).max(LEAST);
        // A power of two, to which floats are rounded by leaving out the mantissa.
        let power = f64::from_bits(size.to_bits() & !((1 << 52) - 1));
        let step = 4.0 * power;
        let middle = if content.is_empty() { DVec3::ZERO } else { content.center() };
        let origin = (middle / step).round() * step;
        if origin.is_finite() && step.is_finite() {
            Self { origin, step }
        } else {
            Self { origin: DVec3::ZERO, step: 4.0 }
        }
    }

    /// Metres from the origin within which about everything is, along each axis.
    pub fn reach(&self) -> f64 {
        0.75 * self.step
    }

    /// A tree for what is in it.
    pub fn tree(&self) -> SceneTree {
        SceneTree::new(Bounds { min: self.origin, max: self.origin }.grown(self.reach()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn region(min: DVec3, max: DVec3) -> Region {
        Region::of(&Bounds { min, max })
    }

    #[test]
    fn a_region_holds_its_box_and_stays_while_the_box_changes_a_little() {
        for (center, size) in [(0.0, 20.0), (31.0, 64.0), (-1e7, 300.0), (5e5, 1e-6), (64.0, 128.0)] {
            let (center, half) = (DVec3::new(center, -0.3 * center, 1.0), DVec3::splat(0.5 * size));
            let of = region(center - half, center + half);
            let far = (center - half - of.origin).abs().max((center + half - of.origin).abs()).max_element();
            assert!(far <= of.reach(), "{center} {size}: {far} of {of:?}");
            assert!(of.reach() <= 3.0 * size.max(LEAST).max(LEAST_SHARE * 1e7) * 1.01, "{of:?}");
        }
        let around_zero = region(DVec3::splat(-10.0), DVec3::splat(10.0));
        assert_eq!(around_zero.origin, DVec3::ZERO);
        assert_eq!(around_zero, region(DVec3::splat(-8.5), DVec3::splat(11.0)));
        let from_zero = region(DVec3::ZERO, DVec3::splat(64.0));
        assert_eq!(from_zero, region(DVec3::splat(-0.5), DVec3::splat(66.0)), "no border is where scenes are common");
    }

    #[test]
    fn odd_boxes_have_a_region() {
        let nothing = Region::of(&Bounds::EMPTY);
        assert!(nothing.origin == DVec3::ZERO && nothing.reach() > 0.0);
        for odd in [DVec3::splat(f64::MAX), DVec3::INFINITY, DVec3::NAN] {
            let of = region(-odd, odd);
            assert!(of.origin.is_finite() && of.reach().is_finite(), "{odd}: {of:?}");
        }
    }
}

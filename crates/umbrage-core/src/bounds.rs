//! Axis-aligned bounding boxes.

use glam::{DAffine3, DVec3};

/// An axis-aligned box in metres. `EMPTY` holds nothing and is the identity of [`Bounds::union`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest corner.
    pub min: DVec3,
    /// Largest corner.
    pub max: DVec3,
}

impl Bounds {
    /// The box that contains no point.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around `points`; points that are not finite are left out.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().filter(|p| p.is_finite()).fold(Self::EMPTY, Self::with)
    }

    /// The box grown to hold `point`.
    pub fn with(self, point: DVec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The smallest box around both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// True where there is no point inside.
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }

    /// The middle; the origin for an empty box.
    pub fn center(&self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { (self.min + self.max) * 0.5 }
    }

    /// Edge lengths; zero for an empty box.
    pub fn size(&self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { self.max - self.min }
    }

    /// Radius of the sphere around [`Bounds::center`] that holds the box.
    pub fn radius(&self) -> f64 {
        self.size().length() * 0.5
    }

    /// The box grown by `margin` metres on every side.
    pub fn grown(self, margin: f64) -> Self {
        Self { min: self.min - DVec3::splat(margin), max: self.max + DVec3::splat(margin) }
    }

    /// True where the point is in the box or on its border.
    pub fn contains(&self, p: DVec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// True where the two share a point.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Largest absolute coordinate, the scale that rounding errors go by.
    pub fn largest_coordinate(&self) -> f64 {
        if self.is_empty() { 0.0 } else { self.min.abs().max(self.max.abs()).max_element() }
    }

    /// The eight corners. Bit 0 of the index chooses x, bit 1 y, bit 2 z.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, low: f64, high: f64| if i >> bit & 1 == 0 { low } else { high };
            DVec3::new(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }

    /// The axis-aligned box around this box moved by `transform`.
    pub fn transformed(&self, transform: &DAffine3) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let center = transform.transform_point3(self.center());
        let half = self.size() * 0.5;
        let m = transform.matrix3;
        let extent = m.x_axis.abs() * half.x + m.y_axis.abs() * half.y + m.z_axis.abs() * half.z;
        Self { min: center - extent, max: center + extent }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;

    #[test]
    fn boxes_overlap_where_they_share_a_point() {
        let unit = Bounds::of([DVec3::ZERO, DVec3::ONE]);
        assert!(unit.overlaps(&Bounds::of([DVec3::ONE, DVec3::splat(2.0)])), "a corner");
        assert!(unit.overlaps(&Bounds::of([DVec3::splat(0.4), DVec3::splat(0.6)])), "all of it");
        assert!(!unit.overlaps(&Bounds::of([DVec3::new(0.0, 0.0, 1.1), DVec3::splat(2.0)])));
        assert!(!unit.overlaps(&Bounds::EMPTY), "of nothing");
        assert!(unit.contains(DVec3::X) && !unit.contains(DVec3::new(0.5, 0.5, 1.1)));
    }

    #[test]
    fn empty_is_the_identity_and_has_no_size() {
        let b = Bounds::of([DVec3::ONE, DVec3::new(-1.0, 2.0, 0.0), DVec3::NAN]);
        assert_eq!(b.union(Bounds::EMPTY), b);
        assert_eq!(Bounds::EMPTY.size(), DVec3::ZERO);
        assert!(Bounds::EMPTY.is_empty() && !b.is_empty());
    }

    #[test]
    fn a_transformed_box_holds_the_transformed_corners() {
        let b = Bounds { min: DVec3::new(-1.0, 0.0, 2.0), max: DVec3::new(3.0, 1.0, 5.0) };
        let t = DAffine3::from_mat3_translation(DMat3::from_rotation_y(0.7) * DMat3::from_rotation_x(1.9), DVec3::X);
        let moved = b.transformed(&t).grown(1e-12);
        for c in b.corners().map(|c| t.transform_point3(c)) {
            assert!(c.cmpge(moved.min).all() && c.cmple(moved.max).all());
        }
    }
}

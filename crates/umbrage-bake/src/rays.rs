//! Directions over a half sphere, more of them where the cosine is large.

use glam::swizzles::Vec2Swizzles;
use glam::{DMat3, DVec2, DVec3};
use umbrage_core::sampling::{lattice, rotated, square_to_disc};

/// The same evenly spread points for every surface point, moved for each.
pub(crate) struct Rays {
    points: Vec<DVec2>,
}

impl Rays {
    pub fn new(count: u32) -> Self {
        Self { points: lattice(count as usize) }
    }

    pub fn count(&self) -> f64 {
        self.points.len() as f64
    }

    /// Unit directions about `normal`, as dense as cos / π, and for each a point of [0, 1)² to
    /// start it from.
    pub fn around(&self, normal: DVec3, shift: DVec2) -> impl Iterator<Item = (DVec3, DVec2)> + '_ {
        let (a, b) = normal.any_orthonormal_pair();
        let world_from_local = DMat3::from_cols(a, b, normal);
        self.points.iter().zip(1_u32..).map(move |(point, number)| {
            let disc = square_to_disc(rotated(*point, shift));
            let up = (1.0 - disc.length_squared()).max(0.0).sqrt();
            // Of a second lattice in other directions, so that starts do not go with directions.
            let n = f64::from(number);
            let start = rotated(DVec2::new(n * 0.754_877_666_246_693, n * 0.569_840_290_998_053), shift.yx());
            (world_from_local * disc.extend(up), start)
        })
    }
}

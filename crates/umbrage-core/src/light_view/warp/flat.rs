//! From the rays of a light to its map: a matrix of 3 × 3.

use super::super::Fit;
use super::super::rect::{Crop, Rect};
use glam::{DMat2, DMat3, DVec2, DVec3};

/// From homogeneous rays to x, y and w of clip space.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlatMap {
    pub clip_from_ray: DMat3,
}

/// Smallest value of the horizon's function over the largest one, among all rays of a map: texels
/// differ by as much.
const LEAST: f64 = 1.0 / 512.0;

/// Turns of the map that are tried, over a right angle.
const TURNS: u32 = 24;

/// Least share that the light's own axis has of the horizon for the rays' own coordinates to go
/// with it: without any they would not tell all rays apart.
const AHEAD: f64 = 0.1;

/// Two functions of the rays that with the horizon tell all of them apart.
fn across(horizon: DVec3) -> (DVec3, DVec3) {
    let unit = horizon.normalize_or(DVec3::Z);
    if unit.z.abs() > AHEAD { (DVec3::X, DVec3::Y) } else { unit.any_orthonormal_pair() }
}

/// The nearest horizon to this one that leaves every ray well on its positive side.
pub(super) fn moved_off(horizon: DVec3, hull: &[DVec2]) -> DVec3 {
    let heights = hull.iter().map(|ray| horizon.dot(ray.extend(1.0)));
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v), h.max(v)]);
    let size = high.abs().max(low.abs());
    if !(size > 0.0 && size.is_finite() && horizon.is_finite()) {
        return DVec3::Z;
    }
    let more = ((LEAST * high - low) / (1.0 - LEAST)).max(LEAST * size - high).max(0.0);
    (horizon + DVec3::Z * more) / (high + more)
}

impl FlatMap {
    /// With this horizon, turned so that the rectangle around `hull`, which fills the map, is
    /// small.
    pub fn new(horizon: DVec3, hull: &[DVec2], fit: &Fit) -> Option<Self> {
        let horizon = moved_off(horizon, hull);
        let (right, up) = across(horizon);
        let place = |ray: DVec3| DVec2::new(right.dot(ray), up.dot(ray)) / horizon.dot(ray);
        let flat: Vec<DVec2> = hull.iter().map(|ray| place(ray.extend(1.0))).collect();
        let turned = |i: u32| DMat2::from_angle(std::f64::consts::FRAC_PI_2 * f64::from(i) / f64::from(TURNS));
        let rect = |turn: DMat2| Rect::of(flat.iter().map(|p| turn * *p));
        let area = |i: &u32| rect(turned(*i)).map_or(f64::INFINITY, |r| (r.max - r.min).element_product());
        let turn = turned((0..TURNS).min_by(|a, b| area(a).total_cmp(&area(b)))?);
        let crop = Crop::to(rect(turn)?, fit);
        let crop = DMat3::from_cols(DVec3::X * crop.scale.x, DVec3::Y * crop.scale.y, crop.moved.extend(1.0));
        let bend = DMat3::from_cols(right, up, horizon).transpose();
        let clip_from_ray = crop * DMat3::from_mat2(turn) * bend;
        // Where the middle ray is beyond the horizon the picture is mirrored, and would show the
        // other faces of all casters.
        let mirror = DVec3::new(if clip_from_ray.determinant() < 0.0 { -1.0 } else { 1.0 }, 1.0, 1.0);
        let map = Self { clip_from_ray: DMat3::from_diagonal(mirror) * clip_from_ray };
        map.clip_from_ray.is_finite().then_some(map)
    }

    /// Change of the place in the map with the ray, texels.
    pub fn texels_from_ray(&self, ray: DVec2, size: u32) -> DMat2 {
        let m = &self.clip_from_ray;
        let clip = *m * ray.extend(1.0);
        let ndc = clip.truncate() / clip.z;
        let column = |c: DVec3| (c.truncate() - ndc * c.z) * (0.5 * f64::from(size) / clip.z);
        DMat2::from_cols(column(m.x_axis), column(m.y_axis))
    }
}

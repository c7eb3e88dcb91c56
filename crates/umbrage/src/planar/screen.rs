//! What of a polygon a camera sees, and where on the screen.

use crate::view::View;
use umbrage_core::CameraView;
use umbrage_core::glam::{DMat4, DVec2, DVec3, DVec4};

/// A camera for points relative to [`crate::Casters::origin`].
pub(super) struct Screen {
    clip_from_origin: DMat4,
    nearest: f64,
    size: (u32, u32),
}

/// A corner in clip space and in its plane.
pub(super) type Corner = (DVec4, DVec2);

/// Clips polygons. Keeps its memory.
#[derive(Default)]
pub(super) struct Clipper {
    polygon: Vec<Corner>,
    cut: Vec<Corner>,
}

impl Screen {
    pub fn of(view: &View<'_>) -> Self {
        let eye = view.camera.eye - view.casters.origin();
        Self {
            clip_from_origin: view.clip_from_eye() * DMat4::from_translation(-eye),
            nearest: nearest_w(&view.camera),
            size: view.receivers.size,
        }
    }

    /// True where points are before the near plane, all of them.
    pub fn has_before(&self, points: &[DVec3]) -> bool {
        let nearest = 2.0 * self.nearest;
        points.iter().all(|p| (self.clip_from_origin * p.extend(1.0)).w >= nearest)
    }

    /// Pixels in a clipped polygon.
    pub fn area(&self, polygon: &[Corner]) -> f64 {
        let ndc = |i: usize| {
            let clip = polygon[i % polygon.len()].0;
            DVec2::new(clip.x, clip.y) / clip.w
        };
        let double: f64 = (0..polygon.len()).map(|i| ndc(i).perp_dot(ndc(i + 1))).sum();
        double.abs() * 0.125 * f64::from(self.size.0) * f64::from(self.size.1)
    }

    /// Pixels x, y, width, height around a clipped polygon, rounded outwards and one more.
    pub fn rect(&self, polygon: &[Corner]) -> [u32; 4] {
        let size = DVec2::new(self.size.0.into(), self.size.1.into());
        let pixels = polygon.iter().map(|(c, _)| (DVec2::new(c.x, -c.y) / c.w * 0.5 + 0.5) * size);
        let around = |(low, high): (DVec2, DVec2), p: DVec2| (low.min(p), high.max(p));
        let (low, high) = pixels.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), around);
        let first = (low.floor() - 1.0).max(DVec2::ZERO).min(size);
        let extent = ((high.ceil() + 1.0).min(size) - first).max(DVec2::ZERO);
        [first.x, first.y, extent.x, extent.y].map(|v| v as u32)
    }

    /// Corners, in order, around all that is seen of a rectangle in space, in normalised device
    /// coordinates: its own, a pixel farther out, or those of `rect` where part of it is not in
    /// front of the eye or it is seen edge-on.
    pub fn quad(&self, corners: &[DVec3; 4], rect: [u32; 4]) -> [DVec2; 4] {
        let size = DVec2::new(self.size.0.into(), self.size.1.into());
        let pixel = |p: DVec3| {
            let clip = self.clip_from_origin * p.extend(1.0);
            (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * size
        };
        let own = self.has_before(corners).then(|| grown(&corners.map(pixel))).flatten();
        own.map_or_else(|| quad_of(rect, self.size), |own| own.map(|p| from_pixels(p, size)))
    }
}

/// The corners of a rectangle of pixels in normalised device coordinates.
pub(super) fn quad_of([x, y, width, height]: [u32; 4], size: (u32, u32)) -> [DVec2; 4] {
    let size = DVec2::new(size.0.into(), size.1.into());
    let (low, extent) = (DVec2::new(x.into(), y.into()), DVec2::new(width.into(), height.into()));
    [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].map(|corner| from_pixels(low + extent * corner, size))
}

fn from_pixels(p: DVec2, size: DVec2) -> DVec2 {
    (p / size * 2.0 - 1.0) * DVec2::new(1.0, -1.0)
}

/// A convex polygon with each side moved outwards by 1; `None` where a corner would be far away.
fn grown(corners: &[DVec2; 4]) -> Option<[DVec2; 4]> {
    let side = |i: usize| corners[(i + 1) % 4] - corners[i % 4];
    let turn = side(0).perp_dot(side(1)).signum();
    let mut grown = *corners;
    for (i, corner) in grown.iter_mut().enumerate() {
        let [before, after] = [side(i + 3), side(i)].map(|side| side.try_normalize());
        let [before, after] = [before?, after?].map(|side| side.perp() * -turn);
        let sine = before.perp_dot(after) * turn;
        // What is not a number is no corner either.
        if sine.is_nan() || sine <= LEAST_SINE {
            return None;
        }
        *corner += (before + after) / (1.0 + before.dot(after));
    }
    Some(grown)
}

/// Of the angle at a corner of a polygon that is grown.
const LEAST_SINE: f64 = 0.05;

impl Clipper {
    /// What the camera sees of a convex polygon: nothing has no corners.
    pub fn clip(&mut self, screen: &Screen, corners: [(DVec3, DVec2); 4]) -> &[Corner] {
        self.polygon.clear();
        self.polygon.extend(corners.map(|(p, at)| (screen.clip_from_origin * p.extend(1.0), at)));
        let sides: [fn(DVec4) -> f64; 4] = [|c| c.w - c.x, |c| c.w + c.x, |c| c.w - c.y, |c| c.w + c.y];
        self.cut_by(|c| c.w - screen.nearest);
        sides.into_iter().for_each(|side| self.cut_by(side));
        &self.polygon
    }

    /// Keeps the part of the polygon where `inside` is positive.
    fn cut_by(&mut self, inside: impl Fn(DVec4) -> f64) {
        if self.polygon.iter().all(|(clip, _)| inside(*clip) >= 0.0) {
            return;
        }
        self.cut.clear();
        for (i, &(clip, at)) in self.polygon.iter().enumerate() {
            let (next, next_at) = self.polygon[(i + 1) % self.polygon.len()];
            let (here, there) = (inside(clip), inside(next));
            if here >= 0.0 {
                self.cut.push((clip, at));
            }
            if (here >= 0.0) != (there >= 0.0) {
                let share = here / (here - there);
                self.cut.push((clip.lerp(next, share), at.lerp(next_at, share)));
            }
        }
        std::mem::swap(&mut self.polygon, &mut self.cut);
    }
}

/// Half the least w that clip coordinates have in front of the near plane.
pub(crate) fn nearest_w(camera: &CameraView) -> f64 {
    let near_depth = if camera.background_depth() == 0.0 { 1.0 } else { 0.0 };
    let view_from_clip = camera.clip_from_view.inverse();
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
    let inverse_w = corners.map(|(x, y)| (view_from_clip * DVec4::new(x, y, near_depth, 1.0)).w.abs());
    0.5 / inverse_w.into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_grow_by_a_pixel_to_each_side_whichever_way_they_turn() {
        let square = [DVec2::ZERO, DVec2::X * 9.0, DVec2::splat(9.0), DVec2::Y * 9.0];
        let larger = [DVec2::splat(-1.0), DVec2::new(10.0, -1.0), DVec2::splat(10.0), DVec2::new(-1.0, 10.0)];
        assert_eq!(grown(&square), Some(larger));
        let [a, b, c, d] = square;
        let [e, f, g, h] = larger;
        assert_eq!(grown(&[d, c, b, a]), Some([h, g, f, e]));
        assert_eq!(grown(&[a, b, b, a]), None, "without width");
        assert_eq!(grown(&[a, b, DVec2::new(18.0, 0.1), DVec2::new(9.0, 0.1)]), None, "corners far away");
    }
}

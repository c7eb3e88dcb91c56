//! Rectangles of a view, and crops to them.

use super::Fit;
use glam::{DMat4, DVec2, DVec4};

/// A rectangle of normalised device coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rect {
    pub min: DVec2,
    pub max: DVec2,
}

impl Rect {
    /// `half` to all sides of the middle.
    pub fn around(half: f64) -> Self {
        Self { min: DVec2::splat(-half), max: DVec2::splat(half) }
    }

    /// Larger by `margin` to all sides.
    pub fn grown(self, margin: f64) -> Self {
        Self { min: self.min - margin, max: self.max + margin }
    }

    /// Around all points; `None` where there are none.
    pub fn of(points: impl Iterator<Item = DVec2>) -> Option<Self> {
        let empty = Self { min: DVec2::INFINITY, max: DVec2::NEG_INFINITY };
        let rect = points.fold(empty, |r, p| Self { min: r.min.min(p), max: r.max.max(p) });
        (rect.min.cmple(rect.max).all() && rect.min.is_finite() && rect.max.is_finite()).then_some(rect)
    }
}

/// Moves and scales a view so that it shows a part of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crop {
    pub scale: DVec2,
    pub moved: DVec2,
}

impl Crop {
    /// Stretches `rect` and its border to the whole of clip space.
    pub fn to(rect: Rect, fit: &Fit) -> Self {
        let size = f64::from(fit.size.max(1));
        let border = fit.border_texels.clamp(0.0, size * 0.25);
        let center = (rect.min + rect.max) * 0.5;
        // A receiver seen edge-on still needs a width; half a percent of the other side keeps
        // texels sane.
        let half = (rect.max - rect.min) * 0.5;
        let half = half.max(DVec2::splat((half.max_element() * 0.005).max(1e-9))) * (size / (size - 2.0 * border));
        let scale = half.recip();
        Self { scale, moved: -center * scale }
    }

    /// Stretches `rect` to the whole of clip space.
    pub fn whole(rect: Rect) -> Self {
        let scale = 2.0 / (rect.max - rect.min);
        Self { scale, moved: -(rect.min + rect.max) * 0.5 * scale }
    }

    /// This crop of the whole that `other` is a crop of.
    pub fn after(&self, other: &Self) -> Self {
        let scale = self.scale / other.scale;
        Self { scale, moved: self.moved - other.moved * scale }
    }

    pub fn matrix(&self) -> DMat4 {
        DMat4::from_cols(
            DVec4::new(self.scale.x, 0.0, 0.0, 0.0),
            DVec4::new(0.0, self.scale.y, 0.0, 0.0),
            DVec4::Z,
            DVec4::new(self.moved.x, self.moved.y, 0.0, 1.0),
        )
    }
}

/// How views that stand still move on: in steps, so that every texel stays what it was or leaves
/// the map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps {
    /// Texels that the map moves at a time, at least 1; as many are kept free around what it has to
    /// show.
    pub texels: f64,
}

impl Steps {
    /// A square around what lies within `radius` of `center`, and the border.
    pub fn rect(&self, center: DVec2, radius: f64, fit: &Fit) -> Rect {
        let size = f64::from(fit.size.max(1));
        let free = fit.border_texels.max(0.0) + 0.5 * self.texels.max(1.0);
        let texel = 2.0 * radius.max(1e-9) / (size - 2.0 * free.min(size * 0.375));
        let step = texel * self.texels.max(1.0).floor();
        let center = (center / step).round() * step;
        let half = DVec2::splat(0.5 * size * texel);
        Rect { min: center - half, max: center + half }
    }
}

//! How what was found is drawn: parts, their corners and indices.

use super::caster::Throw;
use std::ops::Range;
use umbrage_core::glam::DVec4;

/// Vertex numbers of one part end before those of the next one start.
pub(super) const VERTICES: u32 = 512;

/// How sides and caps are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Sides are triangles that meet infinitely far away, those counted from the eye and those
    /// counted from infinity.
    pub parallel: [bool; 2],
    /// Some cap is a dark one.
    pub dark_caps: bool,
    /// Sides that count twice are drawn once, with that weight.
    pub weighted: bool,
}

impl Shape {
    pub(super) fn of(light: DVec4, throws: &[Throw], style: Style) -> Self {
        let parallel = |z_fail| {
            let mut own = throws.iter().filter(|t| t.z_fail == z_fail);
            light.w == 0.0 && !style.quads && own.all(|t| t.end == DVec4::ZERO)
        };
        Self {
            parallel: [false, true].map(parallel),
            dark_caps: throws.iter().any(|t| t.z_fail && t.dark_cap),
            weighted: style.weighted,
        }
    }

    /// True where the sides of a part are triangles.
    pub fn is_parallel(self, part: Part) -> bool {
        part != Part::Caps && self.parallel[part as usize]
    }

    /// The indices of a group of the part's entries, see [`indices`].
    pub(super) fn indices(self, part: Part) -> Range<u32> {
        match (part, self.dark_caps) {
            (Part::Caps, true) => 576..960,
            (Part::Caps, false) => 960..1152,
            _ if self.is_parallel(part) => 384..576,
            _ => 0..384,
        }
    }
}

/// For 64 sides of four corners two triangles each; then one triangle each, since both shadows are
/// one point. For 64 caps of six corners both triangles each; then the light caps alone.
pub(super) fn indices() -> Vec<u16> {
    let each =
        |stride: u16, corners: &'static [u16]| (0..64).flat_map(move |i| corners.iter().map(move |c| i * stride + c));
    let sides = each(4, &[0, 1, 2, 0, 2, 3]).chain(each(4, &[0, 1, 2]));
    sides.chain(each(6, &[0, 1, 2, 3, 4, 5])).chain(each(6, &[0, 1, 2])).collect()
}

/// What the user of silhouettes chooses of their [`Shape`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style {
    /// See [`Shape::weighted`].
    pub weighted: bool,
    /// Sides of parallel light are quads in any case.
    pub quads: bool,
}

/// What is drawn in one call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// Sides of casters that are counted from the eye.
    PassSides,
    /// Sides of casters that are counted from infinity.
    FailSides,
    /// Caps of the latter.
    Caps,
}

impl Part {
    pub const ALL: [Self; 3] = [Self::PassSides, Self::FailSides, Self::Caps];

    /// By which the shader knows it.
    pub(super) fn first_vertex(self) -> u32 {
        self as u32 * VERTICES
    }
}

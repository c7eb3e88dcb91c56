//! Boxes around what casts shadows, and around what shadows fall on.

use super::world::Casters;
use umbrage_core::Bounds;

impl Casters {
    /// Boxes around the instances that cast shadows.
    pub fn casting_bounds(&self) -> impl Iterator<Item = Bounds> + '_ {
        self.placed.iter().filter(|p| p.casts).map(|p| p.bounds)
    }

    /// Says where shadows are asked for besides on the instances: boxes around particles, panes and
    /// fog that a shader of the host's own shades, see [`crate::Inline`]. They take the place of
    /// those given before. Maps cover what the camera sees of them, and then have fewer texels for
    /// the rest. Boxes that are empty or not finite count for nothing.
    pub fn receive_in(&mut self, boxes: &[Bounds]) {
        let is_finite = |b: &&Bounds| b.min.is_finite() && b.max.is_finite() && !b.is_empty();
        self.receiving_in.clear();
        self.receiving_in.extend(boxes.iter().filter(is_finite));
    }

    /// The boxes of [`Casters::receive_in`].
    pub(crate) fn receiving_in(&self) -> &[Bounds] {
        &self.receiving_in
    }

    /// Boxes around the instances that shadows fall on.
    pub fn receiving_bounds(&self) -> impl Iterator<Item = Bounds> + '_ {
        self.placed.iter().filter(|p| p.receives).map(|p| p.bounds)
    }

    /// A box around everything that shadows fall on.
    pub(crate) fn receivers_bounds(&self) -> Bounds {
        self.receiving_in.iter().fold(self.receiving.content(), |all, one| all.union(*one))
    }

    /// Whether any instance has an alpha mask, so that outlines are not those of triangles alone.
    pub(crate) fn has_masked(&self) -> bool {
        self.batches.has_masked()
    }

    /// A box around everything that casts shadows, what the host draws included.
    pub(crate) fn casting_content(&self) -> Bounds {
        self.casting.content().union(self.host_bounds().unwrap_or(Bounds::EMPTY))
    }

    /// A box around everything that is shown.
    pub fn all_bounds(&self) -> Bounds {
        self.casting_content().union(self.receivers_bounds()).union(self.bystanders.content())
    }
}

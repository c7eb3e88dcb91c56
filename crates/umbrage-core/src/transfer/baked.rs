//! A baked scene.

use super::points::{Points, Sides};
use super::stored::Stored;
use crate::harmonics::Order;
use crate::mesh::Mesh;

/// The transfer of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// n² functions for each point and channel.
    pub order: Order,
    /// What light does on its way.
    pub kind: Kind,
    /// One for each instance that is drawn; instances whose mesh has no triangles have none.
    pub meshes: Vec<BakedMesh>,
}

/// What light does on its way to a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Nothing is in its way.
    Unshadowed,
    /// Surfaces block it.
    #[default]
    Shadowed,
    /// Surfaces block it and reflect it again, up to so many times; with 0 it is shadowed.
    Interreflected {
        /// Reflections before the one at the point.
        bounces: u32,
    },
}

impl Kind {
    /// Numbers for each function: 1 where light keeps its colour on the way, 3 where surfaces
    /// change it.
    pub fn channels(self) -> usize {
        match self {
            Self::Interreflected { bounces: 1.. } => 3,
            _ => 1,
        }
    }
}

/// The transfer of one placed mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct BakedMesh {
    /// Index into [`crate::Scene::instances`].
    pub instance: usize,
    /// What is drawn: the instance's mesh, in the mesh's own space and posed as it was baked, with
    /// triangles cut so that shadows show. It covers the same surface.
    pub mesh: Mesh,
    /// Where the points are.
    pub points: Points,
    /// Whether the back has points of its own; they follow those of the front. A back that has
    /// none is drawn with the front's.
    pub sides: Sides,
    /// Numbers for each function and point: 1 for all colours, or 3, red first.
    pub channels: usize,
    /// The coefficients. A point's vector has `channels` · n² numbers, channel by channel.
    pub stored: Stored,
}

impl BakedMesh {
    /// Points on one side.
    pub fn points_per_side(&self) -> usize {
        self.points.count(self.mesh.positions.len())
    }

    /// Points on all sides.
    pub fn point_count(&self) -> usize {
        self.sides.count() * self.points_per_side()
    }

    /// Numbers of a point's vector.
    pub fn vector_len(&self, order: Order) -> usize {
        self.channels * order.functions()
    }

    /// True where the arrays have the lengths that go with each other, and all indices are in
    /// range.
    pub fn is_whole(&self, order: Order) -> bool {
        let uvs = match &self.points {
            Points::Vertices => true,
            Points::Texels { uvs, .. } => uvs.len() == self.mesh.positions.len(),
        };
        let vertices = self.mesh.positions.len();
        uvs && [1, 3].contains(&self.channels)
            && self.mesh.indices.iter().all(|&i| (i as usize) < vertices)
            && self.stored.is_whole(self.point_count(), self.vector_len(order))
    }
}

impl Transfer {
    /// Bytes of all coefficients, as they are stored.
    pub fn bytes(&self) -> usize {
        self.meshes.iter().map(|mesh| mesh.stored.bytes()).sum()
    }

    /// True where every mesh is whole.
    pub fn is_whole(&self) -> bool {
        self.meshes.iter().all(|mesh| mesh.is_whole(self.order))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitive;

    #[test]
    fn colours_are_kept_where_nothing_changes_them() {
        assert_eq!([Kind::Unshadowed, Kind::Shadowed, Kind::Interreflected { bounces: 0 }].map(Kind::channels), [1; 3]);
        assert_eq!(Kind::Interreflected { bounces: 2 }.channels(), 3);
    }

    #[test]
    fn arrays_that_do_not_go_together_are_found() {
        let order = Order::default();
        let whole = BakedMesh {
            instance: 0,
            mesh: primitive::plane(),
            points: Points::Vertices,
            sides: Sides::Both,
            channels: 3,
            stored: Stored::Full(vec![0.0; 8 * 75]),
        };
        assert!(whole.is_whole(order) && whole.point_count() == 8);
        let mut open = whole.clone();
        open.mesh.indices.push(9);
        let texels = Points::Texels { width: 2, height: 2, uvs: vec![glam::Vec2::ZERO; 3] };
        let wrong = [
            BakedMesh { sides: Sides::Front, ..whole.clone() },
            BakedMesh { channels: 2, ..whole.clone() },
            BakedMesh { points: texels, ..whole.clone() },
            open,
        ];
        assert!(wrong.iter().all(|mesh| !mesh.is_whole(order)));
        assert!(!whole.is_whole(Order::MAX));
    }
}

//! Where on a mesh the points are that have a transfer.

use glam::Vec2;

/// Where the points of a mesh are.
#[derive(Clone, Debug, PartialEq)]
pub enum Points {
    /// At every vertex of the baked mesh, in its order; interpolated over triangles.
    Vertices,
    /// At the texels of an atlas, row by row from the top, v = 0; interpolated between the four
    /// around. Texels beside those that triangles cover continue them.
    Texels {
        /// Texels across.
        width: u32,
        /// Texels down.
        height: u32,
        /// One for each vertex of the baked mesh, 0…1, no two triangles at the same place.
        uvs: Vec<Vec2>,
    },
}

impl Points {
    /// How many there are on one side of a mesh of so many vertices.
    pub fn count(&self, vertices: usize) -> usize {
        match self {
            Self::Vertices => vertices,
            Self::Texels { width, height, .. } => *width as usize * *height as usize,
        }
    }
}

/// Which sides of a mesh have a transfer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sides {
    /// The one that normals point to.
    #[default]
    Front,
    /// Both: as many points again for the back, after those of the front.
    Both,
}

impl Sides {
    /// 1 or 2.
    pub fn count(self) -> usize {
        match self {
            Self::Front => 1,
            Self::Both => 2,
        }
    }
}

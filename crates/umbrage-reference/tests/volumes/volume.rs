//! A shadow volume put together from its contour and its caps.

use crate::crossing::Sheet;
use umbrage_core::Mesh;
use umbrage_core::adjacency::Adjacency;
use umbrage_core::glam::{DAffine3, DVec4, Vec4};
use umbrage_core::silhouette::{self, ContourEdge, Rule};

/// A corner of the volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Corner {
    /// A vertex of the mesh.
    Vertex(u32),
    /// Where the light through a vertex ends.
    Shadow(u32),
    /// Where all parallel light ends.
    Infinity,
}

/// The surface of a shadow volume.
pub struct Volume {
    /// What the sides are made from.
    pub contour: Vec<ContourEdge>,
    /// Counter-clockwise seen from outside, and how many lie upon one another.
    pub triangles: Vec<([Corner; 3], i32)>,
}

impl Volume {
    /// The volume of a mesh under a light relative to its [`Adjacency::center`].
    pub fn of(adjacency: &Adjacency, light: Vec4, rule: Rule) -> Self {
        let mut contour = Vec::new();
        silhouette::contour(adjacency, light, rule, &mut contour);
        let shadow = |v: u32| if light.w == 0.0 { Corner::Infinity } else { Corner::Shadow(v) };
        let mut triangles = Vec::new();
        for cap in silhouette::light_cap(adjacency, light, rule) {
            let [a, b, c] = cap;
            triangles.push((cap.map(Corner::Vertex), 1));
            triangles.push(([c, b, a].map(shadow), 1));
        }
        for e in &contour {
            let (a, b) = (Corner::Vertex(e.from), Corner::Vertex(e.to));
            triangles.push(([b, a, shadow(e.from)], e.times as i32));
            triangles.push(([b, shadow(e.from), shadow(e.to)], e.times as i32));
        }
        Self { contour, triangles }
    }

    /// The surface in world space; `light` is homogeneous there.
    pub fn sheets(&self, mesh: &Mesh, world_from_mesh: &DAffine3, light: DVec4) -> Vec<Sheet> {
        let place = |corner| match corner {
            Corner::Vertex(v) => vertex(mesh, world_from_mesh, v),
            Corner::Shadow(v) => (vertex(mesh, world_from_mesh, v) - light).normalize(),
            Corner::Infinity => -light,
        };
        // A mirror turns everything inside out.
        let turn = if world_from_mesh.matrix3.determinant() < 0.0 { -1 } else { 1 };
        self.triangles.iter().map(|(t, times)| Sheet { corners: t.map(place), times: turn * times }).collect()
    }
}

/// A vertex in world space.
pub fn vertex(mesh: &Mesh, world_from_mesh: &DAffine3, v: u32) -> DVec4 {
    world_from_mesh.transform_point3(mesh.positions[v as usize].as_dvec3()).extend(1.0)
}

//! Where a count that starts at the eye has to begin, for one caster.

use super::edges::MeshEdges;
use super::eye_tree::{Sight, largest_stretch};
use super::placed::Placed;
use crate::view::View;
use umbrage_core::glam::DVec4;

/// How many of a caster's triangles lie between the eye and a light's centre, as
/// [`super::eye_tree::EyeTree::count`] tells; nor can it be told of meshes that the GPU alone
/// knows. `rounding` is that of the view, metres.
pub(crate) fn before_eye(
    view: &View<'_>,
    placed: &Placed,
    mesh: &MeshEdges,
    light: DVec4,
    rounding: f64,
) -> Option<[u32; 2]> {
    let to_mesh = &placed.sides.as_ref().filter(|_| !placed.posed)?.mesh_from_world;
    let center = light.truncate();
    let sight = Sight {
        eye: to_mesh.transform_point3(view.camera.eye),
        light: match light.w == 0.0 {
            true => to_mesh.transform_vector3(center).extend(0.0),
            false => to_mesh.transform_point3(center).extend(1.0),
        },
        tolerance: rounding * largest_stretch(&to_mesh.matrix3),
    };
    let part = &view.casters.meshes()[placed.mesh as usize].mesh;
    mesh.eye_tree(part).count(part, &mesh.adjacency, &sight)
}

//! Which casters may shadow what is in view.

use super::form::Form;
use crate::casters::{self, Casters, MeshEdges, Placed};
use crate::{error::Error, gpu::Gpu, view::View};
use umbrage_core::Bounds;
use umbrage_core::glam::DVec4;
use umbrage_core::shadow_hull::{Convex, soft_shadow_hull};

/// Leaves in `found` the numbers, in [`Casters::placed`], of the casters whose soft shadows may be
/// seen, in order; those with an alpha mask only where it is not `leaves_masked`.
pub(crate) fn casters_in_view(view: &View<'_>, form: &Form, leaves_masked: bool, found: &mut Vec<u32>) {
    found.clear();
    let casters = view.casters;
    if !view.light.casts || casters.casting().is_empty() {
        return;
    }
    let hull = form.hull();
    let receivers = casters.receivers_bounds();
    if let Some(body) = soft_shadow_hull(&view.camera, &receivers, &hull) {
        casters.casting().query(&body, found);
    }
    casters.sort(found);
    let lights: Vec<_> = hull.iter().map(|center| casters::Light { center: *center, receivers }).collect();
    found.retain(|place| {
        let placed = &casters.placed()[*place as usize];
        let is_empty = placed.bounds.is_empty() || placed.sides.is_none();
        let is_left = leaves_masked && placed.masked;
        !is_empty && !is_left && !lights.iter().all(|light| placed.shadows_nothing(light))
    });
}

/// Whether a light may be at a vertex, an edge or a triangle of what casts.
///
/// # Errors
/// [`Error::Size`] where there are too many edges.
pub(crate) fn is_on_a_caster(gpu: &Gpu, view: &View<'_>, light: DVec4) -> Result<bool, Error> {
    let casters = view.casters;
    if light.w == 0.0 || casters.casting().is_empty() {
        return Ok(false);
    }
    let edges = casters.edges(gpu)?;
    let around = Bounds::of([light.truncate()]).grown(100.0 * view.rounding());
    let mut found = Vec::new();
    casters.casting().query(&Convex::hull(&around.corners().map(|p| p.extend(1.0))), &mut found);
    Ok(found.iter().map(|place| &casters.placed()[*place as usize]).any(|placed| {
        placed.bounds.overlaps(&around) && may_touch(casters, placed, edges.of_mesh(placed.mesh), &around)
    }))
}

/// Whether a triangle of a caster may touch a box.
pub(crate) fn may_touch(casters: &Casters, placed: &Placed, mesh: &MeshEdges, bounds: &Bounds) -> bool {
    let (Some(sides), false) = (&placed.sides, placed.posed) else { return true };
    let part = &casters.meshes()[placed.mesh as usize].mesh;
    mesh.eye_tree(part).may_touch(part, &mesh.adjacency, &bounds.transformed(&sides.mesh_from_world))
}

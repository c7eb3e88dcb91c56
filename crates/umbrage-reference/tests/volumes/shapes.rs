//! Meshes, places and lights to try.

use proptest::prelude::*;
use umbrage_core::glam::{DAffine3, DMat3, DQuat, DVec3, DVec4, EulerRot, Vec3};
use umbrage_core::{Mesh, primitive};

/// A mesh, where it stands, and a light: a point with w = 1 or a direction to the light with w = 0,
/// in world space.
pub type Setting = (Mesh, DAffine3, DVec4);

/// `mesh` somewhere in some light.
pub fn setting(mesh: impl Strategy<Value = Mesh>) -> impl Strategy<Value = Setting> {
    let direction = within(1.0).prop_filter_map("a direction", DVec3::try_normalize);
    (mesh, placed(), direction, 0.0..6.0f64, any::<bool>()).prop_map(|(mesh, place, way, distance, is_point)| {
        let light = if is_point { (place.translation + way * distance).extend(1.0) } else { way.extend(0.0) };
        (mesh, place, light)
    })
}

/// A point of the cube from −size to size.
pub fn within(size: f64) -> impl Strategy<Value = DVec3> {
    [-size..size, -size..size, -size..size].prop_map(DVec3::from)
}

/// Turned, stretched, moved, mirrored or not.
fn placed() -> impl Strategy<Value = DAffine3> {
    let size = (0.3..1.5f64, any::<bool>()).prop_map(|(size, mirrors)| if mirrors { -size } else { size });
    (within(3.1), [size.clone(), size.clone(), size], within(2.0)).prop_map(|(turn, size, place)| {
        let rotation = DQuat::from_euler(EulerRot::XYZ, turn.x, turn.y, turn.z);
        DAffine3::from_mat3_translation(DMat3::from_quat(rotation) * DMat3::from_diagonal(size.into()), place)
    })
}

/// Triangles between a few vertices, any way round, some at the same place. Vertices on a coarse
/// grid make many of them parallel, in one plane or without area.
pub fn soup() -> impl Strategy<Value = Mesh> {
    let on_grid = [-3..=3i32, -3..=3, -3..=3].prop_map(|p| Vec3::from(p.map(|x| x as f32 / 3.0)));
    let anywhere = within(1.0).prop_map(|p| p.as_vec3());
    let vertices = prop::collection::vec(prop_oneof![on_grid, anywhere], 3..14);
    let corners = [any::<prop::sample::Index>(), any::<prop::sample::Index>(), any::<prop::sample::Index>()];
    let copies = prop::collection::vec((any::<prop::sample::Index>(), any::<bool>()), 0..6);
    (vertices, prop::collection::vec(corners, 1..25), copies).prop_map(|(positions, corners, copies)| {
        let place = |i: prop::sample::Index| i.index(positions.len()) as u32;
        let mut triangles: Vec<[u32; 3]> = corners.into_iter().map(|t| t.map(place)).collect();
        for (which, turns) in copies {
            let [a, b, c] = triangles[which.index(triangles.len())];
            triangles.push(if turns { [a, c, b] } else { [b, c, a] });
        }
        Mesh { positions, indices: triangles.into_flattened(), ..Mesh::default() }
    })
}

/// Up to three bodies, apart or through one another, some of them twice, all of them perhaps inside
/// out.
pub fn closed() -> impl Strategy<Value = Mesh> {
    (prop::collection::vec((0..5usize, placed(), any::<bool>()), 1..4), any::<bool>()).prop_map(|(bodies, turns)| {
        let mut mesh = Mesh::default();
        for (kind, place, twice) in bodies {
            let body = primitives()[kind].transformed(&place);
            (0..1 + usize::from(twice)).for_each(|_| mesh.append(&body));
        }
        if turns {
            mesh.indices.as_chunks_mut::<3>().0.iter_mut().for_each(|t| t.swap(0, 1));
        }
        mesh
    })
}

fn primitives() -> [Mesh; 5] {
    [
        primitive::cube(),
        primitive::sphere(9, 6),
        primitive::cylinder(7, 2),
        primitive::cone(8, 2),
        primitive::torus(0.8, 0.3, 9, 7),
    ]
}

/// What real meshes have: a body with triangles missing, turned, doubled and vertices moved apart.
pub fn damaged() -> impl Strategy<Value = Mesh> {
    let harm = (any::<prop::sample::Index>(), 0..4);
    (0..5usize, prop::collection::vec(harm, 0..8)).prop_map(|(kind, harms)| {
        let mut mesh = primitives()[kind].clone();
        for (which, harm) in harms {
            let at = which.index(mesh.triangle_count()) * 3;
            match harm {
                0 => drop(mesh.indices.drain(at..at + 3)),
                1 => mesh.indices.swap(at, at + 1),
                2 => mesh.indices.extend_from_within(at..at + 3),
                _ => mesh.positions[mesh.indices[at] as usize] *= 1.001,
            }
        }
        mesh
    })
}

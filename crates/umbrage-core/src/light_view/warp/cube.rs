//! The sides of the post-perspective cube as maps (Kozlov 2004; SG "Cube Maps").

use super::super::Fit;
use super::flat::FlatMap;
use super::horizon::{Subject, VirtualCamera};
use super::rays::cut;
use glam::{DVec3, DVec4};

/// A map for every side of the cube by which rays to something seen leave it, and the number of the
/// side.
pub(super) fn sides(subject: &Subject<'_>, camera: &VirtualCamera, fit: &Fit) -> Vec<(u32, FlatMap)> {
    let rows = camera.clip_from_world;
    let light = rows.map(|row| row.dot(subject.rays.light));
    let mut maps = Vec::new();
    for (number, (axis, end)) in [0, 1, 2].into_iter().flat_map(|axis| [(axis, 1.0), (axis, -1.0)]).enumerate() {
        // How fast rays go out by this side; it has a row of its own, linear in homogeneous points.
        let leaving = light[3] - end * light[axis];
        if leaving <= 0.0 {
            continue;
        }
        let outward = (rows[axis] * light[3] - rows[3] * light[axis]) * end;
        let inside = [0, 1, 2].into_iter().filter(|other| *other != axis);
        let edges = inside.flat_map(|other| [1.0, -1.0].map(|at| edge([axis, other], [end, at], &rows, &light)));
        let polygon = edges.fold(subject.hull.clone(), |left, plane| cut(&left, subject.rays.coordinates(plane)));
        let horizon: DVec3 = subject.rays.coordinates(outward);
        maps.extend(FlatMap::new(horizon, &polygon, fit).map(|map| (number as u32, map)));
    }
    maps
}

/// The plane through the light and the edge between two sides of the cube, positive towards the
/// first one's middle.
fn edge([a, b]: [usize; 2], [at_a, at_b]: [f64; 2], rows: &[DVec4; 4], light: &[f64; 4]) -> DVec4 {
    let from_a = (rows[a] - rows[3] * at_a) * (light[b] - at_b * light[3]);
    let from_b = (rows[b] - rows[3] * at_b) * (light[a] - at_a * light[3]);
    (from_b - from_a) * (at_a * at_b)
}

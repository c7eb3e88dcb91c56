//! What is drawn one by one: convex loops (PX 4.4), or casters.

use super::super::draws::{self, Draw};
use super::super::select::Selection;
use super::draws::{LOOP_BODIES, LOOP_SIDES};
use crate::casters::{Casters, Edges};
use crate::silhouettes::{Silhouettes, Throw};
use std::collections::HashMap;
use std::ops::Range;
use umbrage_core::glam::{Vec3, Vec4};
use umbrage_core::silhouette::light_in_mesh;

/// Wedges of one caster.
pub(super) struct Group {
    pub wedges: Range<u32>,
    /// Chunks of its surface that are drawn, see `caps.wgsl`.
    pub caps: Range<u32>,
    /// Sides and bodies.
    pub draws: [&'static Draw; 2],
    /// Of the shadows that the eye is in those that count with it; 0 for what is drawn right into
    /// the sum.
    pub slot: u32,
}

/// A group for each caster, in order: those whose silhouette is one convex loop are drawn apart, or
/// `all` are.
pub(super) fn find_groups(
    casters: &Casters,
    silhouettes: &Silhouettes,
    selection: &Selection,
    all: bool,
    groups: &mut Vec<Group>,
) {
    groups.clear();
    let Some(edges) = casters.made_edges() else { return };
    for ((caster, throw), wedges) in (0_u32..).zip(&selection.throws).zip(silhouettes.sides()) {
        let (caps, wedges) = (selection.caps_of(caster), wedges.clone());
        let is_loop = || caps.is_empty() && is_convex_loop(casters, edges, silhouettes, throw, caster, wedges.clone());
        let (draws, is_apart): ([&'static Draw; 2], _) = match all {
            false if is_loop() => ([&LOOP_SIDES, &LOOP_BODIES], true),
            _ => ([&draws::SIDES, &draws::BODIES], all),
        };
        let slot = if is_apart { groups.len() as u32 + 1 } else { 0 };
        groups.push(Group { wedges, caps, draws, slot });
    }
}

/// Whether a caster's silhouette is one loop that is convex as the light sees it.
fn is_convex_loop(
    casters: &Casters,
    edges: &Edges,
    silhouettes: &Silhouettes,
    throw: &Throw,
    caster: u32,
    wedges: Range<u32>,
) -> bool {
    let placed = &casters.placed()[throw.place as usize];
    let (Some(sides), false) = (placed.sides, throw.is_body) else { return false };
    let mesh = &edges.of_mesh(placed.mesh).adjacency;
    let posed = casters.posed_mesh(placed.mesh as usize);
    let positions = posed.as_ref().map_or(&casters.meshes()[placed.mesh as usize].mesh.positions, |m| &m.positions);
    let listed: Vec<(u32, bool)> = wedges.map(|number| silhouettes.side(caster as usize, number)).collect();
    if listed.iter().any(|(_, twice)| *twice) {
        return false;
    }
    let ends: Vec<[u32; 2]> = listed.iter().map(|(edge, _)| mesh.edges[*edge as usize].vertices).collect();
    let light = light_in_mesh(throw.light, &sides.mesh_from_world, Default::default());
    let lines: Vec<[Vec3; 2]> = ends.iter().map(|ends| ends.map(|v| positions[v as usize])).collect();
    is_one_loop(&ends) && is_convex(&lines, light)
}

/// Whether edges join up, in whatever order and direction, to one loop that meets itself nowhere.
fn is_one_loop(edges: &[[u32; 2]]) -> bool {
    let mut next: HashMap<u32, Vec<u32>> = HashMap::new();
    for [a, b] in edges {
        next.entry(*a).or_default().push(*b);
        next.entry(*b).or_default().push(*a);
    }
    let Some([first, second]) = edges.first().filter(|_| next.values().all(|ways| ways.len() == 2)) else {
        return false;
    };
    let (mut from, mut at, mut count) = (*first, *second, 1);
    while at != *first && count <= edges.len() {
        let ways = &next[&at];
        let to = if ways[0] == from { ways[1] } else { ways[0] };
        (from, at, count) = (at, to, count + 1);
    }
    count == edges.len()
}

/// Whether all of a loop lies on one side of every edge, seen from the light.
fn is_convex(edges: &[[Vec3; 2]], light: Vec4) -> bool {
    edges.iter().all(|[a, b]| {
        let to_light = light.truncate() - *a * light.w;
        let side = (*b - *a).cross(to_light);
        let least = 1e-5 * side.length();
        let (mut above, mut below) = (false, false);
        for [other, _] in edges {
            let way = *other - *a;
            let height = side.dot(way);
            above |= height > least * way.length();
            below |= height < -least * way.length();
        }
        !(above && below)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(corners: &[Vec3]) -> Vec<[Vec3; 2]> {
        (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]]).collect()
    }

    #[test]
    fn one_loop_is_told_from_two() {
        assert!(is_one_loop(&[[0, 1], [2, 1], [2, 3], [0, 3]]));
        assert!(!is_one_loop(&[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3]]));
        assert!(!is_one_loop(&[[0, 1], [1, 2]]), "open");
        assert!(!is_one_loop(&[[0, 1], [1, 2], [2, 0], [0, 3], [3, 4], [4, 0]]), "an eight");
        assert!(!is_one_loop(&[]));
    }

    #[test]
    fn convex_is_what_the_light_sees() {
        let square = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.0, 1.0), Vec3::Z];
        let dent = [Vec3::ZERO, Vec3::X, Vec3::new(0.3, 0.0, 0.3), Vec3::Z];
        for light in [Vec4::new(0.2, 3.0, 0.4, 1.0), Vec4::Y] {
            assert!(is_convex(&lines(&square), light));
            assert!(!is_convex(&lines(&dent), light));
        }
        let star: Vec<Vec3> = (0..5)
            .map(|i| (i as f32 * 4.0 * std::f32::consts::PI / 5.0).sin_cos())
            .map(|(x, z)| Vec3::new(x, 0.0, z))
            .collect();
        assert!(!is_convex(&lines(&star), Vec4::Y), "it turns one way, but twice around");
    }
}

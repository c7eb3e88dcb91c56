//! All ways to extrude, to count and to draw give the same picture.

use super::meshes::soups;
use super::random::Random;
use super::views::{small_scene, view};
use super::{Bench, COUNTS, assert_none, floor, put};
use crate::common::gpu;
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Image, LightShape, Scene, scenes};

/// Each value of each parameter that changes no picture, most pairs of them.
const WAYS: &[&str] = &[
    "",
    "extrude=vertex",
    "extrude=cpu",
    "counter=stencil",
    "counter=float",
    "stencil=two-pass",
    "parallel=quads",
    "reach=infinite",
    "extrude=vertex,counter=float,reach=infinite",
    "extrude=vertex,stencil=two-pass,parallel=quads",
    "extrude=cpu,counter=float,parallel=quads",
    "extrude=cpu,stencil=two-pass,reach=infinite",
    "counter=float,parallel=quads,reach=infinite",
];

/// Pixels that differ, with what they hold.
pub fn differences<T: PartialEq + Copy + std::fmt::Debug>(a: &Image<T>, b: &Image<T>) -> Vec<((u32, u32), T, T)> {
    assert_eq!(a.size(), b.size());
    let pixels = (0..a.height).flat_map(|y| (0..a.width).map(move |x| (x, y)));
    pixels.filter(|p| a[*p] != b[*p]).map(|p| (p, a[p], b[p])).collect()
}

/// Soups of triangles side by side, every second one mirrored.
fn soup() -> Scene {
    let mut scene = floor(LightShape::Point { position: DVec3::new(0.3, 6.0, 0.2) });
    for (i, (_, mesh)) in soups().into_iter().enumerate() {
        let place = DVec3::new(2.5 * (i % 4) as f64 - 3.7, 1.2, 2.5 * (i / 4) as f64 - 3.7);
        let side = if i % 2 == 1 { -1.0 } else { 1.0 };
        put(&mut scene, mesh, DAffine3::from_translation(place) * DAffine3::from_scale(DVec3::new(side, 1.0, 1.0)));
    }
    scene
}

#[test]
fn all_ways_give_one_picture() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let sets: Vec<String> = COUNTS.iter().flat_map(|c| WAYS.iter().map(move |w| format!("{c},{w}"))).collect();
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    let registry = ["primitives", "lantern", "overlap"].map(|id| (id, small_scene(scenes::find(id).unwrap().build)));
    for (id, scene) in registry.into_iter().chain([("soup", soup())]) {
        let mut bench = Bench::new(&gpu, scene, (160, 120), &sets);
        let mut random = Random(11);
        for kind in 0..5 {
            let (camera, light, _) = view(&mut random, &bench, kind);
            let drawn = bench.visibility_of_surfaces(&camera, &light);
            for (set, seen) in &drawn[1..] {
                let off = differences(seen, &drawn[0].1);
                if !off.is_empty() {
                    let some = &off[..off.len().min(4)];
                    wrong.push(format!("{id} view {kind}, {set}: {} pixels differ, {some:?}", off.len()));
                }
            }
        }
    }
    assert_none(&wrong);
}

//! What is left out changes nothing.

use super::agree::differences;
use super::random::Random;
use super::views::{small_scene, view};
use super::{Bench, COUNTS, assert_none};
use crate::common::gpu;
use umbrage::core::{Camera, Image, Light, scenes};

const CULLS: [&str; 6] = ["none", "all", "light", "view", "caps", "scissor"];

/// Complaints where pictures are not the first.
fn unequal<T: PartialEq + Copy + std::fmt::Debug>(what: &str, drawn: &[(String, Image<T>)]) -> Vec<String> {
    let compared = drawn[1..].iter().map(|(set, picture)| (set, differences(picture, &drawn[0].1)));
    let off = compared.filter(|(_, off)| !off.is_empty());
    off.map(|(set, off)| format!("{what}, {set}: {} pixels, {:?}", off.len(), &off[..off.len().min(3)])).collect()
}

#[test]
fn culling_changes_no_visibility() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let sets: Vec<String> = COUNTS.iter().flat_map(|c| CULLS.map(|cull| format!("{c},cull={cull}"))).collect();
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    for (number, id) in (0..).zip(["primitives", "lantern", "picket-fence", "terrain"]) {
        let mut bench = Bench::new(&gpu, small_scene(scenes::find(id).unwrap().build), (160, 120), &sets);
        let mut random = Random(101 + number);
        for kind in 0..7 {
            let (camera, light, _) = view(&mut random, &bench, kind);
            let drawn = bench.visibility_of_surfaces(&camera, &light);
            for same_count in drawn.chunks(CULLS.len()) {
                wrong.extend(unequal(&format!("{id} view {kind}"), same_count));
            }
        }
    }
    assert_none(&wrong);
}

/// A light that ends within the scene, and sometimes a view of all its end.
fn ending(random: &mut Random, bench: &Bench, kind: usize) -> (Camera, Light) {
    let kind = [0, 2, 3, 3][kind % 4] + 5 * kind;
    let (camera, light, _) = view(random, bench, kind);
    let range = bench.scene.bounds().radius() * random.range(0.1, 0.8);
    (camera, Light { range: Some(range), ..light })
}

#[test]
fn ending_shadows_where_the_light_ends_changes_no_colour() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let mut sets = vec!["reach=infinite,cull=none".to_string()];
    for (i, cull) in CULLS.into_iter().enumerate() {
        for bounds in ["off", "on"] {
            let count = COUNTS[i % 3];
            sets.push(format!("reach=finite,cull={cull},depth-bounds={bounds},{count}"));
        }
    }
    sets.extend(COUNTS.map(|count| format!("reach=finite,cull=all,{count}")));
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    for (number, id) in (0..).zip(["primitives", "lantern", "overlap", "contact"]) {
        let mut bench = Bench::new(&gpu, small_scene(scenes::find(id).unwrap().build), (160, 120), &sets);
        let mut random = Random(201 + number);
        for kind in 0..8 {
            let (camera, light) = ending(&mut random, &bench, kind);
            let drawn = bench.draw(&camera, &light, |renderer| renderer.color().unwrap());
            wrong.extend(unequal(&format!("{id} view {kind}"), &drawn));
        }
    }
    assert_none(&wrong);
}

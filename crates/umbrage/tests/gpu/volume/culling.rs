//! What is left out changes nothing.

use super::agree::differences;
use super::random::Random;
use super::views::{small_scene, view};
use super::{Bench, COUNTS, assert_none};
use crate::common::gpu;
use std::collections::BTreeMap;
use umbrage::core::{Camera, Image, Light, scenes};

const CULLS: [&str; 6] = ["none", "all", "light", "view", "caps", "scissor"];

/// Complaints where pictures are not the first.
fn unequal<T: PartialEq + Copy + std::fmt::Debug>(what: &str, drawn: &[(String, Image<T>)]) -> Vec<String> {
    let compared = drawn[1..].iter().map(|(set, picture)| (set, differences(picture, &drawn[0].1)));
    let off = compared.filter(|(_, off)| !off.is_empty());
    off.map(|(set, off)| format!("{what}, {set}: {} pixels, {:?}", off.len(), &off[..off.len().min(3)])).collect()
}

/// Adds to `sums` what the renderer of settings number `i` left out.
fn add_culled(sums: &mut BTreeMap<&'static str, u64>, bench: &mut Bench, i: usize) {
    let counts = bench.renderer(i).technique(0).unwrap().inside().counts();
    counts.into_iter().for_each(|(name, count)| *sums.entry(name).or_default() += count);
}

#[test]
fn culling_changes_no_visibility() {
    let gpu = gpu();
    let (mut wrong, mut culled) = (Vec::new(), BTreeMap::new());
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
            add_culled(&mut culled, &mut bench, 1);
        }
    }
    for what in ["out of view", "shadow nothing", "light caps culled", "dark caps culled"] {
        assert!(culled[what] > 0, "there was nothing to cull: {culled:?}");
    }
    assert_none(&wrong);
}

/// A strong light that ends within the scene.
fn ending(random: &mut Random, bench: &Bench, kind: usize) -> (Camera, Light) {
    let (camera, light, _) = view(random, bench, [0, 2, 3, 3][kind % 4] + 5 * kind);
    let range = light.shape.center().truncate().distance(camera.target) * random.range(0.4, 1.5);
    (camera, Light { range: Some(range), ..Light::new(light.shape) })
}

#[test]
fn ending_shadows_where_the_light_ends_changes_no_colour() {
    let gpu = gpu();
    let (mut wrong, mut culled, mut bright) = (Vec::new(), BTreeMap::new(), 0);
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
            bright += drawn[0].1.data.iter().filter(|p| p[0] > 100).count();
            wrong.extend(unequal(&format!("{id} view {kind}"), &drawn));
            add_culled(&mut culled, &mut bench, 3);
        }
    }
    println!("{bright} bright pixels; {culled:?}");
    assert!(bright > 10_000 && culled["out of light"] > 50, "there was little to see or to cull");
    assert_none(&wrong);
}

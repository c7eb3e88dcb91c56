//! Random views of all procedural scenes.

use super::random::Random;
use super::{Bench, EXACT, Target, assert_none};
use crate::common::gpu;
use umbrage::core::scenes::SCENES;
use umbrage::core::{Camera, Light, Scene};

/// Of each scene.
const VIEWS: usize = 23;

/// A scene of the registry with few triangles. Masked ones cast whole, so they are made whole.
pub fn small_scene(build: fn(f32) -> Scene) -> Scene {
    let mut scene = build(0.1);
    scene.materials.iter_mut().for_each(|m| m.alpha_cutoff = None);
    scene
}

/// A view that shows something, of kind `kind` where that works out: few of those into a corner or
/// from below the ground do.
pub fn view(random: &mut Random, bench: &Bench, kind: usize) -> (Camera, Light, Target) {
    for attempt in 0..100 {
        let kind = kind + attempt / 10;
        let light = random.light(&bench.scene, kind);
        let camera = random.camera(&bench.scene, &light, kind / 5 + kind);
        let target = bench.target(&camera, &light);
        if target.pixels().0 > 1000 {
            return (camera, light, target);
        }
    }
    panic!("{}: no view of kind {kind} shows anything", bench.scene.name);
}

#[test]
fn random_views_are_true() {
    let gpu = gpu();
    let (mut wrong, mut views, mut in_shadow, mut mixed) = (Vec::new(), 0, 0, 0);
    for (number, entry) in (0..).zip(SCENES) {
        let mut random = Random(number * 7919 + 1);
        let mut bench = Bench::new(&gpu, small_scene(entry.build), (160, 120), &EXACT);
        for kind in 0..VIEWS {
            let (camera, light, target) = view(&mut random, &bench, kind);
            let (scored, dark) = target.pixels();
            views += 1;
            in_shadow += usize::from(target.is_eye_in_shadow);
            mixed += usize::from(dark > 50 && dark + 50 < scored);
            wrong.extend(bench.compare(&format!("{} view {kind}", entry.id), &camera, &light, &target));
        }
    }
    println!("{views} views, {in_shadow} from within a shadow, {mixed} with light and shadow");
    assert!(views >= 200 && in_shadow >= 60 && mixed >= 60, "the views are not what they are for");
    assert_none(&wrong);
}

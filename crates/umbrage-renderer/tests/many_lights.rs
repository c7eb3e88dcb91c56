//! The example of many lights, and the pool that their maps share.

#[path = "../examples/many_lights/city.rs"]
mod city;

use city::{BUDGET, city, measure};
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, Light, Scene};
use umbrage::{Gpu, Settings};
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (64, 48);

fn gpu() -> Gpu {
    Gpu::request(None).unwrap()
}

fn pooled(gpu: &Gpu, scene: &Scene, technique: &str, bytes: u64) -> Renderer {
    let settings: Settings = umbrage::parse(technique).unwrap();
    let pass = |light| LightPass { light, technique: settings.make(gpu).unwrap() };
    let lights: Vec<_> = (0..scene.lights.len()).map(pass).collect();
    let count = lights.len();
    let mut renderer = Renderer::new(gpu, scene, SIZE.0, SIZE.1, lights).unwrap();
    renderer.pool_maps(bytes, vec![settings; count]).unwrap();
    renderer.set_one_target(true).unwrap();
    renderer
}

fn bytes(renderer: &Renderer, lights: usize) -> u64 {
    (0..lights).map(|light| renderer.stats(light).bytes).sum()
}

fn sizes(renderer: &Renderer, lights: usize) -> Vec<u32> {
    (0..lights).map(|light| renderer.pool().unwrap().size(light).unwrap_or(0)).collect()
}

#[test]
fn the_example_draws_the_city() {
    assert!(city(0.05, 3).is_some_and(|scene| scene.lights.len() == 3));
    let measured = measure(&gpu(), &city(0.3, 64).unwrap(), SIZE, 1).unwrap();
    assert!(measured.bytes <= BUDGET && measured.sizes.len() < 64, "{} in {:?}", measured.bytes, measured.sizes);
    let bright = measured.picture.data.iter().filter(|pixel| pixel[0] > 60).count();
    assert!(bright > 200, "lamps light {bright} pixels");
    assert!([measured.first_ms, measured.still_ms, measured.drawn_ms, measured.whole_ms].iter().all(|ms| *ms > 0.0));
}

#[test]
fn maps_of_many_lights_stay_within_the_budget() {
    let (gpu, scene) = (gpu(), city(0.3, 64).unwrap());
    for technique in ["pcf:size=1024", "evsm:size=1024", "smoothies:size=512"] {
        let mut all = Vec::new();
        for budget in [12 << 20, 48 << 20] {
            let mut renderer = pooled(&gpu, &scene, technique, budget);
            for _ in 0..2 {
                renderer.frame(&scene.camera).unwrap();
                let held = bytes(&renderer, 64);
                assert!(held <= budget && held > budget / 16, "{technique}: {held} bytes of {budget}");
            }
            let sizes = sizes(&renderer, 64);
            assert!(sizes.iter().all(|size| *size == 0 || size.is_power_of_two()), "{technique}: {sizes:?}");
            assert!(sizes[0] > *sizes.iter().rev().find(|size| **size > 0).unwrap(), "{technique}: {sizes:?}");
            all.push(sizes.iter().map(|size| u64::from(*size)).sum::<u64>());
        }
        assert!(all[0] < all[1], "{technique}: more bytes are larger maps, {all:?}");
    }
}

/// Of lights under which something has moved, maps are there twice. Others make room for that, by
/// one step of their sizes at most.
#[test]
fn what_moves_makes_maps_no_smaller_than_it_has_to() {
    let (gpu, scene) = (gpu(), city(0.3, 16).unwrap());
    let mut renderer = pooled(&gpu, &scene, "pcf:size=512", 16 << 20);
    let mut frame = |moved: f64| {
        let instance = renderer.casters().instance(20).unwrap();
        let place = DAffine3::from_translation(DVec3::Y * moved) * scene.instances[20].world_from_mesh;
        renderer.casters_mut().move_instance(instance, &place).unwrap();
        renderer.frame(&scene.camera).unwrap();
        (sizes(&renderer, 16), bytes(&renderer, 16))
    };
    (0..2).for_each(|_| drop(frame(0.0)));
    let (still, _) = frame(0.0);
    (1..6).for_each(|step| drop(frame(0.1 * f64::from(step))));
    let (moved, held) = frame(0.6);
    assert!(still.iter().zip(&moved).all(|(still, moved)| 2 * moved >= *still), "{still:?}, {moved:?}");
    assert!(still != moved && held <= 16 << 20, "{held} bytes, {moved:?}");
}

#[test]
fn a_budget_that_is_too_small_is_an_error_with_the_remedy() {
    let (gpu, scene) = (gpu(), city(0.3, 64).unwrap());
    let text = pooled(&gpu, &scene, "pcf", 1000).frame(&scene.camera).unwrap_err().to_string();
    assert!(text.contains("1000 bytes; give it more"), "{text}");
}

#[test]
fn sizes_change_with_the_need_and_not_with_every_step() {
    let (gpu, scene) = (gpu(), city(0.3, 16).unwrap());
    let mut renderer = pooled(&gpu, &scene, "pcf:size=512", 64 << 20);
    let mut at = |step: f64| {
        let way = DVec3::NEG_Z * step;
        let camera = Camera { eye: scene.camera.eye + way, target: scene.camera.target + way, ..scene.camera.clone() };
        renderer.frame(&camera).unwrap();
        sizes(&renderer, 16)
    };
    let first = at(0.0);
    for step in [0.1, -0.1, 0.2, 0.0] {
        assert_eq!(at(step), first, "{step}");
    }
    assert_ne!(at(40.0), first, "other lamps are near");
}

/// A light that lights nothing seen gives its maps back after a while, and gets them again.
#[test]
fn lights_out_of_view_hold_no_maps() {
    let (gpu, scene) = (gpu(), city(0.3, 2).unwrap());
    let mut renderer = pooled(&gpu, &scene, "pcf:size=256", 64 << 20);
    let Light { shape: before, .. } = scene.lights[1].clone();
    renderer.frame(&scene.camera).unwrap();
    let (seen, held) = (sizes(&renderer, 2), bytes(&renderer, 2));
    renderer.light_mut(1).unwrap().shape =
        umbrage::core::LightShape::Point { position: scene.camera.eye + DVec3::new(0.0, 0.0, 100.0) };
    for _ in 0..70 {
        renderer.frame(&scene.camera).unwrap();
    }
    assert_eq!(sizes(&renderer, 2), [seen[0], 0]);
    assert!(bytes(&renderer, 2) < held * 3 / 4, "{} of {held}", bytes(&renderer, 2));
    renderer.light_mut(1).unwrap().shape = before;
    renderer.frame(&scene.camera).unwrap();
    assert_eq!((sizes(&renderer, 2), bytes(&renderer, 2)), (seen, held));
}

//! Models as people make them: open, with parts that run into each other.

use super::random::Random;
use super::{Bench, EXACT, assert_none, put};
use crate::common::{gpu, shared};
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Light, LightShape, Scene, primitive};

/// A model on a floor.
fn model(name: &str) -> Scene {
    let mut scene = umbrage_io::open(&shared().join("data").join(name)).unwrap().scene;
    let bounds = scene.bounds();
    let size = DVec3::splat(bounds.radius() * 6.0);
    let ground = bounds.center().with_y(bounds.min.y);
    put(&mut scene, primitive::plane(), DAffine3::from_translation(ground) * DAffine3::from_scale(size));
    scene.camera.eye = bounds.center() + DVec3::new(0.9, 1.0, 1.7) * bounds.radius() * 1.5;
    scene.camera.target = bounds.center();
    scene
}

#[test]
#[ignore = "needs the shared references"]
fn open_models_are_right_under_fifty_lights() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    for name in ["teapot.obj", "suzanne.obj"] {
        let scene = model(name);
        let bounds = scene.instance_bounds(&scene.instances[0]);
        let mut bench = Bench::new(&gpu, scene, (160, 120), &EXACT);
        let mut random = Random(50);
        let mut dark = 0;
        for i in 0..50 {
            let side = (random.direction() + DVec3::Y * 0.5).normalize();
            // Every fifth in the model's box, others up to four times as far out.
            let far = if i % 5 == 4 { random.range(0.0, 0.9) } else { random.range(1.1, 4.0) };
            let position = bounds.center() + side * bounds.radius() * far;
            let shape = match i % 3 {
                0 if i % 5 != 4 => LightShape::Directional { direction: -side, angle_deg: 0.0 },
                _ => LightShape::Point { position },
            };
            let mut camera = bench.scene.camera.clone();
            if i % 2 == 1 {
                camera.eye = bounds.center() + random.direction() * bounds.radius() * random.range(0.5, 2.0);
                camera.eye.y = camera.eye.y.max(bounds.min.y + 0.1 * bounds.radius());
            }
            let light = Light::new(shape);
            let target = bench.target(&camera, &light);
            dark += target.pixels().1;
            wrong.extend(bench.compare(&format!("{name} light {i}"), &camera, &light, &target));
        }
        println!("{name}: {dark} dark pixels");
        assert!(dark > 50_000, "{name}: {dark} dark pixels");
    }
    assert_none(&wrong);
}

//! Meshes that joints bend: edges are found once, and planes follow every pose.

use super::{Bench, COUNTS, assert_none, target};
use crate::common::gpu;
use crate::steady::alive;
use umbrage::core::glam::DVec3;
use umbrage::core::{Light, LightShape, Scene, scenes};
use umbrage_reference::Tracer;

const SIZE: (u32, u32) = (160, 120);

fn scene() -> Scene {
    (scenes::find("tentacles").unwrap().build)(0.3)
}

#[test]
fn every_pose_is_right() {
    let gpu = gpu();
    let sets: Vec<String> = COUNTS
        .iter()
        .flat_map(|count| ["compute", "vertex", "cpu"].map(|extrude| format!("{count},extrude={extrude}")))
        .collect();
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    let mut bench = Bench::new(&gpu, scene(), SIZE, &sets);
    let mut scene = scene();
    let mut wrong = Vec::new();
    let mut dark = 0;
    for i in 0..8 {
        scene.advance(0.55);
        bench.move_all(&scene);
        let mut camera = scene.camera.clone();
        let shape = match i % 3 {
            0 => scene.lights[0].shape.clone(),
            // Amid the tentacles: in the boxes of some.
            1 => LightShape::Point { position: DVec3::new(0.2, 1.2, -0.3) },
            _ => LightShape::Directional { direction: DVec3::new(0.5, -0.6, -0.4).normalize(), angle_deg: 0.0 },
        };
        if i >= 4 {
            camera.eye = DVec3::new(2.2, 0.5, 1.9);
            camera.target = DVec3::new(-1.0, 0.8, -0.5);
        }
        let light = Light::new(shape);
        let target = target(&Tracer::new(&scene), &camera, &light, SIZE, 60.0);
        dark += target.pixels().1;
        wrong.extend(bench.compare(&format!("pose {i}"), &camera, &light, &target));
    }
    assert!(dark > 2_000, "{dark} dark pixels");
    assert_none(&wrong);
}

#[test]
fn poses_create_nothing() {
    for extrude in ["compute", "cpu"] {
        let gpu = gpu();
        let mut bench = Bench::new(&gpu, scene(), SIZE, &[&format!("extrude={extrude}")]);
        let mut scene = scene();
        let (camera, light) = (scene.camera.clone(), scene.lights[0].clone());
        let mut frames = |count| {
            for _ in 0..count {
                scene.advance(0.11);
                bench.move_all(&scene);
                bench.draw(&camera, &light, |renderer| renderer.wait().unwrap());
            }
            alive(&gpu)
        };
        let before = frames(6);
        assert_eq!(frames(12), before, "{extrude}");
    }
}

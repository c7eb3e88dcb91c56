//! Lights, casters and cameras that move every frame.

use super::{Bench, COUNTS, EXACT, assert_none, floor, put, target};
use crate::common::gpu;
use crate::steady::alive;
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, Light, LightShape, Scene, primitive};
use umbrage_reference::Tracer;

const SIZE: (u32, u32) = (160, 120);

fn scene() -> Scene {
    let mut scene = floor(LightShape::Point { position: DVec3::new(1.0, 5.0, 1.0) });
    put(&mut scene, primitive::cube(), DAffine3::IDENTITY);
    put(&mut scene, primitive::sphere(16, 8), DAffine3::IDENTITY);
    put(&mut scene, primitive::plane(), DAffine3::IDENTITY);
    scene
}

/// Casters, light and camera at frame `i`.
fn step(scene: &mut Scene, i: u32) -> (Camera, Light) {
    let t = 0.3 * f64::from(i);
    let place = |x, y, z| DAffine3::from_translation(DVec3::new(x, y, z));
    let squeezed = DAffine3::from_scale(DVec3::new(0.5, 0.4 + 0.2 * t.cos(), 0.6));
    scene.instances[1].world_from_mesh = place(2.0 * t.sin(), 1.0, 0.5) * DAffine3::from_rotation_y(t);
    scene.instances[2].world_from_mesh = place(-1.0, 1.5 + t.cos(), -1.0 + t.sin()) * squeezed;
    scene.instances[3].world_from_mesh = place(1.0, 2.0, -1.5 * t.cos()) * DAffine3::from_rotation_x(0.7 * t);
    let position = DVec3::new(2.0 * (0.7 * t).cos(), 4.0, 2.0 * (0.7 * t).sin());
    let direction = DVec3::new(0.4 * t.sin(), -1.0, 0.4 * t.cos()).normalize();
    let shape = match i % 4 {
        3 => LightShape::Directional { direction, angle_deg: 0.0 },
        _ => LightShape::Point { position },
    };
    let eye = DVec3::new(5.0 * (0.4 * t).sin(), 2.0, 5.0 * (0.4 * t).cos());
    (Camera { eye, target: DVec3::Y * 0.5, fov_y_deg: 60.0, ..Camera::default() }, Light::new(shape))
}

#[test]
fn every_frame_is_right() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let mut bench = Bench::new(&gpu, scene(), SIZE, &EXACT);
    for i in 0..30 {
        let mut scene = bench.scene.clone();
        let (camera, light) = step(&mut scene, i);
        bench.move_all(&scene);
        let target = target(&Tracer::new(&scene), &camera, &light, SIZE, 60.0);
        wrong.extend(bench.compare(&format!("frame {i}"), &camera, &light, &target));
    }
    assert_none(&wrong);
}

#[test]
fn frames_like_earlier_ones_create_nothing() {
    for count in COUNTS {
        for extrude in ["compute", "vertex", "cpu"] {
            let gpu = gpu();
            let set = format!("{count},extrude={extrude}");
            let mut bench = Bench::new(&gpu, scene(), SIZE, &[&set]);
            let mut round = || {
                for i in 0..12 {
                    let mut scene = bench.scene.clone();
                    let (camera, light) = step(&mut scene, i);
                    bench.move_all(&scene);
                    bench.draw(&camera, &light, |renderer| renderer.wait().unwrap());
                }
            };
            round();
            let before = alive(&gpu);
            round();
            assert_eq!(alive(&gpu), before, "{set}");
        }
    }
}

#[test]
fn an_eye_that_comes_into_a_shadow_or_a_caster_creates_nothing() {
    // What is needed for any view is made at the start: making pipelines takes long enough to be
    // seen.
    let mut wrong = Vec::new();
    for count in COUNTS {
        let gpu = gpu();
        let mut bench = Bench::new(&gpu, scene(), SIZE, &[count]);
        let mut scene = bench.scene.clone();
        let (far, light) = step(&mut scene, 2);
        bench.move_all(&scene);
        let cube = scene.instances[1].world_from_mesh.translation;
        let below = cube + (cube - light.shape.center().truncate()) * 0.3;
        let mut look = |eye: DVec3| {
            for i in 0..4 {
                let eye = eye + DVec3::X * 1e-3 * f64::from(i);
                bench.draw(&Camera { eye, ..far.clone() }, &light, |renderer| renderer.wait().unwrap());
            }
            alive(&gpu)
        };
        let before = look(far.eye);
        for (what, eye) in
            [("its shadow", below), ("the cube", cube + 0.1), ("the sphere's box", DVec3::new(-1.4, 1.7, -1.0))]
        {
            let after = look(eye);
            if after != before {
                wrong.push(format!("{count}, in {what}: {after:?}\n    before: {before:?}"));
            }
        }
    }
    assert_none(&wrong);
}

//! Eyes at exact places: in shadows, in casters, on the border of a shadow, and near planes that
//! cut.

use super::{Bench, EXACT, assert_none, floor, put};
use crate::common::gpu;
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, Light, LightShape, Scene, primitive};

fn scene() -> Scene {
    let mut scene = floor(LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 });
    put(&mut scene, primitive::cube(), DAffine3::from_translation(DVec3::new(0.0, 2.0, 0.0)));
    put(&mut scene, primitive::plane(), DAffine3::from_translation(DVec3::new(2.0, 1.5, 0.0)));
    put(&mut scene, primitive::sphere(16, 8), DAffine3::from_translation(DVec3::new(-2.5, 1.2, -0.5)));
    scene
}

fn point(x: f64, y: f64, z: f64) -> Light {
    Light::new(LightShape::Point { position: DVec3::new(x, y, z) })
}

fn from(eye: DVec3, target: DVec3, near: f64) -> Camera {
    Camera { eye, target, near, fov_y_deg: 70.0, ..Camera::default() }
}

#[test]
fn an_eye_exactly_on_the_border_of_a_shadow_sees_right() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let mut bench = Bench::new(&gpu, scene(), (160, 120), &EXACT);
    let down = bench.scene.lights[0].clone();
    // Sides of the cube's shadow are the planes x = ±0.5 and z = ±0.5, below a lamp above the
    // middle x = 3 − y and the like.
    let lamp = point(0.0, 3.0, 0.0);
    let borders = [
        (&down, DVec3::new(0.5, 1.0, 0.1)),
        (&down, DVec3::new(0.5, 0.7, 0.5)),
        (&down, DVec3::new(-0.5, 0.5, 0.5)),
        // On the line through the diagonal of the faces.
        (&down, DVec3::new(0.2, 0.9, 0.2)),
        (&down, DVec3::new(1.5, 0.6, -0.2)),
        (&lamp, DVec3::new(2.0, 1.0, 0.3)),
        (&lamp, DVec3::new(2.5, 0.5, 2.5)),
        (&lamp, DVec3::new(0.0, 0.5, 0.0)),
    ];
    for (light, eye) in borders {
        let mut too_close = 0;
        for target in [DVec3::ZERO, DVec3::new(1.3, 0.0, 1.4), DVec3::new(-1.5, 0.2, 0.5), DVec3::new(3.0, 0.4, 0.3)] {
            wrong.extend(bench.complaints(&format!("from {eye} to {target}"), &from(eye, target, 0.05), light));
            too_close += bench.count_of(2, "too close to tell");
        }
        // Where the shadow is in view.
        assert!(too_close > 0, "from {eye} the count can't be told, but it was");
    }
    assert_none(&wrong);
}

#[test]
fn an_eye_in_a_shadow_starts_with_it() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let mut bench = Bench::new(&gpu, scene(), (160, 120), &EXACT);
    let light = point(0.2, 6.0, 0.3);
    for eye in [DVec3::new(-0.1, 0.7, 0.05), DVec3::new(2.4, 0.6, -0.2), DVec3::new(-2.9, 0.1, -0.8)] {
        for target in [DVec3::ZERO, DVec3::new(3.0, 0.0, 2.0), DVec3::new(-3.0, 0.0, 1.0)] {
            let camera = from(eye, target, 0.05);
            assert!(bench.target(&camera, &light).is_eye_in_shadow);
            wrong.extend(bench.complaints(&format!("from {eye} to {target}"), &camera, &light));
            assert!(bench.count_of(2, "searched for the eye") > 0 && bench.count_of(2, "from infinity") == 0, "{eye}");
        }
    }
    assert_none(&wrong);
}

#[test]
fn an_eye_in_a_caster_sees_its_walls_dark() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let mut bench = Bench::new(&gpu, scene(), (160, 120), &EXACT);
    for light in [bench.scene.lights[0].clone(), point(0.4, 5.0, 0.6), point(0.1, 2.3, -0.2)] {
        for eye in [DVec3::new(0.1, 2.1, 0.0), DVec3::new(-0.45, 1.55, -0.45), DVec3::new(-2.6, 1.1, -0.2)] {
            for target in [DVec3::ZERO, DVec3::new(1.0, 2.1, 0.3), DVec3::new(-5.0, 2.5, -0.4)] {
                // The near plane is in the caster, or beyond its walls.
                for near in [0.01, 0.3, 1.2] {
                    let camera = from(eye, target, near);
                    if bench.target(&camera, &light).pixels().0 > 0 {
                        let what = format!("from {eye} to {target}, near {near}");
                        wrong.extend(bench.complaints(&what, &camera, &light));
                    }
                }
            }
        }
    }
    assert_none(&wrong);
}

#[test]
fn a_near_plane_may_cut_casters_and_shadows() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let mut bench = Bench::new(&gpu, scene(), (160, 120), &EXACT);
    for light in [bench.scene.lights[0].clone(), point(1.0, 5.0, 1.0), point(-4.0, 3.0, 2.0)] {
        for (eye, target) in [
            // Before the cube and its shadow, before the plate's edge, beside the sphere.
            (DVec3::new(0.1, 1.4, 1.2), DVec3::new(0.0, 0.6, 0.0)),
            (DVec3::new(0.6, 2.3, 0.9), DVec3::new(-0.3, 0.0, -0.8)),
            (DVec3::new(2.2, 1.7, 0.9), DVec3::new(1.9, 0.2, 0.0)),
            (DVec3::new(-1.2, 1.4, 0.3), DVec3::new(-3.0, 0.2, -0.9)),
        ] {
            for near in [0.2, 0.5, 0.9, 1.3] {
                let what = format!("from {eye}, near {near}");
                wrong.extend(bench.complaints(&what, &from(eye, target, near), &light));
            }
        }
    }
    assert_none(&wrong);
}

#[test]
fn casters_behind_the_eye_throw_shadows_before_it() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let mut bench = Bench::new(&gpu, scene(), (160, 120), &EXACT);
    let mut dark = 0;
    let direction = DVec3::new(0.2, -0.6, -1.0).normalize();
    for shape in [
        LightShape::Directional { direction, angle_deg: 0.0 },
        LightShape::Point { position: DVec3::new(0.1, 3.2, 3.0) },
        LightShape::Point { position: DVec3::new(-0.6, 2.6, 0.9) },
    ] {
        for x in [-2.5, 0.0, 2.0] {
            let camera = from(DVec3::new(x, 1.3, -1.9), DVec3::new(x, 0.0, -4.0), 0.05);
            let light = Light::new(shape.clone());
            dark += bench.target(&camera, &light).pixels().1;
            wrong.extend(bench.complaints(&format!("{shape:?}, x = {x}"), &camera, &light));
        }
    }
    assert!(dark > 5000, "{dark}");
    assert_none(&wrong);
}

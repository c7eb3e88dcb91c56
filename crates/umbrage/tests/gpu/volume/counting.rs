//! Ways to count that are right in some places only, and wrong where they should be; and that these
//! tests see it.

use super::{Bench, floor, put};
use crate::common::gpu;
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, LightShape, Scene, primitive};

/// Boxes of 1 m over a floor that casts nothing, under a lamp above them.
fn boxes(heights: &[f64]) -> Scene {
    let mut scene = floor(LightShape::Point { position: DVec3::new(0.5, 8.0, 0.3) });
    scene.instances[0].casts = false;
    for y in heights {
        put(&mut scene, primitive::cube(), DAffine3::from_translation(DVec3::new(0.0, *y, 0.0)));
    }
    scene
}

/// Per cent of right pixels, for the scene's own light.
fn correct(scene: &Scene, camera: &Camera, set: &str) -> f64 {
    let mut bench = Bench::new(&gpu(), scene.clone(), (160, 120), &[set]);
    let light = scene.lights[0].clone();
    let target = bench.target(camera, &light);
    let (scored, dark) = target.pixels();
    assert!(dark > 100 && dark + 100 < scored, "{dark} of {scored} are dark");
    target.right_pct(&bench.visibility(camera, &light)[0].1).0
}

#[test]
fn odd_and_even_is_right_for_one_convex_caster_and_wrong_where_shadows_overlap() {
    let one = boxes(&[1.5]);
    let two = boxes(&[1.0, 3.0]);
    for counter in ["stencil", "float"] {
        let right = correct(&one, &one.camera, &format!("count=xor,counter={counter}"));
        let wrong = correct(&two, &two.camera, &format!("count=xor,counter={counter}"));
        println!("{counter}: {right:.3} % of one, {wrong:.3} % of two");
        assert!(right >= 99.9, "{counter}: {right}");
        assert!(wrong < 99.0, "{counter}: {wrong}");
    }
    assert!(correct(&two, &two.camera, "") >= 99.9);
}

#[test]
fn counting_from_zero_is_wrong_for_an_eye_in_shadow() {
    let mut scene = boxes(&[1.5]);
    let outside = scene.camera.clone();
    // Under the box, looking out.
    scene.camera.eye = DVec3::new(-0.05, 0.4, -0.05);
    scene.camera.target = DVec3::new(0.6, 0.0, 0.6);
    scene.camera.fov_y_deg = 90.0;
    for (camera, is_right) in [(&outside, true), (&scene.camera, false)] {
        for counter in ["stencil", "float"] {
            let pct = correct(&scene, camera, &format!("count=z-pass,counter={counter}"));
            println!("z-pass, {counter}, eye {}: {pct:.3} %", camera.eye);
            assert_eq!(pct >= 99.9, is_right, "{counter} from {}: {pct}", camera.eye);
            assert!(is_right || pct < 50.0, "{pct}");
            assert!(correct(&scene, camera, &format!("count=z-pass-eye,counter={counter}")) >= 99.9);
        }
    }
}

#[test]
fn a_picture_without_one_caster_fails() {
    // What these tests would say about a technique that miscounts: that it is wrong.
    let mut scene = boxes(&[1.5]);
    put(&mut scene, primitive::cube(), DAffine3::from_translation(DVec3::new(2.5, 0.5, 1.0)));
    let mut bench = Bench::new(&gpu(), scene, (160, 120), &["budget=0", "budget=2", "budget=1"]);
    let (camera, light) = (bench.scene.camera.clone(), bench.scene.lights[0].clone());
    let complaints = bench.complaints("boxes", &camera, &light);
    assert_eq!(complaints.len(), 1, "{complaints:?}");
    assert!(complaints[0].contains("budget=1"), "{complaints:?}");
    // And about one that is off far from any edge only: a dot in the light, a hole in the shadow.
    let target = bench.target(&camera, &light);
    let mut seen = bench.visibility(&camera, &light).remove(0).1;
    assert_eq!(target.complaint("as drawn", &seen), None);
    let inside = (0..seen.data.len()).filter(|i| target.inside.data[*i]);
    for i in [inside.clone().min().unwrap(), inside.max().unwrap()] {
        seen.data[i] = 1.0 - seen.data[i];
        assert!(target.complaint("with a dot", &seen).is_some());
        seen.data[i] = f32::NAN;
        assert!(target.complaint("with a number that is none", &seen).is_some());
        seen.data[i] = target.reference.data[i];
    }
}

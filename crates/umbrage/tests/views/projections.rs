//! Every technique under every kind of projection.

use crate::host::{LAMP, SIZE, Truth, finite, gpu, mirrored, point, scene, seen, technique, turned};
use umbrage::core::{Camera, CameraView, LightShape};
use umbrage::{Error, techniques};

/// Those that go by the light's extent; all others take its centre, as under a hard light.
const SOFT: [&str; 6] = ["pcss", "pcss-jitter", "smoothies", "projective-fake", "wedges", "light-mask"];

/// Projections by name, each with the truth of its picture.
fn projections(camera: &Camera, straight: &Truth, parallel: &Truth) -> Vec<(&'static str, CameraView, Truth)> {
    let infinite = camera.view(SIZE.0, SIZE.1);
    let side = parallel_camera(camera).view(SIZE.0, SIZE.1);
    let same = || straight.mirrored([false; 2]);
    let flips = [("mirrored across", [true, false]), ("mirrored down", [false, true]), ("turned over", [true, true])];
    let mut all = vec![
        ("finite", finite(camera, SIZE, [0.1, 50.0], false), same()),
        ("finite, reversed", finite(camera, SIZE, [0.1, 50.0], true), same()),
        ("parallel, reversed", side, parallel.mirrored([false; 2])),
        ("parallel", turned(&side), parallel.mirrored([false; 2])),
        ("parallel, mirrored", mirrored(&side, [true, false]), parallel.mirrored([true, false])),
        (
            "finite, mirrored",
            mirrored(&finite(camera, SIZE, [0.1, 50.0], false), [false, true]),
            straight.mirrored([false, true]),
        ),
    ];
    all.extend(flips.map(|(name, flip)| (name, mirrored(&infinite, flip), straight.mirrored(flip))));
    all
}

fn parallel_camera(camera: &Camera) -> Camera {
    camera.clone().with_parallel(5.0, -20.0, 40.0)
}

/// The error of each technique under each projection is that of the plain one, but for what other
/// pixels and another rounding of depth change.
fn all_techniques(shape: LightShape) {
    let gpu = gpu();
    let is_soft = matches!(shape, LightShape::Sphere { .. });
    let scene = scene(shape);
    let camera = &scene.camera;
    let (straight, parallel) = (Truth::of(&scene, camera, SIZE), Truth::of(&scene, &parallel_camera(camera), SIZE));
    let clamps = gpu.has(wgpu::Features::DEPTH_CLIP_CONTROL);
    let mut wrong = Vec::new();
    for info in techniques() {
        if info.id == "none" || (is_soft && !SOFT.contains(&info.id)) {
            continue;
        }
        let mut technique = technique(&gpu, info.id);
        let mut of = |view: &CameraView, has_normals| seen(&gpu, &mut *technique, &scene, view, SIZE, has_normals);
        let plain = straight.error(&of(&camera.view(SIZE.0, SIZE.1), false).unwrap());
        for (i, (name, view, truth)) in projections(camera, &straight, &parallel).into_iter().enumerate() {
            let error = match of(&view, i % 2 == 0) {
                Ok(seen) => truth.error(&seen),
                // Volumes would be clipped.
                Err(Error::Unsupported { what, .. }) if !clamps && info.id == "volume" && view.is_parallel() => {
                    assert!(what.contains("DEPTH_CLIP_CONTROL"), "{what}");
                    continue;
                }
                Err(e) => {
                    wrong.push(format!("{} {name}: {e}", info.id));
                    continue;
                }
            };
            println!("{:16} {name:20} {error:.4}, plain {plain:.4}", info.id);
            if error > 1.5 * plain + 0.003 {
                wrong.push(format!("{} {name}: {error:.4}, plain {plain:.4}", info.id));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn hard_shadows_under_any_projection() {
    all_techniques(point());
}

#[test]
fn soft_shadows_under_any_projection() {
    all_techniques(LightShape::Sphere { position: LAMP, radius: 0.4 });
}

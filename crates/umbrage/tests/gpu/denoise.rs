//! Grain, and what takes it out.

use crate::common::{against_truth, gpu, move_instance, pairs, renderer, scene, score_frame, visibility};
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Image, Scene};
use umbrage::{Gpu, find, light_samples_over};
use umbrage_metrics::Scores;
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (160, 120);

/// The soft light of a scene under `pcss-jitter`.
fn scores(id: &str, detail: f32, denoise: &str) -> Scores {
    let set = format!("denoise={denoise}");
    against_truth(&gpu(), &scene(id, detail), 1, "pcss-jitter", &set, SIZE, 256)
}

#[test]
fn grain_goes_and_shadows_stay() {
    let (grainy, smooth) = (scores("contact", 1.0, "off"), scores("contact", 1.0, "spatial"));
    let [before, after] = [&grainy, &smooth].map(|s| s.noise.expect("a smooth penumbra"));
    println!("noise {before:.4} → {after:.4}, mae {:.4} → {:.4}", grainy.mae, smooth.mae);
    assert!(after < 0.35 * before, "noise {before} → {after}");
    assert!(smooth.mae < 1.1 * grainy.mae, "{} → {}", grainy.mae, smooth.mae);
    let inside = |s: &Scores| s.interior_pct.expect("an interior");
    assert!(inside(&smooth) > inside(&grainy) - 0.2, "a halo, {} → {}", inside(&grainy), inside(&smooth));
    assert!(smooth.speckles <= grainy.speckles);
}

#[test]
fn shadows_of_points_are_left_as_they_are() {
    let (gpu, scene) = (gpu(), scene("primitives", 0.2));
    let [off, spatial] = ["denoise=off", "denoise=spatial"]
        .map(|set| visibility(&mut renderer(&gpu, &scene, 0, "pcss-jitter", set, SIZE), &scene));
    assert!(off == spatial, "a hard shadow was smoothed");
}

#[test]
fn pictures_of_a_few_pixels_are_smoothed_too() {
    let (gpu, scene) = (gpu(), scene("contact", 0.2));
    for size in [(1, 1), (3, 2), (2, 40)] {
        let picture = visibility(&mut renderer(&gpu, &scene, 1, "pcss-jitter", "denoise=spatial", size), &scene);
        assert!(picture.data.iter().all(|v| (0.0..=1.0).contains(v)), "{size:?}: {:?}", picture.data);
    }
}

/// Four points of a soft light in each of 64 frames.
fn over_frames(gpu: &Gpu, scene: &Scene) -> Renderer {
    let settings = find("shadow-map").unwrap().settings(&pairs("size=1024")).unwrap();
    let technique = light_samples_over(gpu, &settings, 4, 64).unwrap();
    Renderer::new(gpu, scene, SIZE.0, SIZE.1, vec![LightPass { light: 1, technique }]).unwrap()
}

fn frames(renderer: &mut Renderer, scene: &Scene, count: usize) -> Image<f32> {
    (1..count).for_each(|_| renderer.frame(&scene.camera).unwrap());
    visibility(renderer, scene)
}

#[test]
fn four_points_a_frame_converge_to_the_truth() {
    let (gpu, scene) = (gpu(), scene("contact", 1.0));
    let mut renderer = over_frames(&gpu, &scene);
    let first = score_frame(&mut renderer, &scene, 1, SIZE, 256).mae;
    frames(&mut renderer, &scene, 62);
    let last = score_frame(&mut renderer, &scene, 1, SIZE, 256).mae;
    println!("first frame {first:.4}, 64th {last:.4}");
    assert!(last < 0.004 && first > 3.0 * last, "{first} → {last}");
    // After a cut the first frame is what it was.
    renderer.forget();
    let cut = score_frame(&mut renderer, &scene, 1, SIZE, 256).mae;
    assert!((cut - first).abs() < 1e-9, "{first}, after a cut {cut}");
}

#[test]
fn no_trace_of_an_old_shadow_is_left_in_the_next_frame() {
    let (gpu, mut scene) = (gpu(), scene("contact", 0.2));
    let (mut before, number) = (over_frames(&gpu, &scene), scene.instances.len() - 1);
    // After a round of frames points come in the same order as from the first one on.
    let old = frames(&mut before, &scene, 64);
    let moved = DAffine3::from_translation(DVec3::new(0.4, 0.3, -0.5)) * scene.instances[number].world_from_mesh;
    move_instance(&mut before, number, &moved);
    scene.instances[number].world_from_mesh = moved;
    let mut anew = over_frames(&gpu, &scene);
    for frame in 0..3 {
        let (kept, fresh) = (visibility(&mut before, &scene), visibility(&mut anew, &scene));
        let pixels = old.data.iter().zip(&kept.data).zip(&fresh.data);
        let changed = pixels.filter(|((old, _), fresh)| (**old - **fresh).abs() > 0.6);
        let (count, most) =
            changed.fold((0, 0.0_f32), |(count, most), ((_, kept), fresh)| (count + 1, most.max((kept - fresh).abs())));
        assert!(count > 20, "frame {frame}: only {count} pixels change");
        assert!(most < 0.02, "frame {frame}: {most} of an old shadow");
    }
}

#[test]
fn a_camera_that_moves_takes_the_mean_along() {
    let (gpu, mut scene) = (gpu(), scene("contact", 1.0));
    let mut renderer = over_frames(&gpu, &scene);
    let first = score_frame(&mut renderer, &scene, 1, SIZE, 256).mae;
    for _ in 0..24 {
        let step = scene.camera.axes()[0] * 0.01;
        scene.camera.eye += step;
        scene.camera.target += step;
        renderer.frame(&scene.camera).unwrap();
    }
    let last = score_frame(&mut renderer, &scene, 1, SIZE, 256).mae;
    println!("first frame {first:.4}, after a way {last:.4}");
    assert!(last < 0.6 * first, "{first} → {last}");
}

#[test]
fn means_of_jittered_frames_have_less_grain() {
    let (gpu, scene) = (gpu(), scene("contact", 1.0));
    let mut renderer = renderer(&gpu, &scene, 1, "pcss-jitter", "denoise=temporal", SIZE);
    let first = score_frame(&mut renderer, &scene, 1, SIZE, 256);
    frames(&mut renderer, &scene, 30);
    let last = score_frame(&mut renderer, &scene, 1, SIZE, 256);
    println!("noise {:?} → {:?}, mae {:.4} → {:.4}", first.noise, last.noise, first.mae, last.mae);
    assert!(last.noise < first.noise && last.mae <= 1.02 * first.mae, "{first:?} → {last:?}");
}

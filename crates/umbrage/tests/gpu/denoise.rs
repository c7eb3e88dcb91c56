//! Grain, and what takes it out.

use crate::common::{against_truth, gpu, renderer, scene, visibility};
use umbrage_metrics::Scores;

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

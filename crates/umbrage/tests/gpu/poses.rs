//! Meshes that joints bend, in every kind of technique: posed on the GPU, against the truth of the
//! same moment.

use crate::common::{gpu, renderer, scene, score_frame, shared, visibility};
use umbrage::core::Scene;
use umbrage_metrics::Scores;

const SIZE: (u32, u32) = (240, 180);

/// Scores a technique in a scene that was uploaded in one pose and has been bent into that of
/// `scene`.
fn score_bent(start: &Scene, scene: &Scene, light: usize, id: &str, set: &str, samples: u32) -> Scores {
    let gpu = gpu();
    let mut renderer = renderer(&gpu, start, light, id, set, SIZE);
    visibility(&mut renderer, scene);
    for (number, instance) in scene.instances.iter().enumerate() {
        if let Some(joints) = scene.joints(instance) {
            let instance = renderer.casters().instance(number).expect("an instance of the scene");
            renderer.casters_mut().set_pose(instance, &joints).expect("a pose");
        }
    }
    score_frame(&mut renderer, scene, light, SIZE, samples)
}

/// Light, technique, settings, samples, mean absolute error ×10⁻⁴ at most, least interior per cent.
type Row = (usize, &'static str, &'static str, u32, f64, f64);

const ROWS: [Row; 6] = [
    (0, "shadow-map", "size=2048", 1, 9.0, 99.95),
    (0, "pcf", "size=2048,kernel=3", 1, 14.0, 99.95),
    (0, "volume", "", 1, 0.1, 100.0),
    (0, "volume", "extrude=vertex,count=z-fail", 1, 0.1, 100.0),
    (0, "volume", "extrude=cpu", 1, 0.1, 100.0),
    (1, "pcss", "size=2048", 256, 10.0, 99.95),
];

fn assert_rows(what: &str, start: &Scene, scene: &Scene) {
    let mut wrong = Vec::new();
    for (light, id, set, samples, mae, interior) in ROWS {
        let s = score_bent(start, scene, light, id, set, samples);
        let (got, inside) = (s.mae * 1e4, s.interior_pct.unwrap_or(0.0));
        let row = format!("{what}: {id} {set}: mae {got:.2}e-4, interior {inside:.3} %");
        println!("{row}, {} scored pixels", s.scored_pixels);
        if !(got <= mae && inside >= interior) || s.not_finite > 0 {
            wrong.push(row);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn bent_tentacles_are_shadowed_as_the_truth_has_it() {
    let start = scene("tentacles", 1.0);
    for seconds in [0.9, 2.3] {
        let mut bent = start.clone();
        bent.advance(seconds);
        assert_rows(&format!("tentacles after {seconds} s"), &start, &bent);
    }
}

#[test]
#[ignore = "needs the shared references"]
fn a_running_fox_is_shadowed_as_the_truth_has_it() {
    let dir = shared().join("data/gltf");
    let text = "[camera]\neye = [2.1, 1.5, 2.2]\ntarget = [0, 0.35, 0]\nfov_y = 40\n
[[model]]\nprimitive = 'plane'\nsize = [8, 8]\n
[[model]]\npath = 'Fox.glb'\nscale = 0.01\nanimation = 'Run'\n
[[light]]\nkind = 'point'\nposition = [1.0, 2.6, -0.6]\n
[[light]]\nkind = 'sphere'\nposition = [1.0, 2.6, -0.6]\nradius = 0.12\n";
    let start = umbrage_io::open_str(text, &dir, "fox.scene.toml").unwrap().scene;
    let mut bent = start.clone();
    bent.advance(0.45);
    assert_rows("the fox after 0.45 s", &start, &bent);
}

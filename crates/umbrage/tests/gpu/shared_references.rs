//! Techniques against pictures made by other software.

use crate::common::{gpu, pairs, renderer, shared, visibility};
use umbrage::core::{Image, Scene};
use umbrage::{Gpu, find, light_samples};
use umbrage_io::stored::{StoredReference, list};
use umbrage_metrics::{Comparison, Scores, discontinuities, map_reach, score};
use umbrage_reference::{Options, Tracer};
use umbrage_renderer::{LightPass, Renderer};

fn scores(mut renderer: Renderer, scene: &Scene, stored: &StoredReference, hard: Option<&Image<f32>>) -> Scores {
    let produced = visibility(&mut renderer, scene);
    let mask = mask(stored);
    let technique = renderer.technique(0).unwrap();
    let reach = map_reach(
        technique.inside().light_views(),
        technique.inside().split_distances(),
        &scene.camera,
        &stored.depth,
        &stored.normal.map(|n| (*n).into()),
    );
    let reference = &stored.visibility;
    score(&Comparison { produced: &produced, reference, mask: &mask, hard, reach: Some(&reach), contacts: None })
        .unwrap()
}

/// The pixels that are compared.
pub fn mask(stored: &StoredReference) -> Image<bool> {
    let edges = discontinuities(&stored.depth, &stored.model.map(|m| i32::from(*m)));
    let (width, height) = size(stored);
    Image::from_fn(width, height, |x, y| stored.mask[(x, y)] && !edges[(x, y)])
}

/// Name, light number, scene and reference of every stored picture that `keep` chooses.
pub fn stored(keep: impl Fn(&Scene, usize) -> bool) -> Vec<(String, usize, Scene, StoredReference)> {
    let folder = shared().join("references");
    let mut found = Vec::new();
    for (name, lights) in list(&folder).unwrap() {
        for light in lights {
            let stored = StoredReference::open(&folder, &name, light).unwrap();
            let scene = umbrage_io::open(&stored.scene).unwrap().scene;
            if keep(&scene, light) {
                found.push((name.clone(), light, scene, stored));
            }
        }
    }
    assert!(!found.is_empty(), "no stored picture fits");
    found
}

pub fn size(stored: &StoredReference) -> (u32, u32) {
    stored.visibility.size()
}

#[test]
#[ignore = "needs the shared references"]
fn shadow_maps_have_neither_acne_nor_leaks() {
    let hard = |scene: &Scene, light: usize| !scene.lights[light].shape.kind().is_soft();
    let found = stored(hard);
    let gpu = gpu();
    for (name, light, scene, stored) in found {
        let renderer = renderer(&gpu, &scene, light, "shadow-map", "size=2048", size(&stored));
        let s = scores(renderer, &scene, &stored, None);
        let inside = s.interior_pct.unwrap_or(0.0);
        println!("{name} light {light}: mae {:.5}, interior {inside:.3} %", s.mae);
        assert!(inside >= 99.95, "{name} light {light}: interior {inside}");
        assert_eq!(s.not_finite, 0, "{name} light {light}");
    }
}

fn brute_force(gpu: &Gpu, scene: &Scene, light: usize, samples: u32, size: (u32, u32)) -> Renderer {
    let info = find("shadow-map").unwrap();
    let settings = info.settings(&pairs("size=1024")).unwrap();
    let technique = light_samples(gpu, &settings, samples).unwrap();
    Renderer::new(gpu, scene, size.0, size.1, vec![LightPass { light, technique }]).unwrap()
}

#[test]
#[ignore = "needs the shared references"]
fn brute_force_comes_close_to_the_truth() {
    // Every soft light on one scene, and casters above each other. Few samples keep it quick; the
    // README of the technique has the numbers for 256.
    let chosen = |scene: &Scene, light: usize| {
        let boxes = scene.name.starts_with("boxes") || scene.name.contains("overlap") || scene.name.contains("above");
        scene.lights[light].shape.kind().is_soft() && boxes
    };
    let found = stored(chosen);
    for (name, light, scene, stored) in found {
        let (width, height) = size(&stored);
        let tracer = Tracer::new(&scene);
        let geometry = tracer.geometry(&scene.camera, width, height);
        let one = Options { samples: 1, ..Options::default() };
        let hard = tracer.visibility(&geometry, &scene.lights[light], &scene.textures, &one, &|_, _| ()).visibility;
        let s = scores(brute_force(&gpu(), &scene, light, 64, (width, height)), &scene, &stored, Some(&hard));
        let vs_hard = s.vs_hard.unwrap_or(f64::INFINITY);
        println!("{name} light {light}: vs_hard {vs_hard:.3}");
        assert!(vs_hard <= 0.12, "{name} light {light}: {vs_hard}");
    }
}

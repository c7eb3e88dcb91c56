//! What the tests with a GPU share.

use std::{
    collections::HashMap,
    path::{Path, PathBuf},
    sync::{Arc, LazyLock, Mutex},
    time::Instant,
};
use umbrage::core::glam::DAffine3;
use umbrage::core::{Image, Scene};
use umbrage::{Gpu, find};
use umbrage_metrics::{Comparison, Scores, discontinuities, map_reach, score};
use umbrage_reference::{Geometry, Kept, Key, Options, SceneKey, Traced, Tracer, Truth};
use umbrage_renderer::{LightPass, Renderer};

/// The best adapter. Without one these tests fail and say how to get one.
pub fn gpu() -> Gpu {
    let chosen = std::env::var("UMBRAGE_ADAPTER").ok();
    Gpu::request(chosen.as_deref()).unwrap_or_else(|e| panic!("this test needs a graphics adapter: {e}"))
}

/// Pairs for [`umbrage::TechniqueInfo::settings`] from `a=1,b=2`.
pub fn pairs(set: &str) -> Vec<(String, String)> {
    let pair = |s: &str| s.split_once('=').map(|(a, b)| (a.to_string(), b.to_string())).expect("name=value");
    set.split(',').filter(|s| !s.is_empty()).map(pair).collect()
}

/// A registry scene.
pub fn scene(id: &str, detail: f32) -> Scene {
    (umbrage::core::scenes::find(id).expect("a scene of the registry").build)(detail)
}

/// A renderer with one technique on one light.
pub fn renderer(gpu: &Gpu, scene: &Scene, light: usize, id: &str, set: &str, size: (u32, u32)) -> Renderer {
    let info = find(id).unwrap();
    let technique = info.settings(&pairs(set)).unwrap().make(gpu).unwrap();
    Renderer::new(gpu, scene, size.0, size.1, vec![LightPass { light, technique }]).unwrap()
}

/// Moves an instance of the scene that a renderer was made of.
pub fn move_instance(renderer: &mut Renderer, number: usize, world_from_mesh: &DAffine3) {
    let instance = renderer.casters().instance(number).expect("an instance of the scene");
    renderer.casters_mut().move_instance(instance, world_from_mesh).expect("a transform");
}

/// The visibility that `renderer` gives for the scene's camera.
pub fn visibility(renderer: &mut Renderer, scene: &Scene) -> Image<f32> {
    renderer.frame(&scene.camera).unwrap();
    renderer.visibility(0).unwrap()
}

/// Scores a technique against a ray-traced picture of `samples` a pixel.
pub fn against_truth(
    gpu: &Gpu,
    scene: &Scene,
    light: usize,
    id: &str,
    set: &str,
    size: (u32, u32),
    samples: u32,
) -> Scores {
    score_frame(&mut renderer(gpu, scene, light, id, set, size), scene, light, size, samples)
}

/// The same for a renderer at hand that shows the light, for what it draws now.
pub fn score_frame(renderer: &mut Renderer, scene: &Scene, light: usize, size: (u32, u32), samples: u32) -> Scores {
    let produced = visibility(renderer, scene);
    let traced = traced(scene, light, size, samples);
    let (geometry, truth) = &*traced;
    let mask = mask(truth, geometry, 60.0);
    let technique = renderer.technique(0).unwrap();
    let reach = map_reach(
        technique.inside().light_views(),
        technique.inside().split_distances(),
        &scene.camera,
        &geometry.depth,
        &geometry.normal,
    );
    let reference = &truth.visibility;
    score(&Comparison { produced: &produced, reference, mask: &mask, hard: None, reach: Some(&reach), contacts: None })
        .unwrap()
}

/// What is seen and the truth about a light: traced once by all tests of this process, and its rays
/// once by all processes.
fn traced(scene: &Scene, light: usize, size: (u32, u32), samples: u32) -> Arc<(Geometry, Truth)> {
    type Known = Mutex<HashMap<Key, Arc<(Geometry, Truth)>>>;
    static TRACED: LazyLock<Known> = LazyLock::new(Mutex::default);
    let options = Options { samples, ..Options::default() };
    let key = SceneKey::new(scene).of(&scene.lights[light], size, &options);
    // Two tests that want the same at once trace it twice: none waits for what others trace.
    if let Some(found) = TRACED.lock().unwrap().get(&key) {
        return found.clone();
    }
    let tracer = Tracer::new(scene);
    let geometry = tracer.geometry(&scene.camera, size.0, size.1);
    let kept = Kept::new(&Path::new(env!("CARGO_TARGET_TMPDIR")).join("truth"));
    let truth = kept.read(key, size).ok().flatten().map(|kept| kept.truth).unwrap_or_else(|| {
        let start = Instant::now();
        let truth = tracer.visibility(&geometry, &scene.lights[light], &scene.textures, &options, &|_, _| ());
        let seconds = start.elapsed().as_secs_f64();
        kept.write(key, &Traced { truth: truth.clone(), seconds }).unwrap();
        truth
    });
    let found = Arc::new((geometry, truth));
    TRACED.lock().unwrap().insert(key, found.clone());
    found
}

/// Pixels by which a coarse rasteriser shifts surfaces; 0 for one that keeps to 1/256, under which
/// bounds hold as they are.
pub fn coarseness(gpu: &Gpu) -> f64 {
    let snapping = f64::from(gpu.snapping());
    if snapping > 1.0 / 256.0 { snapping } else { 0.0 }
}

/// How much of the error of a hard shadow is that of a coarse rasteriser, which moves the surface
/// and what hides the light from it.
pub fn moved(gpu: &Gpu, scene: &Scene, light: usize, size: (u32, u32)) -> f64 {
    match coarseness(gpu) {
        0.0 => 0.0,
        shift => 2.0 * shift * edge_share(scene, light, size),
    }
}

/// Steps between light and shadow from one scored pixel to the next, for each scored pixel: where
/// the edges of hard shadows move by a part of a pixel, so many times this part are wrong.
fn edge_share(scene: &Scene, light: usize, size: (u32, u32)) -> f64 {
    let traced = traced(scene, light, size, 1);
    let (geometry, truth) = &*traced;
    let mask = mask(truth, geometry, 60.0);
    let (width, height) = mask.size();
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let (mut scored, mut steps) = (0_u32, 0_u32);
    for (x, y) in places.filter(|&at| mask[at]) {
        scored += 1;
        let beside = [(x + 1, y), (x, y + 1)].into_iter().filter(|&(x, y)| x < width && y < height);
        steps += beside.filter(|&at| mask[at] && truth.visibility[at] != truth.visibility[(x, y)]).count() as u32;
    }
    f64::from(steps) / f64::from(scored.max(1))
}

/// The pixels to compare: those that are scored, not beside the edge of a surface and not `far`
/// metres away.
pub fn mask(truth: &Truth, geometry: &Geometry, far: f32) -> Image<bool> {
    let beside_edges = discontinuities(&geometry.depth, &geometry.model);
    let (width, height) = geometry.depth.size();
    Image::from_fn(width, height, |x, y| truth.scored[(x, y)] && !beside_edges[(x, y)] && geometry.depth[(x, y)] < far)
}

/// The folder of shared data. Tests that need it are ignored by name; `cargo xtask test` runs them
/// where it is there.
pub fn shared() -> PathBuf {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared"));
    let folder = std::env::var_os("UMBRAGE_SHARED").map_or_else(beside, PathBuf::from);
    assert!(folder.is_dir(), "there is no {}; UMBRAGE_SHARED names the folder of shared data", folder.display());
    folder
}

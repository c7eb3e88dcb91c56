//! One picture with every technique, in a browser or anywhere, and how far each is from the truth:
//! for `cargo xtask browser`. Prints a line for each technique: its id, `mae` and `interior_pct`.

use umbrage::core::glam::DVec3;
use umbrage::core::{Light, LightShape, Scene, scenes};
use umbrage::{Gpu, TechniqueInfo, techniques};
use umbrage_metrics::{Comparison, discontinuities, map_reach, score};
use umbrage_reference::{Geometry, Options, Tracer, Truth};
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (160, 120);
const SAMPLES: u32 = 16;

/// A scene, what its camera sees, and the truth about some of its lights.
struct Stage {
    scene: Scene,
    geometry: Geometry,
    truths: Vec<Option<Truth>>,
}

impl Stage {
    fn new() -> Option<Self> {
        let mut scene = (scenes::find("primitives")?.build)(1.0);
        let (from, to) = (DVec3::new(1.0, 5.0, 2.0), DVec3::new(2.0, 5.0, 3.0));
        scene.lights.push(Light::new(LightShape::Line { from, to }));
        let geometry = Tracer::new(&scene).geometry(&scene.camera, SIZE.0, SIZE.1);
        let truths = scene.lights.iter().map(|_| None).collect();
        Some(Self { scene, geometry, truths })
    }

    /// The first light that the technique can do.
    fn light(&self, info: &TechniqueInfo) -> Option<usize> {
        self.scene.lights.iter().position(|light| info.lights.contains(light.shape.kind()))
    }

    fn truth(&mut self, light: usize) -> &Truth {
        let Self { scene, geometry, truths } = self;
        truths[light].get_or_insert_with(|| {
            let options = Options { samples: SAMPLES, ..Options::default() };
            Tracer::new(scene).visibility(geometry, &scene.lights[light], &scene.textures, &options, &|_, _| ())
        })
    }
}

/// What one technique's picture scores, as a line.
async fn line(gpu: &Gpu, stage: &mut Stage, info: &'static TechniqueInfo) -> Result<String, String> {
    let text = |error: &dyn std::fmt::Display| error.to_string();
    let light = stage.light(info).ok_or("no light that it can do")?;
    let technique = info.default_settings().make(gpu).map_err(|e| text(&e))?;
    let passes = vec![LightPass { light, technique }];
    let mut renderer = Renderer::new(gpu, &stage.scene, SIZE.0, SIZE.1, passes).map_err(|e| text(&e))?;
    renderer.frame(&stage.scene.camera).map_err(|e| text(&e))?;
    // Where nobody else polls the device, its answer has to be waited for.
    #[cfg(target_family = "wasm")]
    let produced = renderer.visibility_async(0).await.map_err(|e| text(&e))?;
    #[cfg(not(target_family = "wasm"))]
    let produced = renderer.visibility(0).map_err(|e| text(&e))?;
    let truth = stage.truth(light).clone();
    let geometry = &stage.geometry;
    let beside_edges = discontinuities(&geometry.depth, &geometry.model);
    let (width, height) = truth.scored.size();
    let mask = umbrage::core::Image::from_fn(width, height, |x, y| truth.scored[(x, y)] && !beside_edges[(x, y)]);
    let inside = renderer.technique(0).ok_or("no technique")?.inside();
    let (views, splits) = (inside.light_views(), inside.split_distances());
    let reach = map_reach(views, splits, &stage.scene.camera, &geometry.depth, &geometry.normal);
    let comparison = Comparison {
        produced: &produced,
        reference: &truth.visibility,
        mask: &mask,
        hard: None,
        reach: Some(&reach),
        contacts: None,
    };
    let scores = score(&comparison).map_err(|e| text(&e))?;
    Ok(format!("picture {} {:.5} {:.3}", info.id, scores.mae, scores.interior_pct.unwrap_or(100.0)))
}

async fn all(say: impl Fn(&str)) {
    let (gpu, stage) = (Gpu::request_async(None).await, Stage::new());
    match (gpu, stage) {
        (Ok(gpu), Some(mut stage)) => {
            for info in techniques() {
                match line(&gpu, &mut stage, info).await {
                    Ok(line) => say(&line),
                    Err(error) => say(&format!("error {}: {error}", info.id)),
                }
            }
        }
        (Err(error), _) => say(&format!("error {error}")),
        (_, None) => say("error there is no such scene"),
    }
    say("end");
}

#[cfg(target_family = "wasm")]
fn main() {
    wasm_bindgen_futures::spawn_local(all(|line| web_sys::console::log_1(&format!("umbrage: {line}").into())));
}

#[cfg(not(target_family = "wasm"))]
fn main() {
    pollster::block_on(all(|line| println!("{line}")));
}

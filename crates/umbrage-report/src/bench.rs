//! Times of techniques, set against the least that any technique can cost in the same run.

use crate::{
    choice::Choice,
    compare::check_choices,
    error::Error,
    made::Made,
    measure::Frames,
    progress::Progress,
    record::{SCHEMA, Status},
    round::maybe_six,
    source::Source,
    spread::Spread,
};
use serde::Serialize;
use std::collections::BTreeMap;
use umbrage::{Gpu, LightPass, Renderer, Technique, baseline};

/// What to measure, and how.
#[derive(Clone, Debug)]
pub struct Bench {
    /// The scenes, each with the lights to look at.
    pub scenes: Vec<(Source, Vec<usize>)>,
    /// The techniques.
    pub choices: Vec<Choice>,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Frames of each technique.
    pub frames: u32,
    /// The command line, for the record.
    pub command: Vec<String>,
}

/// What `bench` found.
#[derive(Clone, Debug, Serialize)]
pub struct BenchReport {
    /// [`SCHEMA`].
    pub schema: u32,
    /// Circumstances.
    pub made: Made,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Frames of each technique, after those of warm-up.
    pub frames: u32,
    /// One for each scene, as given.
    pub scenes: Vec<BenchScene>,
}

/// A scene that was measured.
#[derive(Clone, Debug, Serialize)]
pub struct BenchScene {
    /// Its title.
    pub name: String,
    /// Registry name or path, as given.
    pub source: String,
    /// Triangles, each instance counted.
    pub triangles: usize,
    /// Placed meshes.
    pub instances: usize,
    /// One for each light of the scene.
    pub lights: Vec<BenchLight>,
}

/// A light that was measured.
#[derive(Clone, Debug, Serialize)]
pub struct BenchLight {
    /// Its number in the scene, from 0.
    pub light: usize,
    /// Its kind.
    pub kind: &'static str,
    /// Baselines first, then the techniques asked for.
    pub results: Vec<BenchResult>,
}

/// What one technique, or baseline, took.
#[derive(Clone, Debug, Serialize)]
pub struct BenchResult {
    /// Its id; `floor` and `bare-minimum` are the baselines.
    pub technique: String,
    /// Parameters set away from their defaults.
    pub settings: BTreeMap<String, String>,
    /// Points of the light that were averaged by brute force; null without.
    pub light_samples: Option<u32>,
    /// How it ended.
    pub status: Status,
    /// Why it is not `ok`; null where it is.
    pub reason: Option<String>,
    /// The numbers; null unless `ok`.
    pub cost: Option<BenchCost>,
    /// GPU time and preparation over those of the floor; null where there is no GPU time.
    #[serde(serialize_with = "maybe_six")]
    pub vs_floor: Option<f64>,
    /// The same over the bare minimum with a map of the same size.
    #[serde(serialize_with = "maybe_six")]
    pub vs_bare_minimum: Option<f64>,
}

/// Times, milliseconds, and what was drawn.
#[derive(Clone, Debug, Serialize)]
pub struct BenchCost {
    /// GPU time of every pass of the frame, also those of the renderer; empty where the adapter keeps no time.
    pub passes: Vec<BenchPass>,
    /// GPU time of the technique's own passes together; null where the adapter keeps no time.
    pub gpu_ms: Option<Spread>,
    /// Time that the CPU prepares the frame.
    pub prepare_ms: Spread,
    /// The whole frame from start to finished picture.
    pub frame_ms: Spread,
    /// Draw calls of the technique.
    pub draws: u32,
    /// Triangles it sends to the GPU.
    pub triangles: u64,
    /// GPU memory it holds, bytes.
    pub bytes: u64,
}

/// GPU time of a pass.
#[derive(Clone, Debug, Serialize)]
pub struct BenchPass {
    /// Whose it is: `light N` for the technique's, others are the renderer's.
    pub owner: String,
    /// Its name.
    pub pass: String,
    /// Milliseconds.
    pub time_ms: Spread,
}

/// Frames before the measurement: pipelines are made in the first, buffers find their size in the second.
const WARM_UP: u32 = 3;

/// Map size of the bare minimum where a technique has no parameter `size`.
const USUAL_MAP: u32 = 1024;

impl Bench {
    /// Measures. Techniques take turns frame by frame, so that a drift of the machine hits all of them alike.
    ///
    /// # Errors
    /// What stops everything: sizes beyond the adapter's limit, settings that can't be.
    pub fn run(&self, gpu: &Gpu, progress: &dyn Progress) -> Result<BenchReport, Error> {
        gpu.check_size("a picture", self.size.0, self.size.1)?;
        check_choices(&self.choices, gpu)?;
        for (source, lights) in &self.scenes {
            lights.iter().try_for_each(|&light| source.light(light).map(|_| ()))?;
        }
        let mut scenes = Vec::new();
        for (source, lights) in &self.scenes {
            let scene = &source.scene;
            let lights = lights.iter().map(|&light| self.light(gpu, source, light, progress)).collect();
            scenes.push(BenchScene {
                name: scene.name.clone(),
                source: source.asked.clone(),
                triangles: scene.triangle_count(),
                instances: scene.instances.len(),
                lights,
            });
        }
        let made = Made::now(self.command.clone(), gpu.adapter());
        let (width, height) = self.size;
        Ok(BenchReport { schema: SCHEMA, made, width, height, frames: self.frames, scenes })
    }

    fn light(&self, gpu: &Gpu, source: &Source, light: usize, progress: &dyn Progress) -> BenchLight {
        let kind = source.scene.lights[light].shape.kind();
        progress.begin(&format!("{}, light {light} ({})", source.scene.name, kind.name()), self.frames.into());
        let mut runners = self.runners(gpu, source, light);
        for round in 0..WARM_UP + self.frames {
            for runner in &mut runners {
                runner.frame(source, round >= WARM_UP);
            }
            progress.at(round.saturating_sub(WARM_UP).into());
        }
        progress.end();
        let costs: Vec<_> = runners.iter().map(|r| (r.baseline, r.cost())).collect();
        let results = runners.iter().zip(&costs).map(|(runner, (_, cost))| runner.result(cost.clone(), &costs));
        BenchLight { light, kind: kind.name(), results: results.collect() }
    }

    /// The baselines and all techniques, each with a renderer of its own.
    fn runners<'a>(&'a self, gpu: &Gpu, source: &Source, light: usize) -> Vec<Runner<'a>> {
        let make = |baseline, choice, technique: Result<Box<dyn Technique>, Error>| {
            let renderer = technique.and_then(|technique| {
                let pass = LightPass { light, technique };
                Ok(Renderer::new(gpu, &source.scene, self.size.0, self.size.1, vec![pass])?)
            });
            Runner { baseline, choice, renderer, frames: Frames::default() }
        };
        let mut sizes: Vec<u32> = self.choices.iter().map(map_size).collect();
        sizes.sort_unstable();
        sizes.dedup();
        let kind = source.scene.lights[light].shape.kind();
        let floor = make(Some(Baseline::Floor), None, Ok(baseline::floor(gpu)));
        let bare = sizes.into_iter().map(|size| {
            make(Some(Baseline::BareMinimum(size)), None, baseline::bare_minimum(gpu, size).map_err(Error::from))
        });
        let techniques = self
            .choices
            .iter()
            .map(|choice| make(None, Some(choice), choice.supports(kind).and_then(|()| choice.make(gpu))));
        std::iter::once(floor).chain(bare).chain(techniques).collect()
    }
}

/// What the others are set against.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Baseline {
    /// One full-screen pass that reads depth and writes visibility.
    Floor,
    /// A depth-only pass over the casters into a map of this size, and one full-screen one-tap pass.
    BareMinimum(u32),
}

/// One technique or baseline under measurement; the first error ends its part.
struct Runner<'a> {
    baseline: Option<Baseline>,
    choice: Option<&'a Choice>,
    renderer: Result<Renderer, Error>,
    frames: Frames,
}

impl Runner<'_> {
    fn frame(&mut self, source: &Source, counts: bool) {
        let Ok(renderer) = &mut self.renderer else { return };
        let mut unused = Frames::default();
        let frames = if counts { &mut self.frames } else { &mut unused };
        if let Err(error) = frames.add(renderer, &source.scene.camera) {
            self.renderer = Err(error.into());
        }
    }

    fn cost(&self) -> Option<BenchCost> {
        let stats = self.renderer.as_ref().ok()?.stats(0);
        let passes = self.frames.passes().into_iter();
        Some(BenchCost {
            passes: passes.map(|(owner, pass, time_ms)| BenchPass { owner, pass, time_ms }).collect(),
            gpu_ms: self.frames.technique(),
            prepare_ms: self.frames.prepare(),
            frame_ms: self.frames.frame(),
            draws: stats.draws,
            triangles: stats.triangles,
            bytes: stats.bytes,
        })
    }

    fn result(&self, cost: Option<BenchCost>, all: &[(Option<Baseline>, Option<BenchCost>)]) -> BenchResult {
        let own_size = self.choice.map_or(USUAL_MAP, map_size);
        let over = |baseline: Baseline| {
            let (_, other) = all.iter().find(|(b, _)| *b == Some(baseline))?;
            Some(cost.as_ref()?.added_ms()? / other.as_ref()?.added_ms()?)
        };
        let (technique, settings) = match (self.baseline, self.choice) {
            (_, Some(choice)) => (choice.info.id.to_string(), choice.changed().clone()),
            (Some(Baseline::BareMinimum(size)), _) => {
                ("bare-minimum".into(), BTreeMap::from([("size".into(), size.to_string())]))
            }
            _ => ("floor".into(), BTreeMap::new()),
        };
        let (status, reason) = match &self.renderer {
            Ok(_) => (Status::Ok, None),
            Err(Error::Gpu(umbrage::Error::Unsupported { what, .. })) => {
                (Status::Unsupported, Some(format!("not for {what}")))
            }
            Err(error) => (Status::Failed, Some(error.to_string())),
        };
        BenchResult {
            technique,
            settings,
            light_samples: self.choice.and_then(|c| c.light_samples),
            status,
            reason,
            vs_floor: over(Baseline::Floor),
            vs_bare_minimum: over(Baseline::BareMinimum(own_size)),
            cost,
        }
    }
}

impl BenchCost {
    /// All that the technique adds to a frame: preparing it and its passes, milliseconds.
    pub fn added_ms(&self) -> Option<f64> {
        self.gpu_ms.map(|gpu| gpu.median + self.prepare_ms.median)
    }
}

/// The size of the technique's map, where it has a parameter for it.
fn map_size(choice: &Choice) -> u32 {
    let size = choice.settings.iter().find(|(name, _)| *name == "size");
    size.and_then(|(_, value)| value.to_string().parse().ok()).unwrap_or(USUAL_MAP)
}

//! Times of techniques, set against the least that any technique can cost in the same run.

use crate::{
    choice::Choice,
    compare::check_choices,
    error::Error,
    flicker::{Follower, Found},
    made::Made,
    measure::Frames,
    motion::{Motion, Moving},
    path::CameraPath,
    progress::Progress,
    record::{SCHEMA, Status, as_text, in_order},
    round::maybe_six,
    source::Source,
    spread::Spread,
};
use serde::Serialize;
use std::collections::BTreeMap;
use umbrage::{Gpu, Owner, Technique, baseline};
use umbrage_core::{Camera, LightKind};
use umbrage_reference::Tracer;
use umbrage_renderer::{LightPass, Renderer};

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
    /// What moves from frame to frame.
    pub moving: Moving,
    /// Where the camera goes; what flickers on the way is measured then, too. Lights and casters stand still.
    pub path: Option<CameraPath>,
    /// Rays for each point of a soft light's reference that flicker is set against.
    pub samples: u32,
    /// All lights of a scene in the same frame, each with a technique of its own, where it is otherwise one light at a time.
    pub together: bool,
    /// Measures techniques that know it by the single-pass algorithm for all lights at once, too.
    pub overlay: bool,
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
    /// What moved from frame to frame.
    pub moving: Moving,
    /// Where the camera went; null where it was not on one of the paths.
    pub path: Option<CameraPath>,
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
    /// One for each light of the scene, or one for all of them together.
    pub lights: Vec<BenchLight>,
}

/// A light that was measured, or several in the same frame: then all numbers are of all of them together.
#[derive(Clone, Debug, Serialize)]
pub struct BenchLight {
    /// Its number in the scene, from 0; null for several together.
    pub light: Option<usize>,
    /// Its kind; `all` for several together.
    pub kind: &'static str,
    /// The numbers of the lights that were measured together; null for one alone.
    pub together: Option<Vec<usize>>,
    /// Flicker of the truth, see [`BenchResult::flicker`]: what the picture's own grid adds. Null where the camera was on no path.
    #[serde(serialize_with = "maybe_six")]
    pub flicker_reference: Option<f64>,
    /// How many changes it is the mean of; null where the camera was on no path.
    pub flicker_points: Option<usize>,
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
    /// The same over the bare minimum with as many maps of the same size.
    #[serde(serialize_with = "maybe_six")]
    pub vs_bare_minimum: Option<f64>,
    /// Mean absolute change of visibility from frame to frame at fixed points of the scene, 0 to 1, see [`umbrage_metrics::Flicker`].
    /// Null where the camera was on no path.
    #[serde(serialize_with = "maybe_six")]
    pub flicker: Option<f64>,
    /// The same over that of the truth, at the same points: 1 is steady. Null where that is 0, too.
    #[serde(serialize_with = "maybe_six")]
    pub flicker_ratio: Option<f64>,
}

/// Times, milliseconds, and what was drawn.
#[derive(Clone, Debug, Serialize)]
pub struct BenchCost {
    /// GPU time of every pass of the frame, also those of the renderer; empty where the adapter keeps no time.
    pub passes: Vec<BenchPass>,
    /// GPU time of the technique's own passes together; null where the adapter keeps no time.
    pub gpu_ms: Option<Spread>,
    /// CPU time of the technique's `prepare`; an overlay's includes recording.
    pub prepare_ms: Spread,
    /// The whole frame from start to finished picture.
    pub frame_ms: Spread,
    /// Draw calls of the technique.
    pub draws: u32,
    /// Triangles it sends to the GPU.
    pub triangles: u64,
    /// GPU memory it holds, bytes.
    pub bytes: u64,
    /// What else its last frame came to, by name, in the technique's own order.
    #[serde(serialize_with = "in_order")]
    pub counts: Vec<(&'static str, u64)>,
}

/// GPU time of a pass.
#[derive(Clone, Debug, Serialize)]
pub struct BenchPass {
    /// Whose it is: `light N` for the technique's, others are the renderer's.
    #[serde(serialize_with = "as_text")]
    pub owner: Owner,
    /// Its name.
    pub pass: String,
    /// Milliseconds.
    pub time_ms: Spread,
}

/// Frames before the measurement: pipelines are made in the first, buffers find their size in the second.
const WARM_UP: u32 = 3;

impl Bench {
    /// Measures. Techniques take turns frame by frame, so that a drift of the machine hits all of them alike.
    ///
    /// # Errors
    /// What stops everything: sizes beyond the adapter's limit, settings that can't be.
    pub fn run(&self, gpu: &Gpu, progress: &dyn Progress) -> Result<BenchReport, Error> {
        gpu.check_size("a picture", self.size.0, self.size.1)?;
        check_choices(&self.choices, gpu)?;
        self.check_path()?;
        for (source, lights) in &self.scenes {
            lights.iter().try_for_each(|&light| source.light(light).map(|_| ()))?;
        }
        let mut scenes = Vec::new();
        for (source, lights) in &self.scenes {
            let scene = &source.scene;
            let motion = Motion::new(self.moving, scene);
            let tracer = self.path.map(|_| Tracer::new(scene));
            let groups: Vec<&[usize]> = if self.together { vec![lights] } else { lights.chunks(1).collect() };
            let measure = |lights| self.lights(gpu, source, &motion, tracer.as_ref(), lights, progress);
            let lights = groups.into_iter().map(measure).collect::<Result<_, _>>()?;
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
        let (frames, moving, path) = (self.frames, self.moving, self.path);
        Ok(BenchReport { schema: SCHEMA, made, width, height, frames, moving, path, scenes })
    }

    /// On a path what is fixed in the scene has to stand still, and one technique alone makes the picture.
    fn check_path(&self) -> Result<(), Error> {
        let wrong = match (self.path, self.frames) {
            (None, _) => return Ok(()),
            _ if self.moving != Moving::None => {
                "no light, caster or other camera moves along a path; leave --moving out"
            }
            _ if self.together => "flicker is that of one light at a time; leave --lights-together out",
            (_, 0 | 1) => "flicker is a change between frames; write --frames 2 or more",
            _ => return Ok(()),
        };
        Err(Error::Name(format!("--path: {wrong}")))
    }

    /// Measures `lights` in the same frame.
    fn lights(
        &self,
        gpu: &Gpu,
        source: &Source,
        motion: &Motion<'_>,
        tracer: Option<&Tracer>,
        lights: &[usize],
        progress: &dyn Progress,
    ) -> Result<BenchLight, Error> {
        let (light, kind, together) = match lights {
            [light] if !self.together => (Some(*light), source.scene.lights[*light].shape.kind().name(), None),
            _ => (None, "all", Some(lights.to_vec())),
        };
        let mut record =
            BenchLight { light, kind, together, flicker_reference: None, flicker_points: None, results: Vec::new() };
        progress.begin(&format!("{}, {}", source.scene.name, record.title()), self.frames.into());
        let mut runners = self.runners(gpu, source, lights);
        let followed = tracer.zip(lights.first().map(|&light| &source.scene.lights[light]));
        let mut follower =
            followed.map(|(tracer, light)| Follower::new(source, light, tracer, self.samples, self.choices.len()));
        for round in 0..WARM_UP + self.frames {
            let counted = round.saturating_sub(WARM_UP);
            let on_path = self.path.map(|path| path.camera(&source.scene.camera, counted, self.size.1));
            let camera = on_path.unwrap_or_else(|| motion.camera(round));
            for runner in &mut runners {
                if let Ok(renderer) = &mut runner.renderer {
                    motion.apply(gpu, renderer, lights, round);
                }
                runner.frame(&camera, round >= WARM_UP);
            }
            if let Some(follower) = follower.as_mut().filter(|_| round >= WARM_UP) {
                let techniques = runners.iter().filter(|runner| runner.choice.is_some());
                follower.frame(&camera, &techniques.map(|r| r.renderer.as_ref().ok()).collect::<Vec<_>>())?;
            }
            progress.at(counted.into());
        }
        progress.end();
        let costs: Vec<_> = runners.iter().map(|r| (r.baseline, r.cost())).collect();
        record.results = runners.iter().zip(&costs).map(|(r, (_, cost))| r.result(cost.clone(), &costs)).collect();
        if let Some(follower) = &follower {
            record.set_flicker(&follower.found());
        }
        Ok(record)
    }

    /// The baselines and all techniques, each with a renderer of its own.
    fn runners<'a>(&'a self, gpu: &Gpu, source: &Source, lights: &[usize]) -> Vec<Runner<'a>> {
        let make = |baseline, choice, technique: &dyn Fn(LightKind) -> Result<Box<dyn Technique>, Error>| {
            let pass = |&light: &usize| {
                let technique = technique(source.scene.lights[light].shape.kind())?;
                Ok(LightPass { light, technique })
            };
            let passes: Result<Vec<_>, Error> = lights.iter().map(pass).collect();
            let renderer =
                passes.and_then(|passes| Ok(Renderer::new(gpu, &source.scene, self.size.0, self.size.1, passes)?));
            let anew = self.path.is_none() && self.moving == Moving::None;
            let frames = Frames::default();
            Runner { baseline, choice, renderer, overlay: false, anew, lights: lights.len(), frames }
        };
        // What has splits is set against one map, too.
        let maps = self.choices.iter().map(Maps::of);
        let mut maps: Vec<Maps> = maps.flat_map(|maps| [Maps { splits: 1, ..maps }, maps]).collect();
        maps.sort_unstable();
        maps.dedup();
        let floor = make(Some(Baseline::Floor), None, &|_| Ok(baseline::floor(gpu)));
        let bare = maps.into_iter().map(|maps| {
            make(Some(Baseline::BareMinimum(maps)), None, &|_| Ok(baseline::bare_minimum(gpu, maps.size, maps.splits)?))
        });
        let techniques = self
            .choices
            .iter()
            .map(|choice| make(None, Some(choice), &|kind| choice.supports(kind).and_then(|()| choice.make(gpu))));
        let overlays = self.choices.iter().filter(|_| self.overlay).map(|choice| {
            let runner = make(None, Some(choice), &|kind| choice.supports(kind).and_then(|()| choice.make(gpu)));
            let set = |mut renderer: Renderer| Ok(renderer.set_overlay(Some(DARKNESS)).map(|()| renderer)?);
            Runner { renderer: runner.renderer.and_then(set), overlay: true, ..runner }
        });
        std::iter::once(floor).chain(bare).chain(techniques).chain(overlays).collect()
    }
}

/// Of overlays; costs the same, whatever it is.
const DARKNESS: f32 = 0.5;

/// What the others are set against.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Baseline {
    /// One full-screen pass that reads depth and writes visibility.
    Floor,
    /// A depth-only pass over the casters into each of the maps, and one full-screen one-tap pass.
    BareMinimum(Maps),
}

/// What maps a technique has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Maps {
    /// Parts of what the camera sees with a map each.
    splits: u32,
    /// Texels across.
    size: u32,
}

/// One technique or baseline under measurement; the first error ends its part.
struct Runner<'a> {
    baseline: Option<Baseline>,
    choice: Option<&'a Choice>,
    renderer: Result<Renderer, Error>,
    overlay: bool,
    /// Nothing of earlier frames is used again.
    anew: bool,
    /// How many there are.
    lights: usize,
    frames: Frames,
}

impl Runner<'_> {
    fn frame(&mut self, camera: &Camera, counts: bool) {
        let Ok(renderer) = &mut self.renderer else { return };
        let mut unused = Frames::default();
        let frames = if counts { &mut self.frames } else { &mut unused };
        if self.anew {
            renderer.forget();
        }
        if let Err(error) = frames.add(renderer, camera) {
            self.renderer = Err(error.into());
        }
    }

    fn cost(&self) -> Option<BenchCost> {
        let renderer = self.renderer.as_ref().ok()?;
        let stats: Vec<_> = (0..self.lights).map(|pass| renderer.stats(pass)).collect();
        let passes = self.frames.passes().into_iter();
        Some(BenchCost {
            passes: passes.map(|(owner, pass, time_ms)| BenchPass { owner, pass, time_ms }).collect(),
            gpu_ms: self.frames.technique(),
            prepare_ms: self.frames.prepare(),
            frame_ms: self.frames.frame(),
            draws: stats.iter().map(|s| s.draws).sum(),
            triangles: stats.iter().map(|s| s.triangles).sum(),
            bytes: stats.iter().map(|s| s.bytes).sum(),
            counts: added((0..self.lights).flat_map(|pass| renderer.counts(pass))),
        })
    }

    fn result(&self, cost: Option<BenchCost>, all: &[(Option<Baseline>, Option<BenchCost>)]) -> BenchResult {
        let own = self.choice.map_or(Maps::USUAL, Maps::of);
        let over = |baseline: Baseline| {
            let (_, other) = all.iter().find(|(b, _)| *b == Some(baseline))?;
            Some(cost.as_ref()?.added_ms()? / other.as_ref()?.added_ms()?)
        };
        let (technique, settings) = match (self.baseline, self.choice) {
            (_, Some(choice)) => {
                let overlay = self.overlay.then(|| ("overlay".to_string(), "on".to_string()));
                (choice.info.id.to_string(), choice.changed().clone().into_iter().chain(overlay).collect())
            }
            (Some(Baseline::BareMinimum(maps)), _) => ("bare-minimum".into(), maps.settings()),
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
            vs_bare_minimum: over(Baseline::BareMinimum(own)),
            cost,
            flicker: None,
            flicker_ratio: None,
        }
    }
}

impl BenchLight {
    /// In words.
    pub(crate) fn title(&self) -> String {
        let numbers = self.together.iter().flatten().map(usize::to_string).collect::<Vec<_>>().join(", ");
        self.light.map_or(format!("lights {numbers} together"), |light| format!("light {light} ({})", self.kind))
    }

    /// The last results are those of the techniques; one that failed has none.
    fn set_flicker(&mut self, found: &Found) {
        (self.flicker_reference, self.flicker_points) = (found.reference, Some(found.points));
        let baselines = self.results.len().saturating_sub(found.techniques.len());
        for (result, flicker) in self.results[baselines..].iter_mut().zip(&found.techniques) {
            result.flicker = flicker.filter(|_| result.status == Status::Ok);
            let reference = found.reference.filter(|reference| *reference > 0.0);
            result.flicker_ratio = result.flicker.zip(reference).map(|(flicker, reference)| flicker / reference);
        }
    }
}

impl BenchCost {
    /// All that the technique adds to a frame: preparing it and its passes, milliseconds.
    pub fn added_ms(&self) -> Option<f64> {
        self.gpu_ms.map(|gpu| gpu.median + self.prepare_ms.median)
    }
}

/// Counts of several lights, added up by name.
fn added(counts: impl Iterator<Item = (&'static str, u64)>) -> Vec<(&'static str, u64)> {
    let mut sums: Vec<(&'static str, u64)> = Vec::new();
    for (name, count) in counts {
        match sums.iter_mut().find(|(other, _)| *other == name) {
            Some((_, sum)) => *sum += count,
            None => sums.push((name, count)),
        }
    }
    sums
}

impl Maps {
    /// Where a technique has no parameters for them.
    const USUAL: Self = Self { splits: 1, size: 1024 };

    fn of(choice: &Choice) -> Self {
        let value = |name: &str| {
            let (_, value) = choice.settings.iter().find(|(n, _)| *n == name)?;
            value.to_string().parse().ok()
        };
        let Self { splits, size } = Self::USUAL;
        Self { splits: value("splits").unwrap_or(splits), size: value("size").unwrap_or(size) }
    }

    fn settings(self) -> BTreeMap<String, String> {
        let splits = (self.splits > 1).then(|| ("splits".to_string(), self.splits.to_string()));
        splits.into_iter().chain([("size".into(), self.size.to_string())]).collect()
    }
}

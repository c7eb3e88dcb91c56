//! The measurement: techniques take turns frame by frame.

use crate::{
    bakes::Bakes,
    bench::{
        baseline::Baseline,
        record::{BenchLight, BenchReport, BenchScene},
        runner::Runner,
    },
    choice::Choice,
    churn::Churn,
    error::Error,
    flicker::Follower,
    made::Made,
    maps::Maps,
    measure::Frames,
    motion::{Motion, Moving},
    progress::Progress,
    record::SCHEMA,
    source::Source,
    stage::check_choices,
    way::Way,
};
use std::path::PathBuf;
use umbrage::{Gpu, Recorder, Technique, baseline};
use umbrage_core::{Light, LightKind};
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
    /// Where the camera or the light goes; what flickers on the way is measured then, too. All else
    /// stands still.
    pub path: Option<Way>,
    /// Rays for each point of a soft light's reference that flicker is set against.
    pub samples: u32,
    /// All lights of a scene in the same frame, each with a technique of its own, where it is
    /// otherwise one light at a time.
    pub together: bool,
    /// Measures techniques that know it by the single-pass algorithm for all lights at once, too.
    pub overlay: bool,
    /// Counts fragments in one more frame, and the bytes that they move.
    pub bytes: bool,
    /// So many instances are removed and inserted again in every frame.
    pub churn: u32,
    /// A folder where baked transfer is kept and found again.
    pub bake_cache: Option<PathBuf>,
    /// The command line, for the record.
    pub command: Vec<String>,
}

/// Of overlays; costs the same, whatever it is.
const DARKNESS: f32 = 0.5;

/// Frames before the measurement: pipelines are made in the first, buffers find their size in the
/// second.
const WARM_UP: u32 = 3;

impl Bench {
    /// Measures. Techniques take turns frame by frame, so that a drift of the machine hits all of
    /// them alike.
    ///
    /// # Errors
    /// What stops everything: sizes beyond the adapter's limit, settings that can't be.
    pub fn run(&self, gpu: &Gpu, progress: &dyn Progress) -> Result<BenchReport, Error> {
        gpu.check_size("a picture", self.size.0, self.size.1)?;
        check_choices(&self.choices, gpu)?;
        self.check_path()?;
        for (source, lights) in &self.scenes {
            lights.iter().try_for_each(|&light| source.light(light).and_then(|found| self.check_way(light, &found)))?;
        }
        let mut scenes = Vec::new();
        for (source, lights) in &self.scenes {
            let scene = &source.scene;
            let motion = Motion::new(self.moving, scene);
            let tracer = self.path.map(|_| Tracer::new(scene));
            let groups: Vec<&[usize]> = if self.together { vec![lights] } else { lights.chunks(1).collect() };
            let bakes = Bakes::new(source, self.bake_cache.as_deref(), progress);
            self.choices.iter().for_each(|choice| bakes.ahead(choice));
            let measure = |lights| self.lights(gpu, (source, &bakes), &motion, tracer.as_ref(), lights, progress);
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
        let Self { frames, moving, path, churn, .. } = *self;
        Ok(BenchReport { schema: SCHEMA, made, width, height, frames, moving, path, churn, scenes })
    }

    fn check_way(&self, number: usize, light: &Light) -> Result<(), Error> {
        if self.path.is_some() && light.shape.kind() == LightKind::Environment {
            let what = format!("--path measures flicker of visibility; light {number} is the environment: choose --light");
            return Err(Error::Name(what));
        }
        if self.path.is_none_or(|way| way.moves(light)) {
            return Ok(());
        }
        let kind = light.shape.kind().name();
        let remedy = "choose a directional light or a sun with --light, or take --path light";
        Err(Error::Name(format!("--path sun: light {number} is a {kind} light, whose direction nothing turns; {remedy}")))
    }

    /// On a path what is fixed in the scene has to stand still, and one technique alone makes the
    /// picture.
    fn check_path(&self) -> Result<(), Error> {
        let wrong = match (self.path, self.frames) {
            (None, _) => return Ok(()),
            _ if self.moving != Moving::None => {
                "nothing else moves along a path; leave --moving out"
            }
            _ if self.churn > 0 => "no instance comes or goes along a path; leave --churn out",
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
        (source, bakes): (&Source, &Bakes<'_>),
        motion: &Motion,
        tracer: Option<&Tracer>,
        lights: &[usize],
        progress: &dyn Progress,
    ) -> Result<BenchLight, Error> {
        let (light, kind, together) = match lights {
            [light] if !self.together => (Some(*light), source.light(*light)?.shape.kind().name(), None),
            _ => (None, "all", Some(lights.to_vec())),
        };
        let mut record =
            BenchLight { light, kind, together, flicker_reference: None, flicker_points: None, results: Vec::new() };
        let mut counting = self.bytes.then(|| Recorder::counting(gpu)).transpose()?;
        progress.begin(&format!("{}, {}", source.scene.name, record.title()), self.frames.into());
        let mut runners = self.runners(gpu, (source, bakes), lights);
        let followed = lights.first().map(|&light| source.light(light)).transpose()?;
        let mut follower = tracer.map(|tracer| Follower::new(source, tracer, self.samples, self.choices.len()));
        for round in 0..WARM_UP + self.frames {
            let counted = round.saturating_sub(WARM_UP);
            let on_path = self.path.map(|path| path.camera(&source.scene.camera, counted, self.size.1));
            let camera = on_path.unwrap_or_else(|| motion.camera(&source.scene.camera, round));
            let light = self.path.zip(followed.as_deref());
            let light = light.map(|(way, light)| way.light(light, &source.scene.camera, counted));
            for runner in &mut runners {
                if let Ok(renderer) = &mut runner.renderer {
                    motion.apply(renderer, &source.scene, lights, round)?;
                    if let (Some(light), Some(moved)) = (&light, renderer.light_mut(0)) {
                        moved.clone_from(light);
                    }
                }
                runner.churn()?;
                runner.frame(gpu, &camera, round >= WARM_UP);
            }
            if let (Some(follower), Some(light)) = (follower.as_mut().filter(|_| round >= WARM_UP), &light) {
                let techniques = runners.iter().filter(|runner| runner.choice.is_some());
                follower.frame(&camera, light, &techniques.map(|r| r.renderer.as_ref().ok()).collect::<Vec<_>>())?;
            }
            progress.at(counted.into());
        }
        if let Some(recorder) = &mut counting {
            runners.iter_mut().for_each(|runner| runner.count(gpu, &source.scene.camera, recorder));
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
    fn runners<'a>(&'a self, gpu: &Gpu, (source, bakes): (&Source, &Bakes<'_>), lights: &[usize]) -> Vec<Runner<'a>> {
        let make = |baseline, choice, technique: &dyn Fn(LightKind) -> Result<Box<dyn Technique>, Error>| {
            let pass = |&light: &usize| {
                let is_yardstick: bool = Option::is_some(&baseline);
                let light = if is_yardstick { source.yardstick_light(light) } else { light };
                let technique = technique(source.light(light)?.shape.kind())?;
                Ok(LightPass { light, technique })
            };
            let renderer = gpu.catch(|| {
                let passes = lights.iter().map(pass).collect::<Result<Vec<_>, Error>>()?;
                Ok(Renderer::new(gpu, &source.scene, self.size.0, self.size.1, passes)?)
            });
            let anew = self.path.is_none() && self.moving == Moving::None;
            let frames = Frames::default();
            let churn = renderer.as_ref().ok().and_then(|r| Churn::new(self.churn, &source.scene, r.casters()));
            let lights = lights.len();
            Runner { baseline, choice, renderer, overlay: false, anew, lights, frames, traffic: None, churn }
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
            .map(|choice| make(None, Some(choice), &|kind| choice.supports(kind).and_then(|()| bakes.make(choice, gpu))));
        let overlays = self.choices.iter().filter(|_| self.overlay).map(|choice| {
            let runner = make(None, Some(choice), &|kind| choice.supports(kind).and_then(|()| bakes.make(choice, gpu)));
            let set = |mut renderer: Renderer| Ok(renderer.set_overlay(Some(DARKNESS)).map(|()| renderer)?);
            Runner { renderer: runner.renderer.and_then(set), overlay: true, ..runner }
        });
        std::iter::once(floor).chain(bare).chain(techniques).chain(overlays).collect()
    }
}

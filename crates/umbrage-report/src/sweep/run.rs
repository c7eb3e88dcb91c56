//! A sweep: all lights of all scenes, each scene with one geometry, one renderer and one tracer.

use crate::{
    bakes::Bakes,
    bounced,
    choice::Choice,
    error::Error,
    made::Made,
    pictures::Pictures,
    progress::Progress,
    record::SCHEMA,
    source::Source,
    stage::{Stage, check_choices},
    sweep::{
        light::LightRun,
        outcome::SweepOutcome,
        plan::{Plan, check_vary},
        record::{SweepReport, SweepScene},
        vary::Vary,
    },
    truth::{Tracing, size_of},
};
use std::path::PathBuf;
use umbrage::{Gpu, Registry};
use umbrage_reference::RadianceOptions;

/// What to sweep, and how.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The scenes, each with the lights to look at.
    pub scenes: Vec<(Source, Vec<usize>)>,
    /// All techniques that there are.
    pub registry: Registry,
    /// The techniques, as sweeps start.
    pub choices: Vec<Choice>,
    /// Sweeps of some of them; the others are varied in one parameter at a time.
    pub vary: Vec<Vary>,
    /// Pixels across and down; stored references bring their own.
    pub size: (u32, u32),
    /// Rays for each pixel of a soft light's reference.
    pub samples: u32,
    /// A folder of stored references to use instead of tracing.
    pub reference: Option<PathBuf>,
    /// A folder where what is traced is kept and found again.
    pub truth_cache: Option<PathBuf>,
    /// A folder where baked transfer is kept and found again.
    pub bake_cache: Option<PathBuf>,
    /// Frames to measure times over; fewer for settings that take long.
    pub frames: u32,
    /// The command line, for the record.
    pub command: Vec<String>,
}

impl Sweep {
    /// Runs all of it. What a technique can't do and what goes wrong in it is recorded in its
    /// place.
    ///
    /// # Errors
    /// What stops everything: sizes beyond the adapter's limit, settings that can't be, references
    /// that can't be read.
    pub fn run(&self, gpu: &Gpu, progress: &dyn Progress) -> Result<SweepOutcome, Error> {
        self.check(gpu)?;
        let mut pictures = Pictures::default();
        let mut scenes = Vec::new();
        for (number, (source, lights)) in self.scenes.iter().enumerate() {
            scenes.push(self.scene(gpu, number, source, lights, &mut pictures, progress)?);
        }
        let made = Made::now(self.command.clone(), gpu.adapter());
        let report = SweepReport { schema: SCHEMA, made, frames: self.frames, scenes };
        let along = self.vary.iter().filter_map(|v| Some((v.technique.clone(), v.along()?.0.to_string())));
        Ok(SweepOutcome { report, pictures, along: along.collect() })
    }

    /// Everything that can be known to fail before the long work.
    fn check(&self, gpu: &Gpu) -> Result<(), Error> {
        gpu.check_size("a picture", self.size.0, self.size.1)?;
        check_vary(&self.registry, &self.choices, &self.vary)?;
        Plan::new(&self.choices, &self.vary, false)?;
        check_choices(&self.choices, gpu)?;
        for (source, lights) in &self.scenes {
            for &light in lights {
                source.light(light)?;
                size_of(self.size, self.reference.as_deref(), source, light)?;
            }
        }
        Ok(())
    }

    /// All lights of a scene; `number` tells its pictures from those of others.
    fn scene(
        &self,
        gpu: &Gpu,
        number: usize,
        source: &Source,
        lights: &[usize],
        pictures: &mut Pictures,
        progress: &dyn Progress,
    ) -> Result<SweepScene, Error> {
        let scene = &source.scene;
        let first = lights.first().copied().unwrap_or_default();
        let (width, height) = size_of(self.size, self.reference.as_deref(), source, first)?;
        progress.begin(&format!("{}: geometry", scene.name), 1);
        let tracing = Tracing::new(source, width, height).kept_in(source, self.truth_cache.as_deref());
        progress.end();
        let bakes = Bakes::new(source, self.bake_cache.as_deref(), progress);
        let mut stage = Stage::new(gpu, source, (width, height), bakes);
        let mut record = SweepScene {
            name: scene.name.clone(),
            source: source.asked.clone(),
            width,
            height,
            triangles: scene.triangle_count(),
            instances: scene.instances.len(),
            notes: source.notes.clone(),
            lights: Vec::new(),
        };
        for &light in lights {
            let kind = source.light(light)?.shape.kind();
            let plan = Plan::new(&self.choices, &self.vary, kind.is_soft())?;
            let choices: Vec<Choice> = plan.settings.iter().map(|setting| setting.choice.clone()).collect();
            let able = choices.iter().filter(|choice| choice.supports(kind).is_ok());
            able.for_each(|choice| stage.bakes().ahead(choice));
            let truth = |(bounces, _)| {
                let options = RadianceOptions { samples: self.samples, bounces };
                let truth = tracing.truth(self.reference.as_deref(), source, light, &options, progress)?;
                Ok::<_, Error>((bounces, truth))
            };
            let truths = bounced::groups(kind, &choices).into_iter().map(truth).collect::<Result<Vec<_>, _>>()?;
            let place = format!("{number}-{}-light{light}", source.stem());
            let run = LightRun { gpu, source, light, frames: self.frames, tracing: &tracing, truths: &truths, progress };
            record.lights.push(run.run(&plan, &mut stage, &place, pictures)?);
        }
        Ok(record)
    }
}

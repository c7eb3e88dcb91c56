//! The comparison: scenes × lights × techniques against the truth.

use crate::{
    bakes::Bakes,
    bounced,
    cell::Cell,
    choice::Choice,
    error::Error,
    html,
    made::Made,
    output::Folder,
    pictures::Pictures,
    progress::Progress,
    record::{LightRecord, Report, ResultRecord, SCHEMA, SceneRecord},
    source::Source,
    stage::{Stage, check_choices},
    truth::{Tracing, size_of},
};
use std::path::PathBuf;
use umbrage::Gpu;
use umbrage_reference::RadianceOptions;

/// What to compare, and how.
#[derive(Clone, Debug)]
pub struct Compare {
    /// The scenes, each with the lights to look at.
    pub scenes: Vec<(Source, Vec<usize>)>,
    /// The techniques.
    pub choices: Vec<Choice>,
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
    /// Frames to measure times over.
    pub frames: u32,
    /// Frames in which nothing changes between these and the one that is scored, for techniques
    /// that get better from frame to frame.
    pub still: u32,
    /// The command line, for the record.
    pub command: Vec<String>,
}

/// A finished comparison.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The numbers.
    pub report: Report,
    /// The pictures that the numbers refer to.
    pub pictures: Pictures,
}

impl Compare {
    /// Runs all of it. What a technique can't do and what goes wrong in it is recorded in its
    /// place.
    ///
    /// # Errors
    /// What stops everything: sizes beyond the adapter's limit, settings that can't be, references
    /// that can't be read.
    pub fn run(&self, gpu: &Gpu, progress: &dyn Progress) -> Result<Outcome, Error> {
        self.check(gpu)?;
        let mut run = Run { plan: self, gpu, progress, pictures: Pictures::default() };
        let mut scenes = Vec::new();
        for (number, (source, lights)) in self.scenes.iter().enumerate() {
            scenes.push(run.scene(number, source, lights)?);
        }
        let made = Made::now(self.command.clone(), gpu.adapter());
        Ok(Outcome { report: Report { schema: SCHEMA, made, scenes }, pictures: run.pictures })
    }

    /// Everything that can be known to fail before the long work.
    fn check(&self, gpu: &Gpu) -> Result<(), Error> {
        gpu.check_size("a picture", self.size.0, self.size.1)?;
        check_choices(&self.choices, gpu)?;
        for (source, lights) in &self.scenes {
            for &light in lights {
                source.light(light)?;
                size_of(self.size, self.reference.as_deref(), source, light)?;
            }
        }
        Ok(())
    }
}

/// A comparison under way.
struct Run<'a> {
    plan: &'a Compare,
    gpu: &'a Gpu,
    progress: &'a dyn Progress,
    pictures: Pictures,
}

impl Run<'_> {
    fn scene(&mut self, number: usize, source: &Source, lights: &[usize]) -> Result<SceneRecord, Error> {
        let (scene, plan) = (&source.scene, self.plan);
        let first = lights.first().copied().unwrap_or_default();
        let (width, height) = size_of(plan.size, plan.reference.as_deref(), source, first)?;
        self.progress.begin(&format!("{}: geometry", scene.name), 1);
        let tracing = Tracing::new(source, width, height).kept_in(source, plan.truth_cache.as_deref());
        self.progress.end();
        let bakes = Bakes::new(source, plan.bake_cache.as_deref(), self.progress);
        let mut stage = Stage::new(self.gpu, source, (width, height), bakes);
        let mut records = Vec::new();
        for &light in lights {
            let kind = source.light(light)?.shape.kind();
            let place = format!("{number}-{}-light{light}", source.stem());
            for (bounces, choices) in bounced::groups(kind, &plan.choices) {
                let place = if bounces == 0 { place.clone() } else { format!("{place}-bounces{bounces}") };
                records.push(self.light(&mut stage, source, (light, bounces), &choices, &tracing, &place)?);
            }
        }
        let coarse = coarse_maps(&records);
        coarse.iter().for_each(|note| self.progress.note(&format!("{}: {note}", scene.name)));
        Ok(SceneRecord {
            name: scene.name.clone(),
            source: source.asked.clone(),
            width,
            height,
            triangles: scene.triangle_count(),
            instances: scene.instances.len(),
            notes: source.notes.iter().cloned().chain(coarse).collect(),
            lights: records,
        })
    }

    /// One light under these techniques; `place` starts the names of its pictures.
    fn light(
        &mut self,
        stage: &mut Stage<'_>,
        source: &Source,
        (light, bounces): (usize, u32),
        choices: &[&Choice],
        tracing: &Tracing,
        place: &str,
    ) -> Result<LightRecord, Error> {
        let (scene, plan) = (&source.scene, self.plan);
        let kind = source.light(light)?.shape.kind();
        let options = RadianceOptions { samples: plan.samples, bounces };
        let truth = tracing.truth(plan.reference.as_deref(), source, light, &options, self.progress)?;
        choices.iter().filter(|choice| choice.supports(kind).is_ok()).for_each(|choice| stage.bakes().ahead(choice));
        let cell = Cell { gpu: self.gpu, source, light, truth: &truth, tracing, still: plan.still };
        let reference = cell.reference(place, &mut self.pictures)?;
        let what = format!("{}, light {light} ({}): techniques", scene.name, kind.name());
        self.progress.begin(&what, choices.len() as u64);
        let mut results = Vec::new();
        for choice in choices {
            results.push(cell.run(stage, choice, plan.frames, place, &mut self.pictures));
            self.progress.at(results.len() as u64);
        }
        self.progress.end();
        Ok(LightRecord { light, kind: kind.name(), soft: kind.is_soft(), reference, results })
    }
}

/// How large a texel is on the screen, pixels, at half of the pixels at least where a map cannot do
/// a scene: its shadows are blocks, and objects smaller than them have none.
const COARSE_PIXELS: f64 = 16.0;

/// A note on each light's maps that are too coarse for the scene.
fn coarse_maps(lights: &[LightRecord]) -> Vec<String> {
    let of = |light: &LightRecord| {
        let median =
            |result: &ResultRecord| result.aliasing.map(|aliasing| (result.technique.clone(), aliasing.median));
        let mut coarse =
            light.results.iter().filter_map(median).filter(|(_, pixels)| pixels.is_finite() && *pixels > COARSE_PIXELS);
        let (technique, pixels) = coarse.next()?;
        let others = if coarse.next().is_some() { " and others" } else { "" };
        Some(format!(
            "light {}: at half of the pixels a texel of {technique}{others} is {pixels:.0} pixels or more across; `cascaded`, a warp \
             (`psm`, `lispsm`, `plane-optimal`) or a larger `size` suit such a scene",
            light.light
        ))
    };
    lights.iter().filter_map(of).collect()
}

impl Outcome {
    /// Writes `report.json`, `index.html` and the pictures.
    ///
    /// # Errors
    /// A folder that can't be written to.
    pub fn write(&self, folder: &Folder) -> Result<(), Error> {
        let earlier = folder.pictures_of("report.json");
        for (name, bytes) in &self.pictures.files {
            folder.write(name, bytes)?;
        }
        folder.remove(earlier, |name| self.pictures.files.contains_key(name));
        folder.write("report.json", self.json().as_bytes())?;
        folder.write("index.html", html::page(&self.report, &self.pictures.files).as_bytes())
    }

    /// The text of `report.json`.
    pub fn json(&self) -> String {
        crate::json(&self.report)
    }
}

#[cfg(test)]
mod tests {
    use super::coarse_maps;
    use crate::{fixture::fixture, record::AliasingRecord};

    #[test]
    fn maps_too_coarse_for_a_scene_are_named_once_a_light() {
        let mut lights = fixture().scenes.remove(0).lights;
        assert!(coarse_maps(&lights).is_empty());
        for result in &mut lights[0].results {
            result.aliasing = Some(AliasingRecord { median: 40.0, p95: 90.0, p99: f64::INFINITY });
        }
        let notes = coarse_maps(&lights);
        assert!(notes.len() == 1 && notes[0].contains("40 pixels") && notes[0].contains("cascaded"), "{notes:?}");
    }
}

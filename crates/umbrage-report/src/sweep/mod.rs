//! Quality at equal cost and cost at equal quality: techniques × settings on each light, scored by [`Compare`](crate::Compare)
//! and timed by [`Bench`](crate::Bench).

mod along;
pub(crate) mod answer;
mod axis;
mod canvas;
pub(crate) mod measures;
mod plan;
pub(crate) mod plot;
pub(crate) mod record;
mod rule;
mod run;
mod table;
mod time;
mod vary;

use crate::{
    choice::Choice, compare::check_choices, error::Error, html, made::Made, output::Folder, pictures::Pictures,
    progress::Progress, record::SCHEMA, source::Source,
};
use plan::{Plan, check_vary};
use record::SweepReport;
use run::Run;
use std::path::PathBuf;
use umbrage::Gpu;
use umbrage_io::stored::StoredReference;
pub use vary::Vary;

/// What to sweep, and how.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The scenes, each with the lights to look at.
    pub scenes: Vec<(Source, Vec<usize>)>,
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
    /// Frames to measure times over.
    pub frames: u32,
    /// The command line, for the record.
    pub command: Vec<String>,
}

/// A finished sweep.
#[derive(Clone, Debug)]
pub struct SweepOutcome {
    /// The numbers.
    pub report: SweepReport,
    /// The pictures of the references.
    pub pictures: Pictures,
    /// Techniques and parameters that plots of the error run along.
    along: Vec<(String, String)>,
}

impl Sweep {
    /// Runs all of it. What a technique can't do and what goes wrong in it is recorded in its place.
    ///
    /// # Errors
    /// What stops everything: sizes beyond the adapter's limit, settings that can't be, references that can't be read.
    pub fn run(&self, gpu: &Gpu, progress: &dyn Progress) -> Result<SweepOutcome, Error> {
        self.check(gpu)?;
        let mut run = Run { sweep: self, gpu, progress, pictures: Pictures::default() };
        let mut scenes = Vec::new();
        for (number, (source, lights)) in self.scenes.iter().enumerate() {
            scenes.push(run.scene(number, source, lights)?);
        }
        let made = Made::now(self.command.clone(), gpu.adapter());
        let report = SweepReport { schema: SCHEMA, made, frames: self.frames, scenes };
        let along = self.vary.iter().filter_map(|v| Some((v.technique.clone(), v.along()?.0.to_string())));
        Ok(SweepOutcome { report, pictures: run.pictures, along: along.collect() })
    }

    /// Everything that can be known to fail before the long work.
    fn check(&self, gpu: &Gpu) -> Result<(), Error> {
        gpu.check_size("a picture", self.size.0, self.size.1)?;
        check_vary(&self.choices, &self.vary)?;
        check_choices(&self.choices, gpu)?;
        let is_asked = |choice: &&Choice| self.vary.iter().any(|vary| vary.technique == choice.info.id);
        let asked: Vec<Choice> = self.choices.iter().filter(is_asked).cloned().collect();
        check_choices(&Plan::new(&asked, &self.vary, false, &|_| false)?.choices, gpu)?;
        for (source, lights) in &self.scenes {
            for &light in lights {
                source.light(light)?;
                if let Some(folder) = &self.reference {
                    StoredReference::open(folder, &source.stem(), light)?;
                }
            }
        }
        Ok(())
    }
}

impl SweepOutcome {
    /// Writes `sweep.json`, `index.html`, the pictures of the references and the plots.
    ///
    /// # Errors
    /// A folder that can't be written to.
    pub fn write(&self, folder: &Folder) -> Result<(), Error> {
        for (name, bytes) in &self.pictures.files {
            folder.write(name, bytes)?;
        }
        let mut plots = plot::all(&self.report);
        plots.extend(along::all(&self.report, &self.along));
        for plot in &plots {
            folder.write(&plot.file, plot.svg.as_bytes())?;
        }
        folder.write("sweep.json", self.json().as_bytes())?;
        folder.write("index.html", html::sweep_page(&self.report, &self.pictures.files, &plots).as_bytes())
    }

    /// The text of `sweep.json`.
    pub fn json(&self) -> String {
        crate::json(&self.report)
    }

    /// For each light, both answers by the mean absolute error.
    pub fn tables(&self) -> String {
        table::tables(&self.report)
    }
}

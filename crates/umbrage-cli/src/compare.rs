//! `umbrage compare`: techniques against the truth.

use crate::{
    Context,
    args::{self, Adapter, Size},
    bars::Bars,
    say,
};
use anyhow::Result;
use clap::Args;
use std::path::PathBuf;
use umbrage_report::{Compare as Plan, Folder, tables};

/// Scores techniques against ray-traced ground truth: a table, report.json and a page with pictures
#[derive(Args)]
#[command(after_help = "\
Examples:
  umbrage compare primitives --techniques all -o out
  umbrage compare atrium city --techniques shadow-map,pcf:kernel=7 --samples 1024 -o out
  umbrage compare contact --techniques shadow-map,shadow-map:light-samples=64 --samples 64 -o out
  umbrage compare contact --techniques shadow-map:light-samples=4:light-frames=64 --still 63 -o out
  umbrage compare boxes.scene.toml --techniques all --reference references -o out --json

DIR gets report.json, index.html (open it in a browser) and pictures/. --reference takes a folder with NAME.lightK.visibility.png, NAME.lightK.mask.png and NAME.geometry.npz, NAME being that of the scene file.")]
pub struct Compare {
    #[command(flatten)]
    what: args::What,
    #[command(flatten)]
    moved: args::Moved,
    /// Rays for each pixel of the reference
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    samples: u32,
    /// Stored references to score against instead of tracing them; they bring their size
    #[arg(long, value_name = "DIR")]
    reference: Option<PathBuf>,
    /// Folder where traced references are kept and found again, by what determines them
    #[arg(long, value_name = "DIR")]
    truth_cache: Option<PathBuf>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = args::size)]
    size: Size,
    /// Frames that times are medians of
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    frames: u32,
    /// Frames in which nothing changes before the one that is scored, for techniques that get
    /// better from frame to frame
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=10_000))]
    still: u32,
    /// Folder to write to
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Print report.json instead of the table
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    adapter: Adapter,
}

impl Compare {
    /// Compares, prints and writes.
    pub fn run(self, context: &Context<'_>) -> Result<()> {
        let choices = self.what.choices(context.registry)?;
        let scenes = self.what.scenes(&choices)?.into_iter();
        let scenes = scenes.map(|(source, lights)| (self.moved.of(source, self.size), lights)).collect();
        let gpu = self.adapter.gpu()?;
        let folder = Folder::check(&self.output)?;
        let plan = Plan {
            scenes,
            choices,
            size: (self.size.width, self.size.height),
            samples: self.samples,
            reference: self.reference,
            truth_cache: args::kept_in(self.truth_cache)?,
            bake_cache: self.what.bake_cache()?,
            frames: self.frames,
            still: self.still,
            command: context.line.clone(),
        };
        let outcome = plan.run(&gpu, &Bars::default())?;
        outcome.write(&folder)?;
        if self.json {
            say::json(&outcome.json())?;
        } else {
            say::text(&format!("{}\nwrote {}\n", tables(&outcome.report), folder.path("index.html").display()))?;
        }
        Ok(())
    }
}

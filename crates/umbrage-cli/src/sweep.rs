//! `umbrage sweep`: error against cost.

use crate::{
    Context,
    args::{self, Adapter, Size},
    bars::Bars,
    say,
};
use anyhow::Result;
use clap::Args;
use std::path::PathBuf;
use umbrage_report::{Folder, Sweep as Plan, Vary};

/// Sets techniques under many settings against each other: the least error at equal cost, the least
/// cost at equal error
#[derive(Args)]
#[command(after_help = "\
Examples:
  umbrage sweep primitives lantern
  umbrage sweep contact --light 0 --techniques shadow-map,pcf --samples 1024 -o out
  umbrage sweep city --techniques pcf --vary 'pcf:kernel=3|5|7,size=512|1024|2048'
  umbrage sweep contact --techniques shadow-map --vary 'shadow-map:light-samples=1|4|16|64'
  umbrage sweep city --light 0 --techniques esm --vary 'esm:exponent=10..80/8'

Errors are those of `compare`, times those of `bench`. Each technique is varied around its settings in the list, one parameter \
at a time: numbers ×2, ×1/2, ×4, ×1/4, words by each value, hard techniques under soft lights also by `light-samples`; at most 12 \
settings for each technique. Parameters that the list sets keep their values. --vary replaces this for its technique by all \
combinations of the given values; from..to/count means that many numbers in equal steps (5 without a count), and the error along \
them is plotted, too. DIR gets sweep.json, index.html (open it in a browser), plots/ and pictures/.")]
pub struct Sweep {
    #[command(flatten)]
    what: args::What,
    /// All combinations of these values in place of the built-in sweep of the technique; may be
    /// repeated
    #[arg(long, value_name = "TECHNIQUE:NAME=VALUE|FROM..TO,…", value_parser = Vary::parse)]
    vary: Vec<Vary>,
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
    /// Frames of each setting that times are medians of; fewer where they take more than 4 s
    /// together
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,
    /// Folder to write to
    #[arg(short, long, value_name = "DIR", default_value = "out/sweep")]
    output: PathBuf,
    /// Print sweep.json instead of the tables
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    adapter: Adapter,
}

impl Sweep {
    /// Sweeps, prints and writes.
    pub fn run(self, context: &Context<'_>) -> Result<()> {
        let choices = self.what.choices(context.registry)?;
        let scenes = self.what.scenes(&choices)?;
        let gpu = self.adapter.gpu()?;
        let folder = Folder::check(&self.output)?;
        let plan = Plan {
            scenes,
            registry: context.registry.clone(),
            choices,
            vary: self.vary,
            size: (self.size.width, self.size.height),
            samples: self.samples,
            reference: self.reference,
            truth_cache: args::kept_in(self.truth_cache)?,
            bake_cache: self.what.bake_cache()?,
            frames: self.frames,
            command: context.line.clone(),
        };
        let outcome = plan.run(&gpu, &Bars::default())?;
        outcome.write(&folder)?;
        if self.json {
            say::json(&outcome.json())?;
        } else {
            say::text(&format!("{}\nwrote {}\n", outcome.tables(), folder.path("index.html").display()))?;
        }
        Ok(())
    }
}

//! `umbrage bench`: times.

use crate::{
    Context,
    args::{self, Adapter, Size},
    bars::Bars,
    say,
};
use anyhow::{Context as _, Result};
use clap::Args;
use std::path::{Path, PathBuf};
use umbrage_report::{Bench as Plan, Earlier, Moving, Way};

/// Measures techniques: GPU time of each pass, frame, draws, triangles, memory, against the floor
/// of the same run
#[derive(Args)]
#[command(after_help = "\
Examples:
  umbrage bench atrium --techniques all
  umbrage bench city primitives --techniques shadow-map:size=512,pcf --json > bench.json
  umbrage bench bunny.scene.toml --light 0 --csv > bench.csv
  umbrage bench atrium --techniques volume,volume:extrude=cpu --moving lights --lights-together
  umbrage bench city --light 0 --techniques shadow-map,pcf --path strafe
  umbrage bench city:62.5 --light 0 --techniques shadow-map --churn 100
  umbrage bench atrium --vs earlier.json

Techniques take turns frame by frame. `floor` is one full-screen pass that reads depth and writes visibility; \
`bare-minimum` is a depth-only pass into a map of the same size, or into as many as there are splits, and a full-screen pass with one look-up.

--path moves the camera by about a pixel a frame (walk: forward; strafe: to the right; turn: around; fly: all at once) and measures \
flicker: the mean absolute change of visibility, 0 to 1, from one frame to the next at points that are fixed in the scene. A point \
counts where two frames show it within 1/8 pixel of a pixel's centre, so that nothing is interpolated. Lights and casters stand \
still, so the truth does not change; the change of the ray tracer's visibility at the same pixels is the effect of this 1/8 pixel. \
The ratio of both is 1 where shadows are still, and grows with edges that crawl, jump or sparkle. On the paths `light` and `sun` the \
light moves before a camera that stands: across the view by a thousandth of its distance a frame, or as the sun does in a second (0.0042°; \
directional lights only). The truth changes, too, then. The change error is the mean of |change − the truth's change|.

--bytes counts the fragments of every render pass that reach its target, and multiplies them by the bytes that each reads and writes: attachments (depth to test and to write, colour to write and to blend), texels of maps, and depth and normal of the receiver. What a test of depth rejects or a shader discards is not counted, and compute passes are not. A technique whose fragments differ in what they read, and does not say how much that is at most, has no sum.")]
pub struct Bench {
    #[command(flatten)]
    what: args::What,
    /// Frames of each technique
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,
    /// What moves a little every frame: none, lights, casters, camera or all; `still` lets
    /// techniques keep what does not change
    #[arg(long, value_name = "WHAT", default_value = "none")]
    moving: Moving,
    /// Measure flicker along a path of the camera (walk, strafe, turn, fly) or of the light (light,
    /// sun)
    #[arg(long, value_name = "NAME", conflicts_with_all = ["moving", "lights_together"])]
    path: Option<Way>,
    /// Rays for each point of the reference that flicker is set against
    #[arg(long, value_name = "N", default_value_t = 64, requires = "path", value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    samples: u32,
    /// All lights in the same frame, each with a technique of its own, instead of one light at a
    /// time
    #[arg(long)]
    lights_together: bool,
    /// Measure the wrong single-pass algorithm, too: one overlay for the shadows of all lights
    #[arg(long, requires = "lights_together")]
    overlay: bool,
    /// Remove and insert again so many instances in every frame, and measure the CPU's time for
    /// that
    #[arg(long, value_name = "N", default_value_t = 0, conflicts_with = "path")]
    churn: u32,
    /// Count fragments in one more frame, and the bytes that they move
    #[arg(long)]
    bytes: bool,
    /// Set the times beside those of an earlier run, whose JSON this is
    #[arg(long, value_name = "FILE", conflicts_with_all = ["json", "csv"])]
    vs: Option<PathBuf>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = args::size)]
    size: Size,
    /// Print JSON
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// Print CSV, one line a technique
    #[arg(long)]
    csv: bool,
    #[command(flatten)]
    adapter: Adapter,
}

impl Bench {
    /// Measures and prints.
    pub fn run(self, context: &Context<'_>) -> Result<()> {
        let choices = self.what.choices(context.registry)?;
        let scenes = self.what.scenes(&choices)?;
        let earlier = self.vs.as_deref().map(earlier).transpose()?;
        let gpu = self.adapter.gpu()?;
        let plan = Plan {
            scenes,
            choices,
            size: (self.size.width, self.size.height),
            frames: self.frames,
            moving: self.moving,
            path: self.path,
            samples: self.samples,
            together: self.lights_together,
            overlay: self.overlay,
            bytes: self.bytes,
            churn: self.churn,
            bake_cache: self.what.bake_cache()?,
            command: context.line.clone(),
        };
        let report = plan.run(&gpu, &Bars::default())?;
        match (self.json, self.csv) {
            (true, _) => say::json(&report.json()),
            (_, true) => say::text(&report.csv()),
            _ => say::text(&report.tables()),
        }?;
        earlier.map_or(Ok(()), |earlier| say::text(&report.versus(&earlier)))
    }
}

/// Reads an earlier run before this one takes its time.
fn earlier(path: &Path) -> Result<Earlier> {
    let text = std::fs::read_to_string(path).with_context(|| format!("can't read {}", path.display()))?;
    Earlier::read(&text).with_context(|| path.display().to_string())
}

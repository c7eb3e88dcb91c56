//! From nothing to a picture book: every technique on a few built-in scenes against ray-traced
//! ground truth.

use crate::{
    setup,
    shell::{self, Profile},
};
use anyhow::Result;
use std::time::Instant;

const FOLDER: &str = "out/demo";

/// Those that all techniques can be seen on in a minute or two on a software driver, which draws a
/// frame in tens of milliseconds.
const SCENES: [&str; 6] = ["primitives", "contact", "lantern", "atrium:0.25", "city:0.25", "terrain:0.25"];

/// Builds, sets up, compares; ends with the file to open.
pub fn run() -> Result<()> {
    let is_software = setup::run(Profile::Release)?;
    let start = Instant::now();
    let (size, frames) = if is_software { ("320x240", "3") } else { ("640x480", "7") };
    let mut arguments = vec!["compare"];
    arguments.extend(SCENES);
    arguments.extend(["--techniques", "all,shadow-map:light-samples=64"]);
    arguments.extend(["--samples", "256", "--size", size, "--frames", frames, "-o", FOLDER]);
    shell::run(shell::umbrage(Profile::Release, &arguments))?;
    println!("\n{:.0} s. Open {FOLDER}/index.html in a browser.", start.elapsed().as_secs_f64());
    Ok(())
}

//! From nothing to a picture book: every technique on a few built-in scenes against ray-traced ground truth.

use crate::{
    setup,
    shell::{self, Profile},
};
use anyhow::Result;
use std::time::Instant;

const FOLDER: &str = "out/demo";

/// Builds, sets up, compares; ends with the file to open.
pub fn run() -> Result<()> {
    setup::run(Profile::Release)?;
    let start = Instant::now();
    let scenes = ["primitives", "contact", "lantern", "atrium:0.25", "city", "terrain"];
    let mut arguments = vec!["compare"];
    arguments.extend(scenes);
    let techniques = "all,shadow-map:light-samples=64";
    arguments.extend(["--techniques", techniques, "--samples", "256", "--size", "640x480", "-o", FOLDER]);
    shell::run(shell::umbrage(Profile::Release, &arguments))?;
    println!("\n{:.0} s. Open {FOLDER}/index.html in a browser.", start.elapsed().as_secs_f64());
    Ok(())
}

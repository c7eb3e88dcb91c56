//! What the documentation takes from the program: tables of the registry, numbers of a stored run,
//! and the first pictures.

use crate::{
    bench, setup,
    shell::{self, Profile},
};
use anyhow::{Context, Result};
use serde_json::Value;
use std::{fs, path::Path};

/// The scene of the pictures, under its soft light, and what is shown of it.
const PICTURED: [&str; 7] =
    ["compare", "contact", "--light", "1", "--techniques", "shadow-map,pcss,wedges", "--samples"];
/// The scene whose numbers stand in the README.
const MEASURED: [&str; 4] = ["compare", "primitives", "--techniques", "all"];
const RAYS: &str = "1024";

/// Writes the generated tables; the tests that compare them do so when asked.
pub fn tables() -> Result<()> {
    let mut command = shell::cargo();
    command.args(["test", "--quiet", "--workspace", "--test", "command", "docs::"]);
    command.env("UMBRAGE_WRITE_DOCS", "1");
    shell::run(command)
}

/// Renders the pictures of the README into `docs/pictures/`, and those of the library's own
/// documentation.
pub fn pictures() -> Result<()> {
    setup::run(Profile::Release)?;
    let (out, folder) = ("out/docs", Path::new("docs/pictures"));
    let rest = [RAYS, "--size", "320x240", "--frames", "1", "-o", out];
    shell::run(shell::umbrage(Profile::Release, &[&PICTURED[..], &rest].concat()))?;
    let copy = |kind: &str, name: &str| {
        let (from, to) = (format!("{out}/pictures/0-contact-light1-{kind}.png"), folder.join(name));
        fs::copy(&from, &to).with_context(|| format!("can't copy {from} to {}", to.display()))
    };
    copy("reference-color", "truth.png")?;
    for id in ["shadow-map", "pcss", "wedges"] {
        copy(&format!("{id}-color"), &format!("{id}.png"))?;
        copy(&format!("{id}-error"), &format!("{id}-error.png"))?;
    }
    println!("wrote {}", folder.display());
    let mut gallery = shell::cargo();
    gallery.args(["run", "--quiet", "--release", "--package", "umbrage", "--example", "gallery"]);
    shell::run(gallery)?;
    let mut laboratory = shell::cargo();
    laboratory.args(["test", "--package", "umbrage-viewer", "--test", "lab", "technique_truth_and_error"]);
    laboratory.env("UMBRAGE_WRITE_DOCS", "1");
    shell::run(laboratory)
}

/// Compares all techniques on the scene of the README, files the numbers under `benchmarks/`, and
/// writes the tables.
pub fn numbers() -> Result<()> {
    setup::run(Profile::Release)?;
    let rest = ["--samples", RAYS, "--frames", "9", "-o", "out/docs", "--json"];
    let text = shell::output(shell::umbrage(Profile::Release, &[&MEASURED[..], &rest].concat()))?;
    let report: Value = serde_json::from_str(&text).context("`umbrage compare --json` printed no JSON")?;
    let folder = bench::folder(&report["made"]).join("techniques");
    fs::create_dir_all(&folder).with_context(|| format!("can't make {}", folder.display()))?;
    let readme = bench::heading("All techniques", &report["made"], "cargo xtask docs --numbers")
        + "Errors, times and memory of all techniques at their defaults on one small scene: the numbers in the table of the \
           project's README.\nRaw numbers: `report.json`.\n";
    fs::write(folder.join("report.json"), text).context("can't write report.json")?;
    fs::write(folder.join("README.md"), readme).context("can't write README.md")?;
    println!("wrote {}", folder.display());
    tables()
}

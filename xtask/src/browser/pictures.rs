//! A picture with every technique in the browser, against the same one drawn here.

use super::said_by;
use crate::shell;
use anyhow::{Context, Result, bail, ensure};
use base64::{Engine, engine::general_purpose::STANDARD};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::{env, fs};

const PAGE: &str = include_str!("pictures.html");
const TARGET: &str = "wasm32-unknown-unknown";
const EXAMPLE: [&str; 4] = ["--package", "umbrage-renderer", "--example", "pictures"];

/// How much larger a mean error may be than here: another rasteriser moves edges.
const MAE_BEYOND: f64 = 0.001;

/// How much less of the interior may be right than here, per cent: a few pixels of so small a
/// picture.
const INTERIOR_BELOW: f64 = 0.05;

/// A technique's `mae` and `interior_pct`.
pub type Scores = BTreeMap<String, (f64, f64)>;

/// Draws here and in the browser, and fails where the browser's pictures are worse.
pub fn run(browser: &str, folder: &Path) -> Result<()> {
    let mut here = shell::cargo();
    here.args(["run", "--quiet"]).args(EXAMPLE).env("NODEVICE_SELECT", "1");
    let here = scores(shell::output(here)?.lines())?;
    let page = page(folder)?;
    let page = format!("file://{}", page.display());
    let there = scores(said_by(browser, folder, &page)?.iter().map(String::as_str))?;
    compare(&here, &there)
}

/// Fails where a picture of the browser's is worse.
pub fn compare(here: &Scores, there: &Scores) -> Result<()> {
    let mut worse = 0;
    println!("{:<16} {:>9} {:>9} {:>12} {:>12}", "technique", "mae", "there", "interior, %", "there");
    for (id, (mae, interior)) in here {
        let &(mae_there, interior_there) = there.get(id).with_context(|| format!("the browser drew no {id}"))?;
        let is_worse = mae_there > mae + MAE_BEYOND || interior_there < interior - INTERIOR_BELOW;
        worse += usize::from(is_worse);
        let mark = if is_worse { "  worse" } else { "" };
        println!("{id:<16} {mae:>9.5} {mae_there:>9.5} {interior:>12.3} {interior_there:>12.3}{mark}");
    }
    ensure!(worse == 0, "{worse} techniques are worse in the browser");
    println!("{} techniques are as right in the browser", here.len());
    Ok(())
}

/// What the program's lines say.
pub fn scores<'a>(lines: impl Iterator<Item = &'a str>) -> Result<Scores> {
    let mut scores = Scores::new();
    for line in lines.filter(|line| *line != "end") {
        match *line.split(' ').collect::<Vec<_>>() {
            ["picture", id, mae, interior] => scores.insert(id.to_string(), (mae.parse()?, interior.parse()?)),
            _ => bail!("{line}"),
        };
    }
    ensure!(!scores.is_empty(), "no picture was drawn");
    Ok(scores)
}

/// Compiles the program for browsers and puts it into a page.
fn page(folder: &Path) -> Result<PathBuf> {
    let mut target = Command::new("rustup");
    target.args(["target", "add", TARGET]);
    shell::run(target)?;
    let mut build = shell::cargo();
    build.arg("build").args(EXAMPLE).args(["--target", TARGET, "--target-dir", "target/portable"]);
    shell::run(build)?;
    let program = Path::new("target/portable").join(TARGET).join("debug/examples/pictures.wasm");
    let mut bind = Command::new(binder(folder)?);
    bind.args(["--target", "no-modules", "--no-typescript", "--out-name", "pictures", "--out-dir"])
        .arg(folder)
        .arg(program);
    shell::run(bind)?;
    let bytes = fs::read(folder.join("pictures_bg.wasm")).context("there is no compiled program")?;
    let page = folder.join("pictures.html");
    fs::write(&page, PAGE.replace("PROGRAM", &STANDARD.encode(&bytes)))?;
    Ok(page)
}

/// The program that makes a module for browsers: the one that is there, or compiled once in the
/// version that `Cargo.lock` has.
pub fn binder(folder: &Path) -> Result<PathBuf> {
    let version = locked_version("wasm-bindgen")?;
    let said = Command::new("wasm-bindgen").arg("--version").output().ok();
    let is_it = |said: Output| String::from_utf8_lossy(&said.stdout).split_whitespace().nth(1) == Some(&*version);
    if said.is_some_and(is_it) {
        return Ok("wasm-bindgen".into());
    }
    let root = folder.join(format!("wasm-bindgen-{version}"));
    let program = root.join("bin").join(format!("wasm-bindgen{}", env::consts::EXE_SUFFIX));
    if !program.is_file() {
        let mut install = shell::cargo();
        install.args(["install", "wasm-bindgen-cli", "--version", &version, "--profile", "dev", "--root"]).arg(&root);
        shell::run(install)?;
    }
    Ok(program)
}

/// The version of a crate in `Cargo.lock`.
fn locked_version(name: &str) -> Result<String> {
    let lock = fs::read_to_string("Cargo.lock").context("can't read Cargo.lock")?;
    let entry = format!("name = \"{name}\"\nversion = \"");
    let version = lock.split_once(&entry).and_then(|(_, rest)| rest.split_once('"'));
    Ok(version.with_context(|| format!("Cargo.lock has no {name}"))?.0.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_scores_or_errors() {
        let found = scores(["picture pcf 0.00100 99.900", "end"].into_iter()).unwrap();
        assert_eq!(found["pcf"], (0.001, 99.9));
        assert!(scores(["error no adapter"].into_iter()).is_err());
        assert!(scores(["end"].into_iter()).is_err());
    }
}

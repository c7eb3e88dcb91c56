//! Measures the standard set of scenes and files the numbers with date, machine, driver, commit and
//! command.

use crate::{
    setup,
    shell::{self, Profile},
};
use anyhow::{Context, Result};
use serde_json::Value;
use std::{fs, path::PathBuf};

/// Scenes that need no file.
const BUILT_IN: [&str; 4] = ["primitives", "atrium:0.25", "city", "terrain"];
/// Every technique, and the filters that prices are quoted for.
const TECHNIQUES: &str = "all,pcf:kernel=2x2,pcf:kernel=5,pcf:kernel=7";
const FRAMES: &str = "8";
const FRAMES_OF_A_CARD: &str = "64";
const SIZE: &str = "1024x768";

/// Runs the benchmark and writes `benchmarks/<date>-<machine>/`.
pub fn run() -> Result<()> {
    setup::run(Profile::Release)?;
    measure(&[], FRAMES)
}

/// The same on the adapter of this number, with as many frames as a graphics card draws in no time.
pub fn run_on(adapter: u32) -> Result<()> {
    measure(&["--adapter", &adapter.to_string()], FRAMES_OF_A_CARD)
}

fn measure(adapter: &[&str], frames: &str) -> Result<()> {
    let shared = shared_scenes();
    let mut arguments = vec!["bench"];
    arguments.extend(BUILT_IN);
    arguments.extend(shared.iter().map(String::as_str));
    arguments.extend(["--techniques", TECHNIQUES, "--frames", frames, "--size", SIZE, "--json"]);
    arguments.extend(adapter);
    let text = shell::output(shell::umbrage(Profile::Release, &arguments))?;
    let json: Value = serde_json::from_str(&text).context("`umbrage bench --json` printed no JSON")?;

    let made = &json["made"];
    let folder = folder(made);
    fs::create_dir_all(&folder).with_context(|| format!("can't make {}", folder.display()))?;
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        fs::write(&path, text).with_context(|| format!("can't write {}", path.display()))
    };
    write("bench.json", &text)?;
    if !folder.join("README.md").exists() {
        write("README.md", &readme(made, frames))?;
    }
    println!("wrote {}", folder.display());
    Ok(())
}

/// Where the numbers of a run belong: `benchmarks/<date>-<machine>`.
pub fn folder(made: &Value) -> PathBuf {
    PathBuf::from("benchmarks").join(format!("{}-{}", day(made), slug(&word(&made["adapter"]["name"]))))
}

fn day(made: &Value) -> String {
    word(&made["date"]).chars().take(10).collect()
}

fn word(value: &Value) -> String {
    value.as_str().unwrap_or("unknown").to_string()
}

/// The folder of the optional reference data.
pub fn shared() -> PathBuf {
    std::env::var_os("UMBRAGE_SHARED").map_or_else(|| PathBuf::from("../shared"), PathBuf::from)
}

/// Scene files `peer-*.scene.toml` of the optional reference data, where it is there.
fn shared_scenes() -> Vec<String> {
    let root = shared();
    let Ok(entries) = fs::read_dir(root.join("scenes")) else {
        println!("no shared scenes in {}: the built-in ones only", root.display());
        return Vec::new();
    };
    let mut paths: Vec<String> = entries
        .flatten()
        .filter(|e| e.file_name().to_string_lossy().starts_with("peer-"))
        .map(|e| e.path().to_string_lossy().into_owned())
        .collect();
    paths.sort();
    paths
}

fn slug(name: &str) -> String {
    let plain: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { ' ' }).collect();
    plain.split_whitespace().take(4).collect::<Vec<_>>().join("-")
}

fn readme(made: &Value, frames: &str) -> String {
    let text = heading("Benchmark", made, "cargo xtask bench");
    format!(
        "{text}Raw numbers: `bench.json`. Times are medians of {frames} frames at {SIZE}, runs interleaved.\n\n\
         ## What the numbers say\n"
    )
}

/// Title, day and circumstances.
pub fn heading(what: &str, made: &Value, command: &str) -> String {
    let (machine, adapter) = (&made["machine"], &made["adapter"]);
    format!(
        "# {what} of {}\n\n\
         | | |\n|---|---|\n\
         | machine | {}, {} cores, {} |\n\
         | adapter | {} ({}, {}) |\n\
         | driver | {} |\n\
         | commit | {} |\n\
         | command | `{command}` |\n\n",
        day(made),
        word(&machine["cpu"]),
        machine["cores"],
        word(&machine["os"]),
        word(&adapter["name"]),
        word(&adapter["backend"]),
        word(&adapter["kind"]),
        word(&adapter["driver"]),
        word(&made["commit"]),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_name_is_plain() {
        assert_eq!(slug("llvmpipe (LLVM 15.0.6, 256 bits)"), "llvmpipe-llvm-15-0");
    }
}

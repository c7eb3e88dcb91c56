//! Tables of the sources measured again: the same methods on scenes of the same size, with the
//! sources' numbers beside ours.

pub mod fe;
pub mod px;
mod thin;
pub mod za;

use crate::{
    bench, setup,
    shell::{self, Profile},
};
use anyhow::{Context, Result};
use serde_json::Value;
use std::{fs, path::PathBuf};

/// Where scenes of the tables are made.
const SCENES: &str = "target/tables";

/// A run of the command: its arguments as words of a line, and the name of the file for its
/// numbers.
struct Run<'a> {
    file: &'a str,
    line: String,
}

/// Writes files of scenes and gives their paths, in order.
fn make_scenes(files: &[(&str, String)]) -> Result<Vec<String>> {
    fs::create_dir_all(SCENES).with_context(|| format!("can't make {SCENES}"))?;
    let write = |(name, text): &(&str, String)| {
        let path = format!("{SCENES}/{name}");
        fs::write(&path, text).with_context(|| format!("can't write {path}"))?;
        Ok(path)
    };
    files.iter().map(write).collect()
}

/// The Stanford bunny with about `triangles` triangles, as OBJ.
fn bunny(triangles: usize) -> Result<String> {
    let path = bench::shared().join("data/stanford-bunny.obj");
    let missing = || format!("{}: the bunny of the reference data; UMBRAGE_SHARED names its folder", path.display());
    thin::thin(&fs::read_to_string(&path).with_context(missing)?, triangles)
}

/// Runs all of `runs`, files their numbers below `benchmarks/<date>-<machine>/NAME`, and gives them
/// with that folder.
fn measure(name: &str, runs: &[Run<'_>]) -> Result<(PathBuf, Vec<Value>)> {
    setup::run(Profile::Release)?;
    let mut found: Vec<Value> = Vec::new();
    for Run { file, line } in runs {
        let arguments: Vec<&str> = line.split_whitespace().collect();
        let text = shell::output(shell::umbrage(Profile::Release, &arguments))?;
        let json: Value = serde_json::from_str(&text).with_context(|| format!("`umbrage {line}` printed no JSON"))?;
        let folder = bench::folder(&json["made"]).join(name);
        fs::create_dir_all(&folder).with_context(|| format!("can't make {}", folder.display()))?;
        let path = folder.join(file);
        fs::write(&path, text).with_context(|| format!("can't write {}", path.display()))?;
        found.push(json);
    }
    let made = &found.first().context("nothing was measured")?["made"];
    Ok((bench::folder(made).join(name), found))
}

/// Prints `text`, and writes it as the folder's README, or beside one that is there already, since
/// that has been worked on.
fn file(folder: &std::path::Path, text: &str) -> Result<()> {
    let readme = folder.join("README.md");
    let path = if readme.exists() { folder.join("tables.md") } else { readme };
    fs::write(&path, text).with_context(|| format!("can't write {}", path.display()))?;
    println!("{text}\nwrote {}", path.display());
    Ok(())
}

/// The result of `label`, as lists of techniques have it, on the first light of scene number
/// `scene`.
fn result<'a>(json: &'a Value, scene: usize, label: &str) -> Option<&'a Value> {
    let mut words = label.split(':');
    let id = words.next()?;
    let (mut samples, mut settings) = (Value::Null, serde_json::Map::new());
    for (name, value) in words.filter_map(|word| word.split_once('=')) {
        match name {
            "light-samples" => samples = value.parse::<u64>().ok()?.into(),
            _ => drop(settings.insert(name.into(), value.into())),
        }
    }
    let settings = Value::Object(settings);
    let results = json["scenes"][scene]["lights"][0]["results"].as_array()?;
    results.iter().find(|r| r["technique"] == id && r["light_samples"] == samples && r["settings"] == settings)
}

/// Milliseconds of a frame from start to finished picture, median.
fn frame_ms(result: &Value) -> Option<f64> {
    result["cost"]["frame_ms"]["median"].as_f64()
}

/// A row of a table in Markdown.
fn row(cells: impl IntoIterator<Item = String>) -> String {
    format!("| {} |\n", cells.into_iter().collect::<Vec<_>>().join(" | "))
}

/// The first rows of a table in Markdown.
fn head(cells: &[&str]) -> String {
    row(cells.iter().map(|cell| cell.to_string())) + &row(cells.iter().map(|_| "---".to_string()))
}

/// A number with so many digits after the point; a dash where there is none.
fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or("–".into(), |value| format!("{value:.digits$}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn report() -> Value {
        let of = |settings: Value, samples: Value| {
            let cost = json!({"frame_ms": {"median": 9.0}});
            json!({"technique": "pcf", "settings": settings, "light_samples": samples, "cost": cost})
        };
        let results = [of(json!({}), Value::Null), of(json!({"kernel": "7"}), Value::Null), of(json!({}), 16.into())];
        json!({"scenes": [{"lights": [{"results": results}]}]})
    }

    #[test]
    fn results_are_found_by_their_labels() {
        let report = report();
        let settings =
            |label: &str| result(&report, 0, label).map(|r| (r["settings"].clone(), r["light_samples"].clone()));
        assert_eq!(settings("pcf"), Some((json!({}), Value::Null)));
        assert_eq!(result(&report, 0, "pcf").and_then(frame_ms), Some(9.0));
        assert_eq!(settings("pcf:kernel=7"), Some((json!({"kernel": "7"}), Value::Null)));
        assert_eq!(settings("pcf:light-samples=16"), Some((json!({}), 16.into())));
        assert_eq!((settings("pcf:kernel=5"), settings("vsm"), result(&report, 1, "pcf")), (None, None, None));
    }

    #[test]
    fn tables_are_markdown() {
        assert_eq!(head(&["a", "b"]), "| a | b |\n| --- | --- |\n");
        assert_eq!((number(Some(1.256), 2), number(None, 2)), ("1.26".into(), "–".into()));
    }
}

//! A benchmark beside an earlier one.

use crate::bench::columns::label;
use crate::bench::record::{BenchLight, BenchReport, BenchResult};
use crate::table::plain;
use serde_json::Value;

/// The yardsticks of both runs may differ by so much before a note says that machine or load do.
const ALIKE: f64 = 1.15;

/// Why a file is no benchmark.
#[derive(Clone, Debug, thiserror::Error)]
pub enum NoBenchmark {
    /// It is not even JSON.
    #[error("is not JSON: {0}; name a file that `umbrage bench --json` has written")]
    Json(String),
    /// JSON of something else.
    #[error("holds no benchmark; name a file that `umbrage bench --json` has written")]
    Other,
}

/// What took how long in an earlier run.
#[derive(Clone, Debug)]
pub struct Earlier(Value);

/// Milliseconds of a technique: the median and the shortest.
#[derive(Clone, Copy)]
struct Time {
    median: f64,
    min: f64,
}

impl Earlier {
    /// Reads what [`BenchReport::json`] wrote.
    ///
    /// # Errors
    /// [`NoBenchmark`] for anything else.
    pub fn read(text: &str) -> Result<Self, NoBenchmark> {
        let value: Value = serde_json::from_str(text).map_err(|error| NoBenchmark::Json(error.to_string()))?;
        // What `compare` writes has scenes, but no number of frames.
        let is_benchmark = value["scenes"].is_array() && value["frames"].is_u64();
        if is_benchmark { Ok(Self(value)) } else { Err(NoBenchmark::Other) }
    }

    fn result(&self, source: &str, light: Option<usize>, result: &BenchResult) -> Option<&Value> {
        let find = |list: &'_ Value, is_it: &dyn Fn(&Value) -> bool| list.as_array()?.iter().position(is_it);
        let scenes = &self.0["scenes"];
        let lights = &scenes[find(scenes, &|scene| scene["source"] == *source)?]["lights"];
        let results = &lights[find(lights, &|value| value["light"].as_u64() == light.map(|l| l as u64))?]["results"];
        let settings = serde_json::to_value(&result.settings).ok()?;
        let samples = serde_json::to_value(result.light_samples).ok()?;
        let is_it = |value: &Value| {
            value["technique"] == *result.technique && value["settings"] == settings && value["light_samples"] == samples
        };
        results.get(find(results, &is_it)?)
    }

    fn time(&self, source: &str, light: Option<usize>, result: &BenchResult) -> Option<Time> {
        let cost = &self.result(source, light, result)?["cost"];
        let part = |name: &str, what: &str| cost[name][what].as_f64();
        let sum = |what| Some(part("gpu_ms", what)? + part("prepare_ms", what)?);
        Some(Time { median: sum("median")?, min: sum("min")? })
    }
}

impl BenchReport {
    /// A table for each light of each scene that both runs have measured: what a technique adds to
    /// a frame now and then, milliseconds, and the ratios of medians and of shortest times, as they
    /// are and over the ratio of the floors.
    pub fn versus(&self, earlier: &Earlier) -> String {
        let mut text = String::new();
        for scene in &self.scenes {
            for light in &scene.lights {
                let rows = rows(&scene.source, light, earlier);
                if rows.is_empty() {
                    text += &format!("\n{}, {}: the earlier run has nothing of it\n", scene.name, light.title());
                    continue;
                }
                text += &format!("\n{}, {}: this run over the earlier one\n", scene.name, light.title());
                text += &table(&rows);
            }
        }
        text
    }
}

/// Name, and times of this run and of the earlier one.
type Row<'a> = (&'a BenchResult, Time, Time);

fn rows<'a>(source: &str, light: &'a BenchLight, earlier: &Earlier) -> Vec<Row<'a>> {
    let row = |result: &'a BenchResult| {
        let cost = result.cost.as_ref()?;
        let gpu = cost.gpu_ms?;
        let now = Time { median: gpu.median + cost.prepare_ms.median, min: gpu.min + cost.prepare_ms.min };
        Some((result, now, earlier.time(source, light.light, result)?))
    };
    light.results.iter().filter_map(row).collect()
}

fn table(rows: &[Row<'_>]) -> String {
    let ratio = |now: f64, then: f64| (then > 0.0).then_some(now / then);
    let floor = rows.iter().find(|(result, ..)| result.technique == "floor");
    let of_floor = floor.and_then(|(_, now, then)| ratio(now.median, then.median));
    let shown = |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.2}"));
    let mut table = plain(["technique", "ms", "earlier", "ratio", "of shortest", "over the floors'"].into_iter());
    for (result, now, then) in rows {
        let medians = ratio(now.median, then.median);
        table.add_row([
            label(result),
            format!("{:.2}", now.median),
            format!("{:.2}", then.median),
            shown(medians),
            shown(ratio(now.min, then.min)),
            shown(medians.zip(of_floor).map(|(ratio, floor)| ratio / floor)),
        ]);
    }
    let note = match of_floor {
        Some(of_floor) if !(1.0 / ALIKE..ALIKE).contains(&of_floor) => {
            format!("the floor took {of_floor:.2} times as long: the machine or its load is another one\n")
        }
        _ => String::new(),
    };
    format!("{table}\n{note}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::table::tests::report;

    #[test]
    fn a_run_beside_itself_takes_as_long() {
        let report = report();
        let text = report.versus(&Earlier::read(&report.json()).unwrap());
        // Twice 2 ms: on the GPU and for preparing.
        for part in ["light 0 (point)", "shadow-map size=512", "4.00", "1.00"] {
            assert!(text.contains(part), "{part} is missing in\n{text}");
        }
        assert!(!text.contains("pcf"), "what failed has no times:\n{text}");
    }

    #[test]
    fn ratios_are_of_medians_and_of_shortest_times() {
        let report = report();
        let json = report.json().replace("\"median\": 2.0", "\"median\": 4.0").replace("\"min\": 1.0", "\"min\": 0.5");
        let text = report.versus(&Earlier::read(&json).unwrap());
        let row = text.lines().find(|line| line.contains("shadow-map")).unwrap();
        let words: Vec<&str> = row.split_whitespace().collect();
        assert_eq!(words[2..], ["4.00", "8.00", "0.50", "2.00", "-"], "{row}");
    }

    #[test]
    fn other_files_and_other_scenes_are_named() {
        assert!(Earlier::read("no").unwrap_err().to_string().contains("JSON"));
        assert!(Earlier::read("{\"scenes\": []}").unwrap_err().to_string().contains("no benchmark"));
        let mut report = report();
        let earlier = Earlier::read(&report.json()).unwrap();
        report.scenes[0].source = "other".into();
        assert!(report.versus(&earlier).contains("has nothing of it"));
    }
}

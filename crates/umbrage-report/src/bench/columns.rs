//! The columns of a benchmark: declared once for CSV and for the terminal.

use crate::{
    bench::record::{BenchCost, BenchLight, BenchPass, BenchResult, BenchScene},
    measure::is_of_technique,
    round::rounded,
    spread::Spread,
    status::Status,
};

/// What a row shows.
pub(crate) struct Row<'a> {
    pub scene: &'a BenchScene,
    pub light: &'a BenchLight,
    pub result: &'a BenchResult,
}

/// What a row has in a column.
type Field = fn(&Row<'_>) -> String;

/// One column.
pub(crate) struct Column {
    /// Its heading in CSV.
    pub name: &'static str,
    /// What CSV has in it.
    pub field: Field,
    /// Its heading on the terminal and what is below, for columns that are shown there.
    pub shown: Option<(&'static str, Field)>,
}

const fn of(name: &'static str, field: Field) -> Column {
    Column { name, field, shown: None }
}

const fn shown(name: &'static str, field: Field, heading: &'static str, text: Field) -> Column {
    Column { name, field, shown: Some((heading, text)) }
}

/// Of CSV, in its order.
pub(crate) const COLUMNS: [Column; 32] = [
    of("scene", |row| row.scene.source.clone()),
    of("light", |row| row.light.light.map_or(String::new(), |number| number.to_string())),
    of("kind", |row| row.light.kind.into()),
    shown("technique", |row| row.result.technique.clone(), "technique", |row| label(row.result)),
    of("settings", |row| settings(row.result).join(" ")),
    of("status", |row| status(row.result.status).into()),
    of("reason", |row| row.result.reason.clone().unwrap_or_default()),
    shown("frame_ms", |row| spread(row, FRAME, MEDIAN), "frame ms", |row| short(median(row, FRAME))),
    of("frame_ms_min", |row| spread(row, FRAME, MIN)),
    of("frame_ms_max", |row| spread(row, FRAME, MAX)),
    shown("prepare_ms", |row| spread(row, PREPARE, MEDIAN), "prepare ms", |row| short(median(row, PREPARE))),
    of("prepare_ms_min", |row| spread(row, PREPARE, MIN)),
    of("prepare_ms_max", |row| spread(row, PREPARE, MAX)),
    shown("change_ms", |row| spread(row, CHANGE, MEDIAN), "change ms", |row| short(median(row, CHANGE))),
    of("change_ms_min", |row| spread(row, CHANGE, MIN)),
    of("change_ms_max", |row| spread(row, CHANGE, MAX)),
    shown("gpu_ms", |row| spread(row, GPU, MEDIAN), "gpu ms", |row| short(median(row, GPU))),
    of("gpu_ms_min", |row| spread(row, GPU, MIN)),
    of("gpu_ms_max", |row| spread(row, GPU, MAX)),
    shown("passes", all_passes, "passes, ms", passes_shown),
    shown("draws", |row| cost(row, |c| c.draws.to_string()), "draws", |row| cost(row, |c| c.draws.to_string())),
    shown("triangles", triangles, "triangles", triangles),
    shown(
        "bytes",
        |row| cost(row, |c| c.bytes.to_string()),
        "MiB",
        |row| cost(row, |c| format!("{:.2}", c.bytes as f64 / 1_048_576.0)),
    ),
    shown("vs_floor", |row| maybe(row.result.vs_floor), "× floor", |row| short(row.result.vs_floor)),
    shown(
        "vs_bare_minimum",
        |row| maybe(row.result.vs_bare_minimum),
        "× bare",
        |row| short(row.result.vs_bare_minimum),
    ),
    shown(
        "flicker",
        |row| maybe(row.result.flicker),
        "flicker",
        |row| row.result.flicker.map_or("–".into(), |v| format!("{v:.5}")),
    ),
    shown("flicker_ratio", |row| maybe(row.result.flicker_ratio), "× truth", |row| short(row.result.flicker_ratio)),
    shown(
        "change_error",
        |row| maybe(row.result.change_error),
        "change error",
        |row| row.result.change_error.map_or("–".into(), |v| format!("{v:.5}")),
    ),
    shown("fragments", fragments, "fragments", fragments),
    shown("bytes_moved", |row| moved(row).map_or(String::new(), |bytes| bytes.to_string()), "MB moved", moved_shown),
    of("traffic", traffic),
    of("counts", |row| {
        let counts = row.result.cost.iter().flat_map(|c| &c.counts).map(|(name, count)| format!("{name}={count}"));
        counts.collect::<Vec<_>>().join(";")
    }),
];

/// Those of the terminal by their names in CSV, in the order in which they are shown there.
pub(crate) const SHOWN: [&str; 10] = [
    "technique",
    "frame_ms",
    "prepare_ms",
    "gpu_ms",
    "vs_floor",
    "vs_bare_minimum",
    "passes",
    "draws",
    "triangles",
    "bytes",
];

/// More of them, where the camera or the light was on a path.
pub(crate) const SHOWN_ON_PATH: [&str; 3] = ["flicker", "flicker_ratio", "change_error"];

/// More of them, where fragments were counted.
pub(crate) const SHOWN_WITH_BYTES: [&str; 2] = ["fragments", "bytes_moved"];

/// One more, where instances came and went.
pub(crate) const SHOWN_WITH_CHURN: [&str; 1] = ["change_ms"];

/// Id and settings of a result, as one would ask for it.
pub(crate) fn label(result: &BenchResult) -> String {
    std::iter::once(result.technique.clone()).chain(settings(result)).collect::<Vec<_>>().join(" ")
}

fn settings(result: &BenchResult) -> Vec<String> {
    let set = result.settings.iter().map(|(k, v)| format!("{k}={v}"));
    set.chain(result.light_samples.map(|n| format!("light-samples={n}"))).collect()
}

fn status(status: Status) -> &'static str {
    match status {
        Status::Ok => "ok",
        Status::Unsupported => "unsupported",
        Status::Failed => "failed",
    }
}

/// Which time of a cost.
type Time = fn(&BenchCost) -> Option<Spread>;
const FRAME: Time = |cost| Some(cost.frame_ms);
const PREPARE: Time = |cost| Some(cost.prepare_ms);
const CHANGE: Time = |cost| cost.change_ms;
const GPU: Time = |cost| cost.gpu_ms;

/// Which number of a spread.
type Of = fn(&Spread) -> f64;
const MEDIAN: Of = |spread| spread.median;
const MIN: Of = |spread| spread.min;
const MAX: Of = |spread| spread.max;

fn spread(row: &Row<'_>, time: Time, of: Of) -> String {
    maybe(row.result.cost.as_ref().and_then(time).map(|spread| of(&spread)))
}

fn median(row: &Row<'_>, time: Time) -> Option<f64> {
    row.result.cost.as_ref().and_then(time).map(|spread| spread.median)
}

fn cost(row: &Row<'_>, text: fn(&BenchCost) -> String) -> String {
    row.result.cost.as_ref().map(text).unwrap_or_default()
}

fn triangles(row: &Row<'_>) -> String {
    cost(row, |cost| cost.triangles.to_string())
}

fn fragments(row: &Row<'_>) -> String {
    let moved = row.result.cost.as_ref().and_then(BenchCost::moved);
    moved.map_or(String::new(), |(fragments, _)| fragments.to_string())
}

fn moved(row: &Row<'_>) -> Option<u64> {
    row.result.cost.as_ref()?.moved()?.1
}

fn moved_shown(row: &Row<'_>) -> String {
    moved(row).map_or("–".into(), |bytes| format!("{:.2}", bytes as f64 * 1e-6))
}

/// Fragments and bytes of each pass.
fn traffic(row: &Row<'_>) -> String {
    let passes = row.result.cost.iter().flat_map(|cost| cost.traffic.iter().flatten());
    let bytes = |bytes: Option<u64>| bytes.map_or("?".into(), |bytes| bytes.to_string());
    passes.map(|p| format!("{}={}:{}", p.pass, p.fragments, bytes(p.bytes))).collect::<Vec<_>>().join(";")
}

fn all_passes(row: &Row<'_>) -> String {
    let text = |p: &BenchPass| format!("{}/{}={}", p.owner, p.pass, number(p.time_ms.median));
    row.result.cost.iter().flat_map(|cost| &cost.passes).map(text).collect::<Vec<_>>().join(";")
}

/// The floor shows what the renderer itself takes: its G-buffer and shading.
fn passes_shown(row: &Row<'_>) -> String {
    let is_shown = |p: &&BenchPass| is_of_technique(p.owner) || row.result.technique == "floor";
    let passes = row.result.cost.iter().flat_map(|cost| &cost.passes).filter(is_shown);
    passes.map(|p| format!("{} {:.2}", p.pass, p.time_ms.median)).collect::<Vec<_>>().join(", ")
}

fn maybe(value: Option<f64>) -> String {
    value.map(number).unwrap_or_default()
}

fn number(value: f64) -> String {
    if value.is_finite() { rounded(value).to_string() } else { String::new() }
}

fn short(value: Option<f64>) -> String {
    value.map_or("–".into(), |v| format!("{v:.2}"))
}

//! Benchmark results as JSON, as CSV and on a terminal.

use crate::{
    bench::{BenchPass, BenchReport, BenchResult},
    measure::is_of_technique,
    motion::Moving,
    record::Status,
    round::rounded,
    spread::Spread,
    table::plain,
};
use comfy_table::{Cell, Table};

const CSV_HEAD: &str = "scene,light,kind,technique,settings,status,reason,frame_ms,frame_ms_min,frame_ms_max,prepare_ms,\
     prepare_ms_min,prepare_ms_max,gpu_ms,gpu_ms_min,gpu_ms_max,passes,draws,triangles,bytes,vs_floor,vs_bare_minimum,\
     flicker,flicker_ratio,counts";

impl BenchReport {
    /// Indented JSON.
    pub fn json(&self) -> String {
        crate::json(self)
    }

    /// One line a technique and light, with a heading (RFC 4180).
    pub fn csv(&self) -> String {
        let mut text = format!("{CSV_HEAD}\n");
        for scene in &self.scenes {
            for light in &scene.lights {
                for result in &light.results {
                    let number = light.light.map_or(String::new(), |number| number.to_string());
                    let place = [scene.source.clone(), number, light.kind.to_string()];
                    let fields: Vec<String> = place.into_iter().chain(csv_fields(result)).map(|f| quoted(&f)).collect();
                    text += &fields.join(",");
                    text.push('\n');
                }
            }
        }
        text
    }

    /// A table for each light of each scene.
    pub fn tables(&self) -> String {
        let mut text = String::new();
        let moving = match (self.path, self.moving) {
            (Some(path), _) => format!("the camera, path {}", path.name()),
            (None, Moving::None) => "nothing, all drawn anew".into(),
            (None, Moving::Still) => "nothing".into(),
            (None, moving) => moving.name().into(),
        };
        for scene in &self.scenes {
            for light in &scene.lights {
                let (title, size) = (light.title(), format!("{}×{}", self.width, self.height));
                text += &format!(
                    "\n{}, {title}, {size}, {} triangles; medians of {} frames; moving: {moving}\n",
                    scene.name, scene.triangles, self.frames
                );
                text += &table(&light.results, self.path.is_some()).to_string();
                text += "\n";
                text += &light.flicker_reference.map_or(String::new(), |flicker| {
                    let points = light.flicker_points.unwrap_or_default();
                    format!("flicker of the ray-traced reference: {flicker:.5}, mean of {points} changes\n")
                });
            }
        }
        text += "\n× floor, × bare: GPU and preparation time over that of one full-screen pass, and over that of plain maps of \
                 the same size and number with a one-tap look-up.\n";
        if self.path.is_some() {
            text += "flicker: mean change of visibility from frame to frame at fixed points of the scene; × truth: over that of \
                     the reference.\n";
        }
        text
    }
}

fn label(result: &BenchResult) -> String {
    let set = result.settings.iter().map(|(k, v)| format!(" {k}={v}"));
    let samples = result.light_samples.map(|n| format!(" light-samples={n}"));
    std::iter::once(result.technique.clone()).chain(set).chain(samples).collect()
}

fn csv_fields(result: &BenchResult) -> Vec<String> {
    let status = match result.status {
        Status::Ok => "ok",
        Status::Unsupported => "unsupported",
        Status::Failed => "failed",
    };
    let settings = label(result).split(' ').skip(1).collect::<Vec<_>>().join(" ");
    let mut fields = vec![result.technique.clone(), settings, status.into(), result.reason.clone().unwrap_or_default()];
    let spread = |s: Option<Spread>| s.map_or([const { String::new() }; 3], |s| [s.median, s.min, s.max].map(number));
    let cost = result.cost.as_ref();
    fields.extend(spread(cost.map(|c| c.frame_ms)));
    fields.extend(spread(cost.map(|c| c.prepare_ms)));
    fields.extend(spread(cost.and_then(|c| c.gpu_ms)));
    let passes = cost.map(|c| c.passes.iter().map(|p| format!("{}/{}={}", p.owner, p.pass, number(p.time_ms.median))));
    fields.push(passes.map_or(String::new(), |p| p.collect::<Vec<_>>().join(";")));
    fields.extend(
        cost.map_or([const { String::new() }; 3], |c| {
            [c.draws.to_string(), c.triangles.to_string(), c.bytes.to_string()]
        }),
    );
    let ratios = [result.vs_floor, result.vs_bare_minimum, result.flicker, result.flicker_ratio];
    fields.extend(ratios.map(|v| v.map(number).unwrap_or_default()));
    let counts = cost.iter().flat_map(|c| &c.counts).map(|(name, count)| format!("{name}={count}"));
    fields.push(counts.collect::<Vec<_>>().join(";"));
    fields
}

fn number(value: f64) -> String {
    if value.is_finite() { rounded(value).to_string() } else { String::new() }
}

fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) { format!("\"{}\"", field.replace('"', "\"\"")) } else { field.into() }
}

fn table(results: &[BenchResult], on_path: bool) -> Table {
    let flicker: &[&str] = if on_path { &["flicker", "× truth"] } else { &[] };
    let heading = [
        "technique",
        "frame ms",
        "prepare ms",
        "gpu ms",
        "× floor",
        "× bare",
        "passes, ms",
        "draws",
        "triangles",
        "MiB",
    ];
    let mut table = plain(heading.into_iter().chain(flicker.iter().copied()));
    for result in results {
        let mut row = vec![Cell::new(label(result))];
        match &result.cost {
            Some(cost) => {
                let ms = |v: f64| format!("{v:.2}");
                let maybe = |v: Option<f64>| v.map_or("–".into(), ms);
                // The floor shows what the renderer itself takes: its G-buffer and shading.
                let is_shown = |p: &&BenchPass| is_of_technique(p.owner) || result.technique == "floor";
                let passes = cost.passes.iter().filter(is_shown).map(|p| format!("{} {:.2}", p.pass, p.time_ms.median));
                let cells = [
                    ms(cost.frame_ms.median),
                    ms(cost.prepare_ms.median),
                    maybe(cost.gpu_ms.map(|s| s.median)),
                    maybe(result.vs_floor),
                    maybe(result.vs_bare_minimum),
                    passes.collect::<Vec<_>>().join(", "),
                    cost.draws.to_string(),
                    cost.triangles.to_string(),
                    ms(cost.bytes as f64 / 1_048_576.0),
                ];
                row.extend(cells.map(Cell::new));
                if on_path {
                    let flicker = result.flicker.map_or("–".into(), |v| format!("{v:.5}"));
                    row.extend([flicker, maybe(result.flicker_ratio)].map(Cell::new));
                }
            }
            None => row.push(Cell::new(result.reason.as_deref().unwrap_or_default())),
        }
        table.add_row(row);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        bench::{BenchCost, BenchLight, BenchScene},
        made::Made,
        path::CameraPath,
        record::{SCHEMA, fixture},
    };
    use std::collections::BTreeMap;
    use umbrage::Owner;

    fn report() -> BenchReport {
        let spread = Spread { median: 2.0, min: 1.0, max: 1.0 / 3.0 };
        let cost = BenchCost {
            passes: vec![BenchPass { owner: Owner::Light(0), pass: "map".into(), time_ms: spread }],
            gpu_ms: Some(spread),
            prepare_ms: spread,
            frame_ms: spread,
            draws: 3,
            triangles: 500,
            bytes: 1 << 20,
            counts: vec![("edges", 7), ("caps", 2)],
        };
        let result = |technique: &str, cost: Option<BenchCost>, reason: Option<&str>| BenchResult {
            technique: technique.into(),
            settings: BTreeMap::from([("size".into(), "512".into())]),
            light_samples: None,
            status: if cost.is_some() { Status::Ok } else { Status::Failed },
            reason: reason.map(String::from),
            cost,
            vs_floor: None,
            vs_bare_minimum: Some(1.25),
            flicker: Some(0.0021),
            flicker_ratio: Some(3.5),
        };
        let made: Made = fixture().made;
        let results = vec![result("shadow-map", Some(cost), None), result("pcf", None, Some("lost, \"gone\""))];
        let (flicker_reference, flicker_points) = (Some(0.0006), Some(1234));
        let light =
            BenchLight { light: Some(0), kind: "point", together: None, flicker_reference, flicker_points, results };
        let scene =
            BenchScene { name: "a".into(), source: "a,b.obj".into(), triangles: 9, instances: 1, lights: vec![light] };
        let (moving, path) = (Moving::All, None);
        BenchReport { schema: SCHEMA, made, width: 8, height: 6, frames: 5, moving, path, scenes: vec![scene] }
    }

    #[test]
    fn csv_rows_have_as_many_fields_as_the_heading_and_quote_what_needs_it() {
        let csv = report().csv();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines.len(), 3);
        // The first field has a comma of its own.
        assert_eq!(lines[1].split(',').count(), lines[0].split(',').count() + 1, "{csv}");
        assert!(lines[1].starts_with("\"a,b.obj\",0,point,shadow-map,size=512,ok,,2,1,0.333333,"), "{csv}");
        assert!(lines[1].ends_with(",1.25,0.0021,3.5,edges=7;caps=2"), "{csv}");
        assert!(lines[2].contains("\"lost, \"\"gone\"\"\""), "{csv}");
    }

    #[test]
    fn the_table_names_passes_and_failures() {
        let text = report().tables();
        for part in ["light 0 (point)", "moving: all", "shadow-map size=512", "map 2.00", "1.25", "lost, \"gone\""] {
            assert!(text.contains(part), "{part} is missing in\n{text}");
        }
    }

    #[test]
    fn flicker_has_columns_where_the_camera_was_on_a_path() {
        assert!(!report().tables().contains("× truth"));
        let text = BenchReport { moving: Moving::None, path: Some(CameraPath::Strafe), ..report() }.tables();
        for part in ["moving: the camera, path strafe", "× truth", "0.00210", "3.50", "0.00060, mean of 1234 changes"]
        {
            assert!(text.contains(part), "{part} is missing in\n{text}");
        }
    }
}

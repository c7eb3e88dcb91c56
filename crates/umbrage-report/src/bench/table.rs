//! Benchmark results on a terminal.

use crate::{
    bench::{
        columns::{COLUMNS, Column, Row, SHOWN, SHOWN_ON_PATH, SHOWN_WITH_BYTES, SHOWN_WITH_CHURN},
        record::{BenchLight, BenchReport, BenchScene},
    },
    motion::Moving,
    table::plain,
    way::Way,
};
use comfy_table::{Cell, Table};

impl BenchReport {
    /// Indented JSON.
    pub fn json(&self) -> String {
        crate::json(self)
    }

    /// A table for each light of each scene.
    pub fn tables(&self) -> String {
        let mut text = String::new();
        let moving = match (self.path, self.moving) {
            (Some(Way::Camera(path)), _) => format!("the camera, path {}", path.name()),
            (Some(way), _) => format!("the light, path {}", way.name()),
            (None, Moving::None) => "nothing, all drawn anew".into(),
            (None, Moving::Still) => "nothing".into(),
            (None, moving) => moving.name().into(),
        };
        let churn = match self.churn {
            0 => String::new(),
            count => format!("; {count} instances come and go in every frame"),
        };
        for scene in &self.scenes {
            for light in &scene.lights {
                let (title, size) = (light.title(), format!("{}×{}", self.width, self.height));
                text += &format!(
                    "\n{}, {title}, {size}, {} triangles; medians of {} frames; moving: {moving}{churn}\n",
                    scene.name, scene.triangles, self.frames
                );
                text += &table(scene, light, self.path.is_some()).to_string();
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
                     the reference; change error: how far changes are off those of the reference.\n";
        }
        text
    }
}

/// A row a technique; what has no numbers says why.
fn table(scene: &BenchScene, light: &BenchLight, on_path: bool) -> Table {
    let is_counted = light.results.iter().flat_map(|result| &result.cost).any(|cost| cost.traffic.is_some());
    let churns = light.results.iter().flat_map(|result| &result.cost).any(|cost| cost.change_ms.is_some());
    let more = [(on_path, &SHOWN_ON_PATH[..]), (is_counted, &SHOWN_WITH_BYTES), (churns, &SHOWN_WITH_CHURN)];
    let more = more.into_iter().filter(|(is_there, _)| *is_there).flat_map(|(_, names)| names);
    let named = |name: &&str| COLUMNS.iter().find(|column| column.name == *name);
    let columns: Vec<_> =
        SHOWN.iter().chain(more).filter_map(named).filter_map(|column: &Column| column.shown).collect();
    let mut table = plain(columns.iter().map(|(heading, _)| *heading));
    for result in &light.results {
        let row = Row { scene, light, result };
        let mut cells = columns.iter().map(|(_, text)| Cell::new(text(&row)));
        table.add_row(match result.cost {
            Some(_) => cells.collect::<Vec<_>>(),
            None => cells.next().into_iter().chain([Cell::new(result.reason.as_deref().unwrap_or_default())]).collect(),
        });
    }
    table
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::{
        bench::record::{BenchCost, BenchPass, BenchResult},
        fixture::fixture,
        made::Made,
        path::CameraPath,
        record::{SCHEMA, Status},
        spread::Spread,
    };
    use std::collections::BTreeMap;
    use umbrage::Owner;

    pub fn report() -> BenchReport {
        let spread = Spread { median: 2.0, min: 1.0, max: 1.0 / 3.0 };
        let cost = BenchCost {
            passes: vec![BenchPass { owner: Owner::Light(0), pass: "map".into(), time_ms: spread }],
            gpu_ms: Some(spread),
            prepare_ms: spread,
            change_ms: None,
            frame_ms: spread,
            draws: 3,
            triangles: 500,
            bytes: 1 << 20,
            traffic: None,
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
            change_error: Some(0.0017),
        };
        let made: Made = fixture().made;
        let results = vec![result("shadow-map", Some(cost), None), result("pcf", None, Some("lost, \"gone\""))];
        let (flicker_reference, flicker_points) = (Some(0.0006), Some(1234));
        let light =
            BenchLight { light: Some(0), kind: "point", together: None, flicker_reference, flicker_points, results };
        let scene =
            BenchScene { name: "a".into(), source: "a,b.obj".into(), triangles: 9, instances: 1, lights: vec![light] };
        let (moving, path) = (Moving::All, None);
        BenchReport {
            schema: SCHEMA,
            made,
            width: 8,
            height: 6,
            frames: 5,
            moving,
            path,
            churn: 0,
            scenes: vec![scene],
        }
    }

    #[test]
    fn csv_rows_have_as_many_fields_as_the_heading_and_quote_what_needs_it() {
        let csv = report().csv();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines.len(), 3);
        // The first field has a comma of its own.
        assert_eq!(lines[1].split(',').count(), lines[0].split(',').count() + 1, "{csv}");
        assert!(lines[1].starts_with("\"a,b.obj\",0,point,shadow-map,size=512,ok,,2,1,0.333333,"), "{csv}");
        assert!(lines[1].ends_with(",1.25,0.0021,3.5,0.0017,,,,edges=7;caps=2"), "{csv}");
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
    fn every_column_of_the_terminal_is_declared() {
        for name in SHOWN.iter().chain(&SHOWN_ON_PATH).chain(&SHOWN_WITH_BYTES).chain(&SHOWN_WITH_CHURN) {
            let column = COLUMNS.iter().find(|column| column.name == *name);
            assert!(column.is_some_and(|column| column.shown.is_some()), "{name}");
        }
    }

    #[test]
    fn flicker_has_columns_where_the_camera_was_on_a_path() {
        assert!(!report().tables().contains("× truth"));
        let text = BenchReport { moving: Moving::None, path: Some(Way::Camera(CameraPath::Strafe)), ..report() }.tables();
        let parts = ["moving: the camera, path strafe", "× truth", "0.00210", "3.50", "0.00170", "0.00060, mean of 1234 changes"];
        for part in parts {
            assert!(text.contains(part), "{part} is missing in\n{text}");
        }
    }
}

//! Benchmark results as CSV.

use crate::bench::{
    columns::{COLUMNS, Row},
    record::BenchReport,
};

impl BenchReport {
    /// One line a technique and light, with a heading (RFC 4180).
    pub fn csv(&self) -> String {
        let mut text = line(COLUMNS.iter().map(|column| column.name.into()));
        for scene in &self.scenes {
            for light in &scene.lights {
                for result in &light.results {
                    let row = Row { scene, light, result };
                    text += &line(COLUMNS.iter().map(|column| (column.field)(&row)));
                }
            }
        }
        text
    }
}

fn line(fields: impl Iterator<Item = String>) -> String {
    fields.map(|field| quoted(&field)).collect::<Vec<_>>().join(",") + "\n"
}

fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) { format!("\"{}\"", field.replace('"', "\"\"")) } else { field.into() }
}

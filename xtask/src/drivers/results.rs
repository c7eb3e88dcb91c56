//! What a driver gave, and what of it is worse than elsewhere.

use serde_json::Value;
use std::collections::BTreeMap;

/// How much less of the interior may be right than on the first driver, per cent.
const TOLERANCE: f64 = 0.05;

/// Scene, light, and technique.
type Cell = (String, u64, String);

/// What a driver gave.
pub struct Results {
    pub name: String,
    pub adapter: String,
    /// The share of the interior that is right, per cent; or why there is none.
    pub cells: BTreeMap<Cell, Result<f64, String>>,
    pub seconds: f64,
    /// Tests on the device that failed; `None` where they were not run.
    pub failed_tests: Option<Vec<String>>,
}

/// The results in a report.
pub fn cells(report: &Value) -> BTreeMap<Cell, Result<f64, String>> {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let name = |value: &Value| value.as_str().unwrap_or("?").to_string();
    let mut cells = BTreeMap::new();
    for scene in list(&report["scenes"]) {
        for light in list(&scene["lights"]) {
            for result in list(&light["results"]).iter().filter(|result| result["status"] != "unsupported") {
                let interior = result["scores"]["interior_pct"].as_f64();
                let value = interior.ok_or_else(|| format!("{} {}", name(&result["status"]), name(&result["reason"])));
                let cell = (name(&scene["source"]), light["light"].as_u64().unwrap_or(0), name(&result["technique"]));
                cells.insert(cell, value);
            }
        }
    }
    cells
}

impl Results {
    /// Prints what is worse here than there, and returns how much that is.
    pub fn show_against(&self, first: &Self) -> usize {
        println!("\n{} ({}) against {} ({}):", self.name, self.adapter, first.name, first.adapter);
        let failed = self.failed_tests.iter().flatten();
        let tests = failed.map(|test| println!("  the test {test} fails")).count();
        let (mut wrong, mut largest) = (0, 0.0_f64);
        for (cell, expected) in &first.cells {
            if let (Ok(expected), Some(Ok(value))) = (expected, self.cells.get(cell)) {
                largest = largest.max(expected - value);
            }
            if let Some(text) = worse(expected, self.cells.get(cell), &first.name) {
                wrong += 1;
                println!("  {} light {}: {}: {text}", cell.0, cell.1, cell.2);
            }
        }
        let cells = first.cells.len();
        println!("  {cells} cells, {wrong} worse; the largest difference is {largest:.3} points of the interior");
        wrong + tests
    }

    /// One row of the table of all drivers.
    pub fn row(&self) -> String {
        let failed = self.cells.values().filter(|value| value.is_err()).count();
        let tests = match &self.failed_tests {
            None => "-".into(),
            Some(failed) => failed.len().to_string(),
        };
        format!(
            "{:<12} {:<44} {:>5} {failed:>6} {tests:>12} {:>7.0}",
            self.name,
            self.adapter,
            self.cells.len(),
            self.seconds
        )
    }
}

/// The heading of [`Results::row`].
pub fn heading() -> String {
    format!("{:<12} {:<44} {:>5} {:>6} {:>12} {:>7}", "driver", "adapter", "cells", "failed", "failed tests", "seconds")
}

/// What is worse in a cell than on the first driver.
fn worse(expected: &Result<f64, String>, here: Option<&Result<f64, String>>, first: &str) -> Option<String> {
    match (expected, here) {
        (_, None) => Some("missing".into()),
        (Ok(expected), Some(Ok(value))) if expected - value <= TOLERANCE => None,
        (Ok(expected), Some(Ok(value))) => {
            Some(format!("{value:.2} % of the interior is right, there {expected:.2} %"))
        }
        (Ok(_), Some(Err(reason))) => Some(reason.clone()),
        (Err(reason), Some(Ok(_))) => Some(format!("failed on {first}: {reason}")),
        (Err(_), Some(Err(reason))) => Some(format!("failed on {first}, too: {reason}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_is_worse_by_more_than_the_tolerance_or_where_it_fails() {
        let none = None;
        let (good, failed) = (Ok(99.9), Err("failed".to_string()));
        assert!(worse(&good, Some(&Ok(99.86)), "a").is_none());
        assert!(worse(&good, Some(&Ok(100.0)), "a").is_none());
        assert!(worse(&good, Some(&Ok(99.8)), "a").is_some());
        assert!(worse(&good, Some(&failed), "a").is_some());
        assert!(worse(&good, none, "a").is_some());
        assert!(worse(&failed, Some(&good), "a").is_some());
    }
}

//! The report on a terminal.

use crate::{
    column::{COLUMNS, Column, RADIANCE_COLUMNS},
    record::{LightRecord, Report, ResultRecord, Status},
};
use comfy_table::{
    Attribute, Cell, CellAlignment, ColumnConstraint, ContentArrangement, LineStyle, Table, Width, presets::NOTHING,
};
use serde_json::Value;

/// A table for each light of each scene; the best number of a column is bold.
pub fn tables(report: &Report) -> String {
    let mut text = String::new();
    for scene in &report.scenes {
        for light in &scene.lights {
            let kind = if light.soft { "soft" } else { "hard" };
            text += &format!(
                "\n{}, light {} ({}, {kind}), {}×{}; reference: {}{}\n",
                scene.name,
                light.light,
                light.kind,
                scene.width,
                scene.height,
                light.reference.source,
                light.reference.standard_error.map_or(String::new(), |error| format!(" (± {error:.5})")),
            );
            text += &light_table(light).to_string();
            text += "\n";
            for result in light.results.iter().filter(|r| r.status == Status::Failed) {
                text += &format!("{}: {}\n", title(result), result.reason.as_deref().unwrap_or("failed"));
            }
        }
    }
    text
}

/// Id and settings of a result, as one would ask for it.
pub(crate) fn title(result: &ResultRecord) -> String {
    let set = result.settings.iter().map(|(k, v)| format!(" {k}={v}"));
    let samples = result.light_samples.map(|n| format!(" light-samples={n}"));
    std::iter::once(result.technique.clone()).chain(set).chain(samples).collect()
}

fn light_table(light: &LightRecord) -> Table {
    let values: Vec<Value> = light.results.iter().map(|r| serde_json::to_value(r).unwrap_or_default()).collect();
    let says_something = |column: &Column| values.iter().any(|v| column.value(v).is_some());
    let columns: Vec<Column> =
        COLUMNS.into_iter().chain(RADIANCE_COLUMNS).filter(|c| c.brief && says_something(c)).collect();
    let best: Vec<Option<f64>> = columns.iter().map(|c| best(c, &values)).collect();
    let mut table = plain(std::iter::once("technique").chain(columns.iter().map(|c| c.name)));
    for (result, value) in light.results.iter().zip(&values) {
        let mut row = vec![Cell::new(title(result))];
        match result.status {
            Status::Ok => row.extend(columns.iter().zip(&best).map(|(c, best)| {
                let cell = Cell::new(c.text(value));
                if best.is_some() && c.value(value) == *best { cell.add_attribute(Attribute::Bold) } else { cell }
            })),
            Status::Unsupported => row.push(Cell::new(result.reason.as_deref().unwrap_or_default())),
            Status::Failed => row.push(Cell::new("failed, see below")),
        }
        table.add_row(row);
    }
    table
}

/// An empty table with a line under its heading; all columns but the first are aligned to the
/// right.
pub(crate) fn plain<'a>(heading: impl Iterator<Item = &'a str>) -> Table {
    let words: Vec<&str> = heading.collect();
    let mut table = Table::new();
    let style = NOTHING.header_separator(LineStyle::none().fill('─').junction('─'));
    table.load_style(style).set_content_arrangement(ContentArrangement::Dynamic).set_header(&words);
    let longest: Vec<u16> = words.iter().map(|heading| longest_word(heading)).collect();
    for (number, (column, longest)) in table.column_iter_mut().zip(longest).enumerate() {
        // On a narrow terminal columns may break between words, but not within.
        column.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(longest + PADDING)));
        if number > 0 {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

/// Spaces around the text of a column.
const PADDING: u16 = 2;

fn longest_word(heading: &str) -> u16 {
    heading.split_whitespace().map(|word| word.chars().count() as u16).max().unwrap_or(0)
}

/// The best value of a column; `None` where there is no contest.
fn best(column: &Column, results: &[Value]) -> Option<f64> {
    let values: Vec<f64> = results.iter().filter_map(|r| column.value(r)).collect();
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
    let better = column.better.filter(|_| low < high)?;
    Some(if better == "more" { high } else { low })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::fixture;

    #[test]
    fn headings_of_narrow_tables_break_between_words() {
        let mut table = plain(["technique", "mae", "visibility error", "interior"].into_iter());
        table.add_row(["shadow-map size=512", "0.0123", "98.50", "not for line lights"]).set_width(40);
        let text = table.to_string();
        for word in ["technique", "mae", "visibility", "error", "interior"] {
            assert!(text.contains(word), "{word} is broken in\n{text}");
        }
    }

    #[test]
    fn every_result_is_in_the_table_or_below_it() {
        let text = tables(&fixture());
        for part in [
            "boxes, light 0 (line, soft)",
            "shadow-map size=512",
            "0.0123",
            "98.50",
            "(± 0.00050)",
            "speckles",
            "0.0125",
            "not for line lights",
            "volume size=512: the graphics device was lost",
            "4.00",
        ] {
            assert!(text.contains(part), "{part} is missing in\n{text}");
        }
    }
}

//! The two answers on a terminal.

use crate::{
    record::Status,
    sweep::{
        answer::{Answer, Best},
        axis::short,
        measures::{MEASURES, Measure},
        record::{SweepLight, SweepReport},
    },
    table::plain,
};
use comfy_table::{Attribute, Cell, Table};

/// Two tables for each light of each scene, by the first measure.
pub(crate) fn tables(report: &SweepReport) -> String {
    let measure = &MEASURES[0];
    let mut text = String::new();
    for scene in &report.scenes {
        for light in &scene.lights {
            text += &format!(
                "\n{}, light {} ({}), {}×{}; settings: {}; reference: {}\n",
                scene.name,
                light.light,
                light.kind,
                scene.width,
                scene.height,
                light.results.len(),
                light.reference.source
            );
            if let Some(answer) = light.answer(measure) {
                text += &format!("\nLeast {} within a budget\n{}\n", measure.name, budgets(light, measure, answer));
                text +=
                    &format!("\nLeast milliseconds over the floor at {}\n{}\n", measure.name, levels(light, answer));
            }
            for skipped in &light.skipped {
                text += &format!("skipped: {}, {}\n", skipped.technique, skipped.reason);
            }
            for result in light.results.iter().filter(|r| r.status == Status::Failed) {
                text += &format!("{}: {}\n", result.name(), result.reason.as_deref().unwrap_or("failed"));
            }
        }
    }
    text
}

fn budgets(light: &SweepLight, measure: &Measure, answer: &Answer) -> Table {
    let ms = |ms: Option<f64>| ms.map_or("unknown".into(), |ms| format!("{} ms", short(ms)));
    let heads = answer.budgets.iter().map(|b| format!("{} × bare = {}", short(b.bare_minimums), ms(b.over_floor_ms)));
    let value = |number: usize| light.results[number].point(number, measure).map(|p| p.error);
    table(light, heads, &answer.budgets.iter().map(|b| &*b.best).collect::<Vec<_>>(), &value)
}

fn levels(light: &SweepLight, answer: &Answer) -> Table {
    let heads = answer.levels.iter().map(|level| format!("≤ {}", short(level.error)));
    let value = |number: usize| light.results[number].over_floor_ms;
    table(light, heads, &answer.levels.iter().map(|level| &*level.best).collect::<Vec<_>>(), &value)
}

/// A row a technique, a column a question; the least of a column is bold.
fn table(
    light: &SweepLight,
    heads: impl Iterator<Item = String>,
    columns: &[&[Best]],
    value: &dyn Fn(usize) -> Option<f64>,
) -> Table {
    let heads: Vec<String> = std::iter::once("technique".to_string()).chain(heads).collect();
    let mut table = plain(heads.iter().map(String::as_str));
    let least = |column: &[Best]| column.iter().filter_map(|b| value(b.result?)).min_by(f64::total_cmp);
    let least: Vec<Option<f64>> = columns.iter().map(|column| least(column)).collect();
    for (row, first) in columns.first().copied().unwrap_or_default().iter().enumerate() {
        let mut cells = vec![Cell::new(&first.technique)];
        cells.extend(columns.iter().zip(&least).map(|(column, least)| {
            let Some((number, found)) = column[row].result.and_then(|n| Some((n, value(n)?))) else {
                return Cell::new("–");
            };
            let set = light.results[number].set().join(" ");
            let cell = Cell::new(if set.is_empty() { short(found) } else { format!("{} ({set})", short(found)) });
            if Some(found) == *least { cell.add_attribute(Attribute::Bold) } else { cell }
        }));
        table.add_row(cells);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::fixture::fixture;

    /// The cells of the row of a technique in the table under a heading.
    fn row(text: &str, heading: &str, technique: &str) -> Vec<String> {
        let table = text.split(heading).nth(1).expect("the table");
        let line = table.lines().find(|line| line.trim_start().starts_with(technique)).expect("a row");
        let cells = line.split("  ").map(str::trim).filter(|cell| !cell.is_empty());
        cells.map(String::from).collect()
    }

    #[test]
    fn both_questions_are_answered_for_each_technique() {
        let text = tables(&fixture());
        let cost = "Least mae within a budget";
        let (small, middle, large) = ("0.04 (size=256)", "0.02 (size=512)", "0.01 (size=1024)");
        assert!(text.contains("1 × bare = 2.5 ms") && text.contains("8 × bare = 20 ms"), "{text}");
        assert_eq!(row(&text, cost, "a<b"), ["a<b", small, middle, large, large]);
        assert_eq!(row(&text, cost, "b"), ["b", "–", "0.03 (size=512)", "0.03 (size=512)", "0.03 (size=512)"]);
        let quality = "Least milliseconds over the floor at mae";
        assert_eq!(row(&text, quality, "a<b"), ["a<b", "2 (size=256)", "4 (size=512)", "8 (size=1024)", "–"]);
        assert_eq!(row(&text, quality, "b"), ["b", "5 (size=512)", "–", "–", "–"]);
    }

    #[test]
    fn what_is_missing_is_named() {
        let text = tables(&fixture());
        for line in ["skipped: picky, not for line lights", "broken size=1: the graphics device was lost"] {
            assert!(text.lines().any(|l| l == line), "{line} is missing in\n{text}");
        }
    }
}

//! The README says what the registry says.

use umbrage_core::{LightKind, LightKinds};
use umbrage_report::{COLUMNS, RAY_TRACED, RAY_TRACED_SUMMARY};

const README: &str = include_str!("../../../../README.md");

fn lights(kinds: LightKinds) -> String {
    if kinds == LightKinds::ALL {
        "all".into()
    } else {
        kinds.iter().map(LightKind::name).collect::<Vec<_>>().join(", ")
    }
}

#[test]
fn the_table_of_techniques_is_that_of_the_registry() {
    let row = |id: &str, params: String, lights: String, summary: &str| {
        let params = if params.is_empty() { "–".into() } else { params };
        format!("| `{id}` | {summary} | {lights} | {params} |")
    };
    let names =
        |params: &[umbrage::Param]| params.iter().map(|p| format!("`{}`", p.name)).collect::<Vec<_>>().join(" ");
    let mut rows = vec![row(RAY_TRACED, "`samples`".into(), "all".into(), RAY_TRACED_SUMMARY)];
    rows.extend(umbrage::techniques().iter().map(|t| row(t.id, names(t.params), lights(t.lights), t.summary)));
    let table = rows.join("\n");
    assert!(README.contains(&table), "README.md needs this table of techniques:\n\n{table}\n");
}

#[test]
fn every_scene_and_every_number_is_explained() {
    for scene in umbrage_core::scenes::SCENES {
        assert!(README.contains(&format!("`{}`", scene.id)), "README.md does not name the scene {}", scene.id);
    }
    for column in COLUMNS.iter().filter(|c| c.path[0] == "scores") {
        assert!(README.contains(&format!("| `{}` |", column.name)), "README.md does not explain {}", column.name);
    }
}

//! The tables in the documentation say what the registry says. `cargo xtask docs` runs these tests
//! with `UMBRAGE_WRITE_DOCS` set; they then write the tables instead of comparing them. Needs no
//! GPU.

use serde_json::Value;
use std::{fs, path::Path, path::PathBuf};
use umbrage::{Param, Registry, TechniqueInfo, techniques};
use umbrage_report::{COLUMNS, RAY_TRACED, RAY_TRACED_SUMMARY};

const GUIDE: &str = include_str!("../../../../docs/guide.md");
const PAPERS: &str = include_str!("../../../../docs/papers.md");

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(file: &str) -> String {
    fs::read_to_string(workspace().join(file)).unwrap_or_else(|e| panic!("{file}: {e}"))
}

/// `text` with `content` between the markers of the part `name`.
fn with_part(text: &str, name: &str, content: &str) -> Option<String> {
    let (start, end) = (format!("<!-- generated: {name} -->\n"), "<!-- end -->");
    let (head, rest) = text.split_once(&start)?;
    let (_, tail) = rest.split_once(end)?;
    Some(format!("{head}{start}{content}{end}{tail}"))
}

/// Compares the part of a file with what it should be, or writes it where that is asked for.
fn check(file: &str, name: &str, content: &str) {
    let found = read(file);
    let wanted = with_part(&found, name, content).unwrap_or_else(|| panic!("{file} has no markers of `{name}`"));
    if std::env::var_os("UMBRAGE_WRITE_DOCS").is_some() {
        fs::write(workspace().join(file), wanted).unwrap_or_else(|e| panic!("{file}: {e}"));
    } else {
        assert!(found == wanted, "the generated part `{name}` of {file} is old; run `cargo xtask docs`");
    }
}

fn readme_of(info: &TechniqueInfo) -> String {
    format!("crates/umbrage/src/techniques/{}/README.md", info.id.replace('-', "_"))
}

fn parameters(params: &[Param]) -> String {
    let row = |p: &Param| {
        let range = [p.kind.range(), p.unit.to_string()].join(" ");
        format!("| `{}` | {} | {} | {} |\n", p.name, range.trim_end(), p.kind.default(), p.help.replace('|', "\\|"))
    };
    let head = "| parameter | values | default | what it is |\n|---|---|---|---|\n".to_string();
    head + &params.iter().map(row).collect::<String>()
}

#[test]
fn the_parameters_of_every_technique_are_those_of_the_registry() {
    for info in Registry::default().all().filter(|t| !t.params().is_empty()) {
        check(&readme_of(info), "parameters", &parameters(info.params()));
    }
}

/// The newest stored comparison of all techniques, and its folder.
fn stored_run() -> (String, Value) {
    let runs = fs::read_dir(workspace().join("benchmarks")).expect("benchmarks").flatten();
    let folders = runs.map(|e| format!("benchmarks/{}/techniques", e.file_name().to_string_lossy()));
    let newest = folders.filter(|f| workspace().join(f).is_dir()).max().expect("a stored run of all techniques");
    let report = serde_json::from_str(&read(&format!("{newest}/report.json"))).expect("JSON");
    (newest, report)
}

/// The result of a technique at its defaults for a light of the stored run.
fn result<'a>(report: &'a Value, light: usize, id: &str) -> Option<&'a Value> {
    let results = report["scenes"][0]["lights"][light]["results"].as_array()?;
    let at_defaults = |r: &&Value| r["technique"] == id && r["settings"].as_object().is_some_and(|s| s.is_empty());
    results.iter().find(at_defaults)
}

/// One row: errors under both lights, milliseconds and memory under the second.
fn row(report: &Value, id: &str, readme: &str, summary: &str) -> String {
    let number = |light: usize, pointer: &str, unit: f64, digits: usize| {
        let value = result(report, light, id).and_then(|r| r.pointer(pointer)?.as_f64());
        value.map_or("–".into(), |v| format!("{:.digits$}", v / unit))
    };
    let errors = [0, 1].map(|light| number(light, "/scores/mae", 1.0, 4)).join(" | ");
    let cost = [number(1, "/cost/gpu_ms", 1.0, 1), number(1, "/cost/bytes", 1024.0 * 1024.0, 1)].join(" | ");
    format!("| [`{id}`]({readme}) | {summary} | {errors} | {cost} |\n")
}

#[test]
fn the_table_of_techniques_is_that_of_the_registry() {
    let (folder, report) = stored_run();
    let mut text = "| technique | what it does | error, point light | error, sphere light | ms | MiB |\n".to_string();
    text += "|---|---|---|---|---|---|\n";
    text += &row(&report, RAY_TRACED, "crates/umbrage-reference/README.md", RAY_TRACED_SUMMARY);
    text += &techniques().iter().map(|t| row(&report, t.id, &readme_of(t), t.summary)).collect::<String>();
    let (scene, made) = (&report["scenes"][0], &report["made"]);
    let word = |value: &Value| value.as_str().expect("a word").to_string();
    text += &format!(
        "\nThe scene is `{}` at {}×{}. The error is the mean absolute error of visibility (`mae`), 0 to 1. ms is the GPU's \
         time for\nthe sphere light on {}, MiB what the technique holds. All are at their defaults; {} has all numbers.\n",
        word(&scene["source"]),
        scene["width"],
        scene["height"],
        word(&made["adapter"]["name"]),
        format_args!("[the stored run]({folder})"),
    );
    check("README.md", "techniques", &text);
}

#[test]
fn the_list_of_look_ups_in_shaders_of_hosts_is_that_of_the_registry() {
    let row = |t: &TechniqueInfo| format!("| [`{}`](../{}) | {} |\n", t.id, readme_of(t), inline(t));
    let text = techniques().iter().map(|t| row(t)).collect::<String>();
    check("docs/hosts.md", "inline", &format!("| technique | in a host's own shader |\n|---|---|\n{text}"));
}

fn inline(info: &TechniqueInfo) -> &'static str {
    if info.is_lent() { "yes" } else { "no" }
}

#[test]
fn the_readme_is_short() {
    let readme = read("README.md");
    let without_table = with_part(&readme, "techniques", "").expect("the table of techniques");
    let (lines, all) = (without_table.lines().count(), readme.lines().count());
    assert!(lines <= 75, "README.md has {lines} of {all} lines beside its table; more belongs into docs/");
}

#[test]
fn the_guide_explains_every_scene_and_every_number() {
    for scene in umbrage_core::scenes::SCENES {
        assert!(GUIDE.contains(&format!("`{}`", scene.id)), "docs/guide.md does not name the scene {}", scene.id);
    }
    for column in COLUMNS.iter().filter(|c| c.path[0] == "scores") {
        assert!(GUIDE.contains(&format!("| `{}` |", column.name)), "docs/guide.md does not explain {}", column.name);
    }
}

#[test]
fn every_technique_has_a_source() {
    for id in Registry::default().all().map(|t| t.id).chain([RAY_TRACED]) {
        assert!(PAPERS.contains(&format!("| `{id}` |")), "docs/papers.md does not say where {id} comes from");
    }
}

#[test]
fn old_parts_are_found() {
    let text = "a\n<!-- generated: t -->\nold\n<!-- end -->\nb\n";
    assert_eq!(with_part(text, "t", "new\n").as_deref(), Some("a\n<!-- generated: t -->\nnew\n<!-- end -->\nb\n"));
    assert_eq!(with_part(text, "other", "new\n"), None);
}

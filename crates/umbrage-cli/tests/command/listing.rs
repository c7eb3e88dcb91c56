//! What `list` and `info` print.

use crate::common::output;
use serde_json::Value;
use std::{
    io::Read,
    path::Path,
    process::{Command, Stdio},
};

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&output(Path::new("."), arguments)).expect("JSON")
}

#[test]
fn list_has_the_whole_registry() {
    let list = json(&["list", "--json"]);
    assert_eq!(list["schema"], 1);
    let ids = |key: &str| {
        let entries = list[key].as_array().expect("a list").iter();
        entries.map(|e| e["id"].as_str().expect("an id").to_string()).collect::<Vec<_>>()
    };
    let mut techniques = vec!["ray-traced", "path-traced"];
    let registry = umbrage::Registry::default();
    techniques.extend(registry.all().map(|t| t.id));
    assert_eq!(ids("techniques"), techniques);
    assert_eq!(ids("scenes"), umbrage_core::scenes::SCENES.iter().map(|s| s.id).collect::<Vec<_>>());
    assert!(list["adapters"].is_array());
    for technique in list["techniques"].as_array().expect("a list") {
        for param in technique["params"].as_array().expect("a list") {
            for key in ["name", "help", "unit", "range", "default"] {
                assert!(param[key].is_string(), "{param} has no {key}");
            }
        }
    }
    let text = output(Path::new("."), &["list"]);
    for id in techniques {
        assert!(text.contains(id), "{id} is missing in\n{text}");
    }
    for (info, listed) in registry.all().zip(&list["techniques"].as_array().expect("a list")[2..]) {
        assert_eq!(listed["views"], serde_json::json!(info.views), "{}", info.id);
        assert!(text.contains(&info.views.join(", ")), "views of {} are missing in\n{text}", info.id);
    }
}

#[test]
fn info_counts_what_is_there() {
    let info = json(&["info", "contact", "--json"]);
    let scene = (umbrage_core::scenes::find("contact").expect("a scene").build)(1.0);
    assert_eq!(info["triangles"], scene.triangle_count());
    assert_eq!(info["lights"].as_array().map(Vec::len), Some(scene.lights.len()));
    assert!(info["mesh_check"]["open_edges"].is_u64() && info["bounds"]["min"][0].is_f64(), "{info}");
    assert!(output(Path::new("."), &["info", "contact"]).contains(&format!("{} in", scene.triangle_count())));
}

#[test]
fn every_subcommand_shows_examples() {
    for command in ["list", "info", "render", "compare", "bench"] {
        let help = output(Path::new("."), &[command, "--help"]);
        assert!(help.contains("Examples:") && help.contains(&format!("umbrage {command}")), "{help}");
    }
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_umbrage"))
        .args(["list"])
        .env("NODEVICE_SELECT", "1")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    drop(child.stdout.take());
    let mut errors = String::new();
    child.stderr.take().expect("a pipe").read_to_string(&mut errors).expect("UTF-8");
    assert!(child.wait().expect("an end").success() && errors.is_empty(), "{errors}");
}

//! The layering of the workspace, read from `cargo metadata` and from the sources of the
//! techniques.

use cargo_metadata::{DependencyKind, Metadata, MetadataCommand, Package};
use std::{collections::BTreeSet, fs, path::Path};

fn metadata() -> Metadata {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.toml");
    MetadataCommand::new().manifest_path(manifest).exec().expect("cargo metadata")
}

fn package<'a>(metadata: &'a Metadata, name: &str) -> &'a Package {
    metadata.workspace_packages().into_iter().find(|p| p.name.as_str() == name).expect("a crate of the workspace")
}

/// What a crate depends on itself, build scripts included, tests not.
fn direct(package: &Package) -> BTreeSet<String> {
    let counts = |kind| matches!(kind, DependencyKind::Normal | DependencyKind::Build);
    package.dependencies.iter().filter(|d| counts(d.kind)).map(|d| d.name.clone()).collect()
}

/// All that ends up in a crate, on every platform.
fn all(metadata: &Metadata, name: &str) -> BTreeSet<String> {
    let nodes = &metadata.resolve.as_ref().expect("a resolved graph").nodes;
    let mut waiting = vec![package(metadata, name).id.clone()];
    let mut seen = BTreeSet::new();
    while let Some(id) = waiting.pop() {
        if !seen.insert(id.clone()) {
            continue;
        }
        let node = nodes.iter().find(|n| n.id == id).expect("a node of the graph");
        let normal = node.deps.iter().filter(|d| d.dep_kinds.iter().any(|k| k.kind == DependencyKind::Normal));
        waiting.extend(normal.map(|d| d.pkg.clone()));
    }
    metadata.packages.iter().filter(|p| seen.contains(&p.id)).map(|p| p.name.to_string()).collect()
}

/// Fails where any of `found` is `unwanted` or starts with an unwanted name and a dash.
fn assert_none(what: &str, found: &BTreeSet<String>, unwanted: &[&str]) {
    let is = |name: &str, bad: &str| name == bad || name.strip_prefix(bad).is_some_and(|rest| rest.starts_with('-'));
    let wrong: Vec<_> = found.iter().filter(|name| unwanted.iter().any(|bad| is(name, bad))).collect();
    assert!(wrong.is_empty(), "{what} must not depend on {wrong:?}");
}

const GPU: &[&str] = &["wgpu", "naga", "ash", "metal", "umbrage"];
const FILES: &[&str] = &["image", "png", "jpeg", "exr", "gltf", "tobj", "toml", "zip", "npyz"];
const WINDOW: &[&str] = &["winit", "egui", "eframe", "clap", "indicatif"];
const CLOCKS: &[&str] = &["chrono", "time", "jiff", "web-time", "instant"];

#[test]
fn core_is_pure_data_and_maths() {
    let metadata = metadata();
    let core = direct(package(&metadata, "umbrage-core"));
    assert_eq!(core, BTreeSet::from(["glam".to_string()]), "umbrage-core depends on glam only");
    let mut found = all(&metadata, "umbrage-core");
    found.remove("umbrage-core");
    assert_none("umbrage-core", &found, &[GPU, FILES, WINDOW, CLOCKS, &["rayon", "tokio"]].concat());
}

#[test]
fn core_reads_no_file_and_no_clock() {
    for (path, text) in sources("crates/umbrage-core/src") {
        for word in ["std::fs", "std::time", "std::net", "std::env", "std::process", "Instant::now", "SystemTime"] {
            assert!(!text.contains(word), "{path} uses {word}");
        }
    }
}

#[test]
fn reference_and_metrics_know_no_gpu() {
    let metadata = metadata();
    for name in ["umbrage-reference", "umbrage-metrics"] {
        let mut found = all(&metadata, name);
        found.retain(|n| !["umbrage-reference", "umbrage-metrics", "umbrage-core"].contains(&n.as_str()));
        assert_none(name, &found, GPU);
    }
}

#[test]
fn the_library_knows_no_window_no_command_line_and_no_file_format() {
    let metadata = metadata();
    let library = direct(package(&metadata, "umbrage"));
    let others =
        ["umbrage-io", "umbrage-report", "umbrage-cli", "umbrage-reference", "umbrage-metrics", "umbrage-renderer"];
    assert_none("umbrage", &library, &[WINDOW, FILES, &["serde", "serde_json"], &others].concat());
}

#[test]
fn the_renderer_knows_no_window_no_command_line_and_no_file_format() {
    let metadata = metadata();
    let renderer = direct(package(&metadata, "umbrage-renderer"));
    let others = ["umbrage-io", "umbrage-report", "umbrage-cli", "umbrage-reference", "umbrage-metrics"];
    assert_none("umbrage-renderer", &renderer, &[WINDOW, FILES, &["serde", "serde_json"], &others].concat());
    for (path, text) in sources("crates/umbrage-renderer/src") {
        for word in ["std::fs", "std::net", "std::env", "std::process"] {
            assert!(!text.contains(word), "{path} uses {word}");
        }
    }
}

#[test]
fn the_command_holds_no_algorithm() {
    let metadata = metadata();
    let crates = ["umbrage", "umbrage-core", "umbrage-report", "umbrage-viewer"];
    let allowed = [&crates[..], &["anyhow", "clap", "indicatif", "serde_json", "signal-hook"]].concat();
    let found = direct(package(&metadata, "umbrage-cli"));
    let wrong: Vec<_> = found.iter().filter(|name| !allowed.contains(&name.as_str())).collect();
    assert!(wrong.is_empty(), "umbrage-cli only passes things on; {wrong:?} belong into umbrage-report or below it");
}

#[test]
fn the_laboratory_names_no_technique() {
    let ids: Vec<String> = fs::read_dir(workspace().join("crates/umbrage/src/techniques"))
        .expect("techniques")
        .flatten()
        .filter(|entry| entry.path().is_dir())
        .map(|entry| entry.file_name().to_string_lossy().replace('_', "-"))
        .collect();
    assert!(ids.len() > 2, "there are techniques to check: {ids:?}");
    for (path, text) in sources("crates/umbrage-viewer/src") {
        // Tests and the first pane of all have to name one; `none` is a word like others.
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        for id in ids.iter().filter(|id| !["pcf", "none"].contains(&id.as_str())) {
            assert!(!code.contains(&format!("\"{id}")), "{path} names the technique {id}");
        }
    }
}

#[test]
fn no_technique_imports_another() {
    let root = "crates/umbrage/src/techniques";
    let folders = fs::read_dir(workspace().join(root)).expect("techniques").flatten().filter(|e| e.path().is_dir());
    let ids: Vec<String> = folders.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    assert!(ids.len() > 2, "there are techniques to check: {ids:?}");
    for id in &ids {
        for (path, text) in sources(&format!("{root}/{id}")) {
            for other in ids.iter().filter(|other| *other != id) {
                for form in [format!("techniques::{other}"), format!("super::{other}"), format!("../{other}/")] {
                    assert!(!text.contains(&form), "{path} uses another technique: {form}");
                }
            }
            let braces = text.contains("techniques::{") || text.contains("super::{") || text.contains("techniques::*");
            assert!(!braces, "{path} imports several techniques at once");
        }
    }
}

/// What compiles anything does so through the device's store, so that lights of a kind share it.
#[test]
fn pipelines_are_made_in_one_place() {
    let folders = ["crates/umbrage/src", "crates/umbrage-renderer/src", "crates/umbrage-report/src"];
    for (path, text) in folders.into_iter().flat_map(sources).filter(|(path, _)| !path.ends_with("gpu/shared.rs")) {
        for what in ["render_pipeline", "compute_pipeline", "shader_module", "layout", "sampler"] {
            let wrong =
                ["", "bind_group_", "pipeline_"].iter().any(|of| text.contains(&format!(".create_{of}{what}(")));
            assert!(!wrong, "{path} makes a {what} of its own; `Gpu` has functions for it");
        }
    }
}

#[test]
fn every_crate_keeps_the_lints_of_the_workspace() {
    for package in metadata().workspace_packages() {
        let manifest = fs::read_to_string(&package.manifest_path).expect("a manifest");
        assert!(manifest.contains("[lints]\nworkspace = true"), "{} has lints of its own", package.name);
    }
    for (path, text) in sources("crates").into_iter().chain(sources("xtask/src")) {
        let waiver = format!("#[{}(", "allow");
        assert!(!text.contains(&waiver) && !text.contains(&waiver.replace('[', "![")), "{path} waives a lint");
    }
}

fn workspace() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// Name and text of all Rust and WGSL files below a folder of the workspace.
fn sources(folder: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(workspace().join(folder)).expect("a folder of sources").flatten() {
        let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            found.extend(sources(&name));
        } else if name.ends_with(".rs") || name.ends_with(".wgsl") {
            found.push((name, fs::read_to_string(entry.path()).expect("UTF-8")));
        }
    }
    found
}

/// A depth bias of the hardware means another thing in every format and on every device; what maps
/// need is computed in shaders. One pipeline has one: light caps of `volume` lie on the surface
/// that a host draws in its own way.
#[test]
fn no_pipeline_has_a_depth_bias() {
    let mut states = 0;
    for (path, text) in
        ["umbrage", "umbrage-renderer"].into_iter().flat_map(|name| sources(&format!("crates/{name}/src")))
    {
        let is_of_caps = path.ends_with("volume/pipelines.rs");
        assert!(is_of_caps || !text.contains("DepthBiasState"), "{path} names a depth bias");
        for state in text.split("wgpu::DepthStencilState {").skip(1).filter(|_| !is_of_caps) {
            // That of a function's result has no fields.
            let fields = state.trim_start().starts_with("format");
            states += u32::from(fields);
            let has_none = state.lines().take(8).any(|line| line.contains("bias: Default::default()"));
            assert!(!fields || has_none, "{path} has a state of depth with a bias");
        }
    }
    assert!(states > 5, "only {states} states of depth were found");
}

//! What `render`, `compare` and `bench` make. They need a graphics adapter: where there is none
//! they fail, and the message says how to get one.

use crate::common::{files, output, umbrage};
use serde_json::Value;
use std::{fs, path::Path};
use umbrage_core::Image;
use umbrage_io::pictures::{load_grey, save_grey16, save_png};

#[test]
fn render_writes_every_kind_of_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let pictures = [
        ("color", "a.png", "shadow-map"),
        ("visibility", "b.png", "shadow-map"),
        ("visibility", "c.exr", "pcf"),
        ("visibility", "d.exr", "ray-traced"),
        ("color", "e.png", "ray-traced"),
        ("scored", "f.png", "none"),
        ("depth", "g.exr", "none"),
        ("depth", "h.png", "ray-traced"),
        ("normal", "i.png", "none"),
        ("normal", "j.exr", "ray-traced"),
    ];
    for (aov, name, technique) in pictures {
        let samples: &[&str] = if technique == "ray-traced" { &["--samples", "4"] } else { &[] };
        let arguments =
            ["render", "contact", "--technique", technique, "--light", "0", "--size", "64x48", "--aov", aov];
        output(folder.path(), &[&arguments[..], samples, &["-o", name]].concat());
        assert!(fs::metadata(folder.path().join(name)).is_ok_and(|m| m.len() > 50), "{name} was not written");
    }
    let load = |name: &str| load_grey(&folder.path().join(name)).expect("a grey picture");
    let (png, traced) = (load("b.png"), load("d.exr"));
    assert_eq!((png.size(), traced.size()), ((64, 48), (64, 48)));
    assert!(traced.data.contains(&0.0) && traced.data.contains(&1.0), "no shadow or no light");
    assert_eq!(files(folder.path()).len(), pictures.len(), "something else was left behind");
}

#[test]
fn a_frame_of_what_moves_is_rendered_and_comes_again_after_a_round() {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = |arguments: &[&str]| {
        let fixed = ["render", "contact", "--light", "0", "--size", "64x48", "-o", "a.png"];
        output(folder.path(), &[&fixed[..], arguments].concat());
        fs::read(folder.path().join("a.png")).expect("a picture")
    };
    let start = picture(&["--moving", "casters"]);
    assert!(start != picture(&["--moving", "casters", "--frame", "12"]), "nothing moves");
    assert!(start == picture(&["--moving", "casters", "--frame", "60"]), "it ends elsewhere");
    assert!(picture(&[]) == picture(&["--frame", "12"]), "it moves by itself");
    assert!(start != picture(&["--path", "walk", "--frame", "3"]), "the camera stays");
}

#[test]
fn compare_writes_report_page_and_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = ["compare", "contact", "--techniques", "all", "--samples", "8", "--size", "96x72", "--frames", "2"];
    let printed = output(folder.path(), &[&arguments[..], &["-o", "out", "--json"]].concat());
    let written = fs::read_to_string(folder.path().join("out/report.json")).expect("report.json");
    assert_eq!(printed, written);
    let report: Value = serde_json::from_str(&written).expect("JSON");
    assert_eq!(report["schema"], 1);
    let lights = report["scenes"][0]["lights"].as_array().expect("lights");
    assert!(!lights.is_empty());
    for light in lights {
        let results = light["results"].as_array().expect("results");
        assert_eq!(results.len(), umbrage::techniques().len(), "a technique is missing");
        for result in results {
            assert_ne!(result["status"], "failed", "{result}");
            if result["status"] == "unsupported" {
                assert!(result["reason"].as_str().is_some_and(|r| r.starts_with("not for")), "{result}");
                continue;
            }
            assert!(result["scores"]["mae"].is_number() && result["cost"]["frame_ms"].is_number(), "{result}");
            let texels = if result["aliasing"].is_null() { &[][..] } else { &["aliasing"] };
            if result["technique"] == "shadow-map" {
                assert!(result["aliasing"]["median"].as_f64().is_some_and(|texel| texel > 0.0), "{result}");
            }
            for kind in ["color", "visibility", "error"].iter().chain(texels) {
                let name = result["pictures"][kind].as_str().expect("a picture");
                assert!(folder.path().join("out").join(name).is_file(), "{name} was not written");
            }
            assert_eq!(result["pictures"]["aliasing"].is_null(), result["aliasing"].is_null(), "{result}");
        }
    }
    let page = fs::read_to_string(folder.path().join("out/index.html")).expect("index.html");
    assert!(page.contains("data:image/png;base64,") && !page.contains("http"), "the page is not self-contained");
}

#[test]
fn bench_sets_techniques_against_the_floor() {
    let arguments = "bench contact --techniques none,shadow-map:size=256 --light 0 --frames 3 --size 96x72";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let json = output(Path::new("."), &[&arguments[..], &["--json"]].concat());
    let report: Value = serde_json::from_str(&json).expect("JSON");
    let results = report["scenes"][0]["lights"][0]["results"].as_array().expect("results");
    let names: Vec<_> = results.iter().map(|r| r["technique"].as_str().expect("a name")).collect();
    assert_eq!(names, ["floor", "bare-minimum", "bare-minimum", "none", "shadow-map"]);
    assert!(results.iter().all(|r| r["cost"]["frame_ms"]["median"].as_f64().is_some_and(|ms| ms > 0.0)), "{json}");
    let csv = output(Path::new("."), &[&arguments[..], &["--csv"]].concat());
    assert_eq!(csv.lines().count(), 1 + names.len());
}

#[test]
fn bench_sets_splits_against_as_many_maps() {
    let arguments = "bench city:0.1 --techniques cascaded:size=256:splits=3 --light 0 --frames 2 --size 96x72 --json";
    let json = output(Path::new("."), &arguments.split(' ').collect::<Vec<_>>());
    let report: Value = serde_json::from_str(&json).expect("JSON");
    let results = report["scenes"][0]["lights"][0]["results"].as_array().expect("results");
    let [_, one, three, cascaded] = &results[..] else { panic!("{json}") };
    assert_eq!((&one["settings"]["splits"], &three["settings"]["splits"]), (&Value::Null, &"3".into()));
    assert!(cascaded["status"] == "ok" && three["settings"]["size"] == "256", "{json}");
    // Three maps' memory against one's.
    let bytes = |result: &Value| result["cost"]["bytes"].as_u64().expect("bytes");
    assert!(bytes(three) > 2 * bytes(one), "{json}");
}

#[test]
fn bench_moves_lights_and_casters_and_puts_lights_together() {
    let bench = |more: &str| {
        let arguments = format!("bench contact --techniques volume,pcf:size=64 --frames 3 --size 96x72 --json {more}");
        let json = output(Path::new("."), &arguments.split_whitespace().collect::<Vec<_>>());
        serde_json::from_str::<Value>(&json).expect("JSON")
    };
    let apart = bench("");
    let lights = apart["scenes"][0]["lights"].as_array().expect("lights");
    assert_eq!(
        (&apart["moving"], &lights[1]["light"], &lights[1]["together"]),
        (&"none".into(), &1.into(), &Value::Null)
    );
    let report = bench("--moving all --lights-together");
    assert_eq!(report["moving"], "all");
    let together = report["scenes"][0]["lights"].as_array().expect("lights");
    assert_eq!(together.len(), 1);
    assert_eq!((&together[0]["light"], &together[0]["kind"]), (&Value::Null, &"all".into()));
    assert_eq!(together[0]["together"], serde_json::json!((0..lights.len()).collect::<Vec<_>>()));
    let results = together[0]["results"].as_array().expect("results");
    assert!(results.iter().all(|r| r["status"] == "ok"), "{report}");
    let casters = |light: &Value| {
        let volume = light["results"].as_array().and_then(|r| r.iter().find(|r| r["technique"] == "volume"));
        volume.and_then(|v| v["cost"]["counts"]["casters"].as_u64()).expect("a count of casters")
    };
    assert_eq!(casters(&together[0]), lights.iter().map(casters).sum::<u64>());
}

#[test]
fn flicker_is_measured_along_a_path() {
    let arguments = "bench contact --techniques none,volume,shadow-map:size=64 --path strafe --frames 4 --size 192x144";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let report: Value =
        serde_json::from_str(&output(Path::new("."), &[&arguments[..], &["--json"]].concat())).expect("JSON");
    assert_eq!((&report["path"], &report["moving"]), (&"strafe".into(), &"none".into()));
    let lights = report["scenes"][0]["lights"].as_array().expect("lights");
    for light in lights {
        assert!(light["flicker_points"].as_u64().is_some_and(|points| points > 5000), "{light}");
        assert!(light["flicker_reference"].as_f64().is_some_and(|flicker| flicker < 0.003), "{light}");
        assert!(light["results"][0]["flicker"].is_null(), "the floor has no shadow to flicker: {light}");
    }
    let of = |technique: &str, name: &str| {
        let results = lights[0]["results"].as_array().expect("results");
        let result = results.iter().find(|r| r["technique"] == technique).expect("a result");
        result[name].as_f64().expect("a number")
    };
    assert_eq!((of("none", "flicker"), of("none", "flicker_ratio")), (0.0, 0.0));
    let (exact, coarse) = (of("volume", "flicker_ratio"), of("shadow-map", "flicker_ratio"));
    assert!((0.8..1.25).contains(&exact), "hard shadows exact to the pixel flicker {exact} times as much as the truth");
    assert!(coarse > 2.0 * exact, "a coarse map that follows the camera flickers {coarse} times as much only");
    let text = output(Path::new("."), &arguments);
    for part in ["path strafe", "× truth", "flicker of the ray-traced reference"] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
    let still: Value = serde_json::from_str(&output(
        Path::new("."),
        &["bench", "contact", "--techniques", "none", "--light", "0", "--frames", "1", "--size", "32x24", "--json"],
    ))
    .expect("JSON");
    let light = &still["scenes"][0]["lights"][0];
    let nulls =
        [&still["path"], &light["flicker_reference"], &light["flicker_points"], &light["results"][2]["flicker"]];
    assert_eq!(nulls, [&Value::Null; 4]);
}

#[test]
fn paths_that_can_not_be_are_refused() {
    let refused = |more: &str, parts: &[&str]| {
        let arguments = format!("bench contact --techniques none --size 32x24 {more}");
        let output = umbrage(Path::new("."), &arguments.split_whitespace().collect::<Vec<_>>());
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!((output.status.code(), output.stdout.is_empty()), (Some(2), true), "{text}");
        parts.iter().for_each(|part| assert!(text.contains(part), "`{part}` is missing in\n{text}"));
    };
    refused("--path stafe", &["walk, strafe, turn, fly", "did you mean `strafe`"]);
    refused("--path walk --frames 1", &["--frames 2"]);
    refused("--path walk --moving lights", &["--moving"]);
    refused("--path walk --lights-together", &["--lights-together"]);
    refused("--samples 4", &["--path"]);
}

#[test]
fn the_overlay_of_all_lights_is_another_picture_and_is_measured_beside_the_right_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let render = |more: &[&str], name: &str| {
        let arguments = ["render", "contact", "--technique", "volume", "--size", "96x72", "-o", name];
        output(folder.path(), &[&arguments[..], more].concat());
        fs::read(folder.path().join(name)).expect("a picture")
    };
    assert_ne!(render(&[], "right.png"), render(&["--overlay", "0.5"], "overlay.png"));
    let arguments = "bench contact --techniques volume,none --lights-together --overlay --frames 2 --size 96x72 --json";
    let json = output(Path::new("."), &arguments.split(' ').collect::<Vec<_>>());
    let report: Value = serde_json::from_str(&json).expect("JSON");
    let results = report["scenes"][0]["lights"][0]["results"].as_array().expect("results");
    let overlay = |technique: &str| {
        let is_it = |r: &&Value| r["technique"] == technique && r["settings"]["overlay"] == "on";
        results.iter().find(is_it).expect("a result")["status"].clone()
    };
    assert_eq!((overlay("volume"), overlay("none")), ("ok".into(), "unsupported".into()));
}

#[test]
fn settings_may_stand_with_the_technique() {
    let folder = tempfile::tempdir().expect("a folder");
    let render = |technique: &str, set: &[&str], name: &str| {
        let arguments = ["render", "contact", "--technique", technique, "--size", "96x72", "-o", name];
        output(folder.path(), &[&arguments[..], set].concat());
        fs::read(folder.path().join(name)).expect("a picture")
    };
    let alone = render("pcf:kernel=7:size=256", &[], "a.png");
    assert_eq!(alone, render("pcf", &["--set", "kernel=7", "--set", "size=256"], "b.png"));
    assert_eq!(alone, render("pcf:kernel=3:size=256", &["--set", "kernel=7"], "c.png"), "--set counts");
    let wrong = umbrage(folder.path(), &["render", "contact", "--technique", "pcf:kernel", "-o", "d.png"]);
    let said = String::from_utf8_lossy(&wrong.stderr).into_owned();
    assert!(wrong.status.code() == Some(2) && said.contains("NAME=VALUE"), "{said}");
}

#[test]
fn views_into_a_technique_are_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    for view in ["volumes", "count", "overdraw", "silhouettes", "culling"] {
        let name = format!("{view}.png");
        let arguments = ["render", "contact", "--technique", "volume", "--light", "0", "--size", "96x72", "-o", &name];
        output(folder.path(), &[&arguments[..], &["--aov", view]].concat());
        assert!(folder.path().join(&name).is_file(), "{name}");
    }
}

/// The scene of the stored reference below: a box over a plane.
const SCENE: &str = "\
[camera]
eye = [0, 3, 6]
target = [0, 0, 0]
fov_y = 45

[[model]]
primitive = \"plane\"
size = [8, 8]

[[model]]
primitive = \"box\"
size = [1, 1, 1]
translate = [0, 1, 0]

[[light]]
kind = \"point\"
position = [1, 5, 1]
";

/// A stored reference made by the reference itself, and changed by `change`, scored against
/// `shadow-map`.
fn mae_against(change: impl Fn(f32) -> f32) -> f64 {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("s.scene.toml"), SCENE).expect("a scene");
    let render = |aov: &str, technique: &str, name: &str| {
        let size = ["--size", "128x96", "--aov", aov, "--technique", technique, "-o", name];
        output(folder.path(), &[&["render", "s.scene.toml"][..], &size].concat());
        load_grey(&path(name)).expect("a grey picture")
    };
    let mask = render("scored", "none", "mask.png").map(|v| if *v > 0.5 { 255u8 } else { 0 });
    let visibility = render("visibility", "ray-traced", "visibility.exr");
    let depth = render("depth", "ray-traced", "depth.exr");
    fs::create_dir(path("stored")).expect("a folder");
    save_grey16(&path("stored/s.light0.visibility.png"), &visibility.map(|v| change(*v))).expect("visibility");
    save_png(&path("stored/s.light0.mask.png"), &mask).expect("mask");
    fs::write(path("stored/s.geometry.npz"), geometry(&depth)).expect("geometry");

    let arguments =
        ["compare", "s.scene.toml", "--techniques", "shadow-map", "--reference", "stored", "-o", "out", "--json"];
    let report: Value = serde_json::from_str(&output(folder.path(), &arguments)).expect("JSON");
    let light = &report["scenes"][0]["lights"][0];
    assert_eq!((&report["scenes"][0]["width"], &light["reference"]["samples"]), (&128.into(), &Value::Null));
    light["results"][0]["scores"]["mae"].as_f64().expect("a score")
}

/// `geometry.npz` of one model, uncompressed.
fn geometry(depth: &Image<f32>) -> Vec<u8> {
    let size = format!("({}, {}", depth.height, depth.width);
    let floats = |values: Vec<f32>| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let doubles = |values: &[f64]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let arrays = [
        ("depth", "<f4", format!("{size})"), floats(depth.data.clone())),
        ("normal", "<f4", format!("{size}, 3)"), floats(vec![0.0; 3 * depth.data.len()])),
        ("model", "<i2", format!("{size})"), vec![0; 2 * depth.data.len()]),
        ("eye", "<f8", "(3,)".into(), doubles(&[0.0, 3.0, 6.0])),
        ("forward", "<f8", "(3,)".into(), doubles(&[0.0, 0.0, -1.0])),
        ("right", "<f8", "(3,)".into(), doubles(&[1.0, 0.0, 0.0])),
        ("up", "<f8", "(3,)".into(), doubles(&[0.0, 1.0, 0.0])),
        ("tan_half_fov_y", "<f8", "()".into(), doubles(&[0.5])),
    ];
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, kind, shape, bytes) in arrays {
        let mut head = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
        while (head.len() + 11) % 64 != 0 {
            head.push(' ');
        }
        head.push('\n');
        archive.start_file(format!("{name}.npy"), zip::write::SimpleFileOptions::default()).expect("a file");
        let length = (head.len() as u16).to_le_bytes();
        let all = [&b"\x93NUMPY\x01\x00"[..], &length, head.as_bytes(), &bytes].concat();
        std::io::Write::write_all(&mut archive, &all).expect("bytes");
    }
    archive.finish().expect("an archive").into_inner()
}

#[test]
fn a_changed_reference_is_noticed() {
    let (right, wrong) = (mae_against(|v| v), mae_against(|v| v * 0.75));
    assert!(right < 0.005, "shadow-map is off by {right} from its own scene");
    assert!(wrong > 0.15, "a quarter less light changed the error only to {wrong}");
}

#[test]
fn paths_are_traced_to_the_sky_and_wrong_use_is_said() {
    let dir = tempfile::tempdir().expect("a folder");
    let take = ["render", "courtyard:0.1", "--technique", "path-traced", "--samples", "4", "--size", "16x12"];
    output(dir.path(), &[&take[..], &["--bounces", "1", "--aov", "radiance", "-o", "r.exr"]].concat());
    let radiance = umbrage_io::pictures::load_rgb(&dir.path().join("r.exr")).expect("a picture");
    assert!(radiance.data.iter().any(|p| p[0] > 0.05) && radiance.data.iter().flatten().all(|c| c.is_finite()));
    for (arguments, says) in [
        (&["contact", "--technique", "path-traced", "-o", "a.png"][..], "no environment"),
        (&["courtyard", "--technique", "path-traced", "--bounces", "65", "-o", "a.png"], "bounces"),
        (&["courtyard", "--technique", "path-traced", "--light", "0", "-o", "a.png"], "--light is not for"),
        (&["courtyard", "--technique", "path-traced", "--aov", "visibility", "-o", "a.png"], "--aov radiance"),
        (&["courtyard", "--bounces", "1", "-o", "a.png"], "--bounces is for `path-traced`"),
        (&["courtyard", "--light", "2", "-o", "a.png"], "whose answer is radiance; choose prt"),
        (&["courtyard", "--light", "0", "--technique", "prt", "-o", "a.png"], "its light is the environment"),
        (&["contact", "--technique", "prt", "-o", "a.png"], "add [environment]"),
        (&["courtyard", "--light", "2", "--technique", "ray-traced", "--aov", "visibility", "-o", "a.png"], "radiance"),
    ] {
        let refused = umbrage(dir.path(), &[&["render"], arguments].concat());
        let error = String::from_utf8_lossy(&refused.stderr);
        assert!(!refused.status.success(), "{arguments:?}");
        assert!(error.contains(says), "{arguments:?}: {error}");
        assert!(!dir.path().join("a.png").exists());
    }
}

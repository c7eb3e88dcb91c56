//! `umbrage bake`. Needs no graphics adapter.

use crate::common::{files, output, umbrage};
use std::{fs, path::Path};

const FEW: [&str; 8] = ["bake", "contact:0.05", "--bake-samples", "4", "--detail", "8", "--cache", "baked"];

fn errors(folder: &Path, arguments: &[&str]) -> String {
    let output = umbrage(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "umbrage {arguments:?}");
    let text = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(text.lines().count(), 1, "an error is one line: {text}");
    text
}

#[test]
fn a_transfer_is_baked_once_and_anew_where_it_is_damaged() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = output(folder.path(), &FEW);
    assert!(first.contains(" points, ") && first.ends_with("; is baked\n"), "{first}");
    let kept = files(&folder.path().join("baked"));
    assert_eq!(kept.len(), 1, "one transfer and nothing unfinished: {kept:?}");
    assert!(output(folder.path(), &FEW).ends_with("; was there\n"));

    let whole = fs::read(&kept[0]).expect("the transfer");
    for wrong in [&whole[..whole.len() - 20], b"umbrage baked 1\nof something else"] {
        fs::write(&kept[0], wrong).expect("a damaged file");
        let again = umbrage(folder.path(), &FEW);
        let note = String::from_utf8_lossy(&again.stderr).into_owned();
        assert!(again.status.success() && note.contains("damaged") && note.contains("made anew"), "{note}");
        assert_eq!(fs::read(&kept[0]).expect("the transfer"), whole);
    }
}

#[test]
fn what_can_not_be_baked_is_one_line_with_the_remedy() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    let with = |more: &[&str]| errors(path, &[&FEW[..2], more].concat());
    for order in ["0", "11"] {
        assert!(with(&["--order", order]).contains("1..=10"));
    }
    assert!(with(&["--bake-samples", "0"]).contains("1..=65536"));
    assert!(with(&["--detail", "NaN"]).contains("1 to 4096"));
    assert!(with(&["--bounces", "2"]).contains("--transfer interreflected"));
    fs::write(path.join("file"), "x").expect("a file");
    assert!(with(&["--cache", "file"]).contains("file"));
    assert_eq!(files(path).len(), 1, "nothing was left: {:?}", files(path));
}

#[test]
fn models_as_they_come_give_transfers_or_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    let bake = |name: &str, text: &str, more: &[&str]| {
        fs::write(path.join(name), text).expect("a model");
        let few = ["--bake-samples", "4", "--detail", "8"];
        umbrage(path, &[&["bake", name][..], &few, more].concat())
    };
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    // No normals and no texture coordinates; a triangle without an area beside it.
    for faces in ["f 1 2 3\n", "f 1 2 3\nf 1 2 2\n"] {
        let output = bake("open.obj", &format!("{triangle}{faces}"), &[]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let output = bake("nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n", &[]);
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && text.contains("nan.obj"), "{text}");
    // A material that reflects more than it gets: without bounces it is none of the bake's
    // business.
    fs::write(path.join("m.mtl"), "newmtl m\nKd 1.5 1 1\n").expect("a material");
    let bright = format!("mtllib m.mtl\nusemtl m\n{triangle}f 1 2 3\n");
    assert!(bake("bright.obj", &bright, &[]).status.success());
    let output = bake("bright.obj", &bright, &["--transfer", "interreflected"]);
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && text.contains("base colour"), "{text}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_bake_keeps_what_is_done() {
    use crate::common::command;
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("baked");
    let long = ["bake", "primitives", "--bake-samples", "65536", "--cache", "baked"];
    let child = command(folder.path(), &long).stderr(Stdio::piped()).spawn().expect("the command starts");
    let begun = Instant::now();
    // It writes that it has begun before it bakes.
    while !place.is_dir() || files(&place).iter().all(|file| !file.ends_with(".unfinished")) {
        assert!(begun.elapsed() < Duration::from_secs(60), "the bake has not begun");
        std::thread::sleep(Duration::from_millis(20));
    }
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().expect("kill").success());
    let output = child.wait_with_output().expect("the end");
    assert_eq!(output.status.code(), Some(2));
    let text = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(text.contains("stopped") && text.contains("continues"), "{text}");
    let unfinished = files(&place);
    let size = |path: &str| fs::metadata(path).expect("an unfinished bake").len();
    assert!(unfinished.len() == 1 && size(&unfinished[0]) > 1000, "{unfinished:?}");
}

#[test]
fn transfer_is_written_for_others_in_full_and_in_less() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
        [&FEW[..], more].concat()
    }
    output(path, &with(&["--out", "full.npz"]));
    output(path, &with(&["--out", "model.glb"]));
    let printed = output(path, &with(&["--storage", "pca:2", "--out", "less.npz"]));
    assert!(printed.contains("less.npz"), "{printed}");
    let open = |name: &str| umbrage_io::open_transfer(&path.join(name)).expect("a transfer");
    let (full, less) = (open("full.npz"), open("less.npz"));
    assert!(full.meshes.len() == open("model.glb").meshes.len() && less.bytes() < full.bytes());
    assert!(errors(path, &with(&["--out", "a.txt"])).contains(".npz or .glb"));
    assert!(errors(path, &with(&["--storage", "cpca:64"])).contains("cpca:64:4"));
}

#[test]
fn skies_are_written_as_others_have_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    output(path, &["sky", "courtyard", "--to", "filament", "-o", "sh.txt"]);
    let lines = fs::read_to_string(path.join("sh.txt")).expect("coefficients");
    assert!(lines.lines().count() == 9 && lines.contains("; // L2-2, irradiance, pre-scaled base"), "{lines}");
    let three = output(path, &["sky", "sh.txt", "--to", "three"]);
    fs::write(path.join("probe.json"), &three).expect("a probe");
    let light = |text: &str| umbrage_io::read_probe(text).expect("a light").coefficients().to_vec();
    let again = light(&output(path, &["sky", "probe.json", "--to", "babylon"]));
    assert!(light(&three).iter().zip(&again).all(|(a, b)| (*a - *b).length() < 1e-12), "{again:?}");
    assert!(errors(path, &["sky", "contact", "--to", "three"]).contains("environment"));
    assert!(errors(path, &["sky", "courtyard", "--to", "unreal"]).contains("filament"));
    fs::write(path.join("none.json"), "{}").expect("a file");
    assert!(errors(path, &["sky", "none.json", "--to", "three"]).contains("none.json"));
}

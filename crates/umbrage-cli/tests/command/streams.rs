//! Names and streams of any kind: what is printed commands no terminal, no stream makes a panic.

use crate::common::{command, output, umbrage};
use std::fs;

/// A triangle in a scene whose names would turn a terminal red.
const SCENE: &str = "name = \"\\u001b[31mred\\u0007\\n\\u009b2J\"\n[[model]]\npath = 'a.obj'\n";
const OBJ: &str = "\u{1b}[31m 1\nmtllib \u{1b}[1m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn names_in_files_do_not_command_the_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("s.scene.toml"), SCENE).expect("a scene");
    fs::write(folder.path().join("a.obj"), OBJ).expect("a model");
    let is_command = |c: char| c.is_control() && c != '\n';
    for arguments in [&["info", "s.scene.toml"][..], &["info", "s.scene.toml", "--json"], &["info", "\u{1b}[31m.obj"]] {
        let printed = umbrage(folder.path(), arguments);
        for bytes in [printed.stdout, printed.stderr] {
            let text = String::from_utf8(bytes).expect("UTF-8");
            assert!(!text.contains(is_command), "umbrage {arguments:?} printed {text:?}");
        }
    }
    let json: serde_json::Value =
        serde_json::from_str(&output(folder.path(), &["info", "s.scene.toml", "--json"])).expect("JSON");
    assert_eq!(json["name"], "\\u{1b}[31mred\\u{7}\\n\\u{9b}2J");
}

#[cfg(target_os = "linux")]
#[test]
fn streams_that_take_nothing_end_in_an_error() {
    use std::process::Stdio;
    let folder = tempfile::tempdir().expect("a folder");
    let full = || Stdio::from(fs::OpenOptions::new().write(true).open("/dev/full").expect("/dev/full"));
    for arguments in [&["info", "nothing"][..], &["list", "--siez"], &[]] {
        let status = command(folder.path(), arguments).stderr(full()).status().expect("the command starts");
        assert_eq!(status.code(), Some(2), "umbrage {arguments:?}");
    }
    for arguments in [&["info", "contact"][..], &["info", "contact", "--json"]] {
        let printed = command(folder.path(), arguments).stdout(full()).output().expect("the command starts");
        let text = String::from_utf8_lossy(&printed.stderr);
        assert_eq!(printed.status.code(), Some(2), "{text}");
        assert!(text.contains("standard output") && text.contains("elsewhere") && text.lines().count() == 1, "{text}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn files_may_have_names_that_are_not_utf_8() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().expect("a folder");
    let name = std::ffi::OsStr::from_bytes(b"v\xff.png");
    let arguments = "render contact:0.1 --technique ray-traced --light 0 --aov visibility --size 4x3 --samples 1 -o";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let done = command(folder.path(), &arguments).arg(name).output().expect("the command starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(folder.path().join(name).is_file());
    let arguments = ["compare", "contact:0.1", "--techniques", "none", "--light", "0", "--size", "8x6"];
    let more = ["--samples", "1", "--frames", "1", "-o"];
    let name = std::ffi::OsStr::from_bytes(b"d\xff");
    let done = command(folder.path(), &arguments).args(more).arg(name).output().expect("the command starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(folder.path().join(name).join("report.json").is_file());
}

//! Broken input gives one clear line and exit code 2; nothing is written and nothing panics.

use crate::common::{command, files, umbrage};
use std::fs;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

const SCENE: &str = "\
[camera]
eye = [0, 1, 5]
target = [0, 0, 0]
fov_y = 45

[[model]]
primitive = \"plane\"
size = [4, 4]

[[light]]
kind = \"point\"
position = [1, 3, 1]
";

/// Runs `umbrage arguments` beside `input` files and wants one line with all of `parts`.
fn refused(input: &[(&str, &[u8])], arguments: &str, parts: &[&str]) {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bytes) in input {
        fs::write(folder.path().join(name), bytes).expect("an input file");
    }
    let before = files(folder.path());
    let arguments: Vec<&str> = arguments.split_whitespace().collect();
    let output = umbrage(folder.path(), &arguments);
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "umbrage {arguments:?} ended with {:?}:\n{text}", output.status);
    assert_eq!(text.trim_end().lines().count(), 1, "umbrage {arguments:?} printed not one line:\n{text}");
    assert!(text.starts_with("error: "), "{text}");
    for part in parts {
        assert!(text.contains(part), "umbrage {arguments:?}: `{part}` is missing in\n{text}");
    }
    assert!(output.stdout.is_empty(), "umbrage {arguments:?} printed {}", String::from_utf8_lossy(&output.stdout));
    assert_eq!(files(folder.path()), before, "umbrage {arguments:?} left files");
}

#[test]
fn names_that_are_not_known_come_with_the_nearest() {
    refused(&[], "render primitivs -o a.png", &["primitivs", "did you mean `primitives`"]);
    refused(&[], "render contact --technique shadowmap -o a.png", &["shadowmap", "did you mean `shadow-map`"]);
    refused(&[], "render contact --technique shadow-map --set siez=1 -o a.png", &["siez", "did you mean `size`"]);
    refused(&[], "compare contact --techniques none,pfc -o out", &["pfc", "did you mean `pcf`"]);
    refused(&[], "compare contact --set pfc.size=1 -o out", &["pfc", "did you mean `pcf`"]);
    refused(&[], "render contact --siez 4x4 -o a.png", &["--siez", "--size"]);
    refused(&[], "render contact -o a.exr", &["a.exr", "end its name in .png"]);
    refused(&[], "compare contact --reference nowhere -o out", &["nowhere", "folder of the references"]);
    refused(&[], "rendr contact", &["rendr", "render"]);
    refused(&[], "render contact --aov colour -o a.png", &["no picture `colour`", "did you mean `color`"]);
    refused(&[], "render contact --technique ZZZZ -o a.png", &["unknown technique `ZZZZ`", "`umbrage list`"]);
}

#[test]
fn values_out_of_range_name_the_range() {
    refused(&[], "render contact --technique shadow-map --set size=0 -o a.png", &["size", "1 to"]);
    refused(&[], "render contact --light 9 -o a.png", &["no light 9", "0 to"]);
    refused(&[], "render contact --size 0x480 -o a.png", &["0x480", "at least 1"]);
    refused(&[], "render contact --size 640 -o a.png", &["WIDTHxHEIGHT"]);
    refused(&[], "render contact:nan -o a.png", &["nan", "over 0"]);
    refused(&[], "compare contact --samples 0 -o out", &["--samples", "1.."]);
    refused(&[], "render contact --aov visibility -o a.png", &["--light"]);
    refused(&[], "render contact --technique none --light-samples 4 -o a.png", &["not a hard technique"]);
    refused(&[], "render contact --technique volume --overlay 2 -o a.png", &["--overlay", "from 0 to 1"]);
    refused(&[], "render contact --technique pcf --overlay 0.5 --size 8x8 -o a.png", &["overlay", "`volume`"]);
    refused(&[], "render contact --light 0 --aov depth --overlay 0.5 -o a.png", &["--overlay", "--aov color"]);
    refused(&[], "render contact --light 0 --technique volume --aov count --size 8x8 -o a.exr", &["a.exr", ".png"]);
    refused(&[], "bench contact --overlay", &["--lights-together"]);
    refused(
        &[],
        "bench contact --moving lihgts",
        &["--moving", "lihgts", "did you mean `lights`", "none, still, lights"],
    );
}

#[test]
fn broken_scene_files_name_file_line_and_key() {
    let with = |from: &str, to: &str| SCENE.replace(from, to).into_bytes();
    let scene = |bytes: Vec<u8>, parts: &[&str]| refused(&[("s.scene.toml", &bytes)], "info s.scene.toml", parts);
    scene(with("fov_y", "fov"), &["s.scene.toml:4:", "camera", "`fov_y`"]);
    scene(with("\"point\"", "\"pont\""), &["s.scene.toml", "pont", "point"]);
    scene(with("[0, 0, 0]", "[0, 1, 5]"), &["s.scene.toml", "target"]);
    scene(with("[1, 3, 1]", "[1, nan, 1]"), &["s.scene.toml", "position"]);
    scene(with("primitive = \"plane\"\nsize = [4, 4]", "path = \"gone.obj\""), &["gone.obj"]);
    scene(with("[camera]", "[camera"), &["s.scene.toml:1:"]);
}

#[test]
fn broken_models_are_named() {
    refused(&[], "info gone.obj", &["gone.obj"]);
    refused(&[("a.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 9\n")], "info a.obj", &["a.obj", "9"]);
    refused(&[("a.obj", TRIANGLE.replace("0 1 0", "0 nan 0").as_bytes())], "info a.obj", &["a.obj", "3"]);
    refused(&[("a.obj", b"# nothing\n")], "info a.obj", &["a.obj", "triangle"]);
    refused(&[("a.gltf", b"{ \"asset\": { \"version\": ")], "info a.gltf", &["a.gltf"]);
    refused(&[("a.glb", b"glTF\x02\0\0\0\xff\0\0\0")], "info a.glb", &["a.glb"]);
}

#[test]
fn places_that_cannot_be_written_are_named_before_the_work() {
    refused(&[], "render contact -o gone/a.png", &["gone"]);
    refused(&[], "render contact -o a.jpg", &["a.jpg", ".png"]);
    refused(&[], "render contact --aov color -o a.exr", &["a.exr", ".png"]);
    refused(&[("file", b"")], "compare contact -o file/out", &["file", "-o"]);
    refused(&[], "compare contact --reference gone -o out", &["gone"]);
}

#[test]
fn an_adapter_that_is_not_there_is_named() {
    refused(&[], "render contact --adapter xyzzy -o a.png", &["adapter"]);
}

#[test]
fn a_size_beyond_the_adapter_is_refused_with_its_limit() {
    refused(&[], "render contact --size 999999x4 -o a.png", &["999999", "the adapter allows 1 to"]);
    refused(&[], "bench contact --size 999999x4", &["999999", "the adapter allows 1 to"]);
}

#[test]
fn a_view_that_is_not_there_comes_with_those_that_are() {
    let render = "render city:0.05 --light 0 --size 32x24 -o a.png";
    refused(&[], &format!("{render} --technique volume --aov volums"), &["did you mean `volumes`", "count, overdraw"]);
    refused(&[], &format!("{render} --technique pcf --aov map-3"), &["no `map-3` of this light; its views: map-0"]);
}

#[test]
fn without_an_adapter_the_remedy_is_named_and_the_ray_tracer_still_works() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |technique: &str| {
        let arguments = ["render", "contact", "--light", "0", "--aov", "visibility", "--size", "32x24", "-o", "a.png"];
        // A driver that does not exist, and no other backend to fall back to.
        command(folder.path(), &[&arguments[..], &["--technique", technique]].concat())
            .envs([("VK_DRIVER_FILES", "/none"), ("VK_ICD_FILENAMES", "/none"), ("WGPU_BACKEND", "vulkan")])
            .output()
            .expect("the command starts")
    };
    let refused = run("shadow-map");
    let text = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{text}");
    assert!(text.contains("no usable graphics adapter") && text.contains("cargo xtask setup"), "{text}");
    assert!(files(folder.path()).is_empty(), "something was written");
    let traced = run("ray-traced");
    assert!(traced.status.success(), "{}", String::from_utf8_lossy(&traced.stderr));
}

#[test]
fn adapters_that_cannot_do_the_work_are_refused_before_it() {
    let folder = tempfile::tempdir().expect("a folder");
    // Without Vulkan there is at most OpenGL, whose shaders can't read depth buffers.
    let run = |line: &str| {
        let mut command = command(folder.path(), &line.split(' ').collect::<Vec<_>>());
        let output = command.envs([("VK_DRIVER_FILES", "/none"), ("VK_ICD_FILENAMES", "/none")]).output();
        let output = output.expect("the command starts");
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
        (output.status.code(), text(output.stdout), text(output.stderr))
    };
    for line in [
        "compare contact --light 0 --techniques pcf,vsm --size 32x24 -o out",
        "bench contact --light 0 --techniques pcf --size 32x24",
        "sweep contact --light 0 --size 32x24 -o out",
        "render contact --size 32x24 -o a.png",
        "render contact --size 32x24 --adapter 0 -o a.png",
    ] {
        let (code, _, errors) = run(line);
        assert_eq!((code, errors.lines().count()), (Some(2), 1), "{line}: {errors}");
        assert!(errors.contains("no usable graphics adapter") && errors.contains("install"), "{line}: {errors}");
        assert!(files(folder.path()).is_empty(), "{line}: something was written");
    }
    let (code, list, _) = run("list");
    assert!(code == Some(0) && list.contains("none that can be used: install a Vulkan driver"), "{list}");
    let (_, json, _) = run("list --json");
    let list: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let all = list["adapters"].as_array().expect("a list");
    assert!(all.iter().all(|adapter| adapter["unusable"].is_string()), "{all:?}");
    let (code, _, errors) =
        run("render contact --technique ray-traced --light 0 --aov visibility --size 32x24 -o a.png");
    assert_eq!((code, errors.as_str()), (Some(0), ""));
}

/// Where there is no desktop, a layer of Mesa's has something to say about that.
#[test]
fn nothing_is_printed_where_there_is_no_desktop() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = command(folder.path(), &["list"]);
    for variable in ["NODEVICE_SELECT", "XDG_RUNTIME_DIR", "WAYLAND_DISPLAY", "DISPLAY"] {
        command.env_remove(variable);
    }
    let output = command.output().expect("the command starts");
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert!(output.status.success() && output.stdout.starts_with(b"Techniques"));
}

//! Skins and animations of glTF, and how a scene file chooses one.

use glam::{DVec3, Vec3};
use std::f32::consts::FRAC_1_SQRT_2;
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use umbrage_core::Scene;
use umbrage_core::rig::{Moment, Weights};
use umbrage_io::{Opened, open, open_str};

/// A ribbon along Y on two bones of 1 m. `bend` turns the upper one by 90° about Z in 1 s; the
/// second animation, which has no name, moves it 1 m along X after 2 s at once, and scales the node
/// of a triangle that has no skin.
fn arm() -> String {
    let mut bytes: Vec<u8> = Vec::new();
    let mut views = Vec::new();
    let mut accessors = Vec::new();
    let mut put = |data: &[u8], component: u32, count: usize, kind: &str| {
        views.push(format!(r#"{{"buffer":0,"byteOffset":{},"byteLength":{}}}"#, bytes.len(), data.len()));
        accessors.push(format!(
            r#"{{"bufferView":{},"componentType":{component},"count":{count},"type":"{kind}"}}"#,
            views.len() - 1
        ));
        bytes.extend(data);
    };
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    put(&floats(&[0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 2.0, 0.0, 0.2, 2.0, 0.0]), 5126, 4, "VEC3");
    put(&[[0, 1, 0, 0], [0, 1, 0, 0], [1, 0, 0, 0], [1, 0, 0, 0]].concat(), 5121, 4, "VEC4");
    put(&floats(&[[2.0, 0.0, 0.0, 0.0]; 4].concat()), 5126, 4, "VEC4");
    let shift = |y: f32| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, y, 0.0, 1.0];
    put(&floats(&[shift(0.0), shift(-1.0)].concat()), 5126, 2, "MAT4");
    put(&floats(&[0.0, 1.0]), 5126, 2, "SCALAR");
    put(&floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2]), 5126, 2, "VEC4");
    put(&floats(&[0.0, 2.0]), 5126, 2, "SCALAR");
    put(&floats(&[0.0, 1.0, 0.0, 1.0, 1.0, 0.0]), 5126, 2, "VEC3");
    let data = base64::Engine::encode(&base64::engine::general_purpose::STANDARD, &bytes);
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[2,1,3]}}],
"nodes":[{{"translation":[0,1,0]}},{{"children":[0]}},{{"mesh":0,"skin":0}},{{"mesh":1,"scale":[1,1,1]}}],
"skins":[{{"joints":[1,0],"inverseBindMatrices":3}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}},"mode":5}}]}},
{{"primitives":[{{"attributes":{{"POSITION":0}},"mode":5}}]}}],
"animations":[{{"name":"bend","samplers":[{{"input":4,"output":5}}],"channels":[{{"sampler":0,"target":{{"node":0,"path":"rotation"}}}}]}},
{{"samplers":[{{"input":6,"output":7,"interpolation":"STEP"}}],"channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}},
{{"sampler":0,"target":{{"node":3,"path":"scale"}}}}]}}],
"accessors":[{}],"bufferViews":[{}],
"buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{data}"}}]}}"#,
        accessors.join(","),
        views.join(","),
        bytes.len()
    )
}

fn folder(gltf: &str) -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("arm.gltf"), gltf).unwrap();
    dir
}

/// The arm placed 10 m along X by a scene file with these keys.
fn placed(dir: &Path, keys: &str) -> Result<Opened, umbrage_io::Error> {
    let text = format!("[[model]]\npath = 'arm.gltf'\ntranslate = [10, 0, 0]\n{keys}\n");
    open_str(&text, dir, "test.scene.toml")
}

/// Where a vertex of an instance is in the world.
fn vertex(scene: &Scene, instance: usize, vertex: usize) -> DVec3 {
    let instance = &scene.instances[instance];
    instance.world_from_mesh.transform_point3(scene.posed_mesh(instance).positions[vertex].as_dvec3())
}

fn assert_near(got: DVec3, want: DVec3) {
    assert!((got - want).length() < 1e-6, "{got} instead of {want}");
}

#[test]
fn a_model_alone_is_at_rest_and_says_what_it_could_do() {
    let dir = folder(&arm());
    let opened = open(&dir.path().join("arm.gltf")).unwrap();
    assert_near(vertex(&opened.scene, 0, 2), DVec3::new(0.0, 2.0, 0.0));
    let note = opened.notes.iter().find(|n| n.contains("at rest")).unwrap();
    assert!(note.contains("`animation = \"bend\"`") && note.contains("(of bend, 1)"), "{note}");
    let mesh = &opened.scene.meshes[0];
    assert_eq!(mesh.positions[2], Vec3::new(0.0, 2.0, 0.0), "as it was bound");
    let held: Vec<_> = mesh.weights.of(2).iter().map(|i| (i.joint, i.weight)).collect();
    assert_eq!(held, [(1, 1.0)], "weights of 2 and 0");
    assert_eq!(opened.scene.meshes[1].weights, Weights::default());
}

#[test]
fn a_scene_file_freezes_a_model_in_a_moment() {
    let dir = folder(&arm());
    let scene = |keys: &str| placed(dir.path(), keys).unwrap().scene;
    let bent = scene("animation = 'bend'\ntime = 1");
    assert_near(vertex(&bent, 0, 2), DVec3::new(9.0, 1.0, 0.0));
    assert_near(vertex(&bent, 0, 3), DVec3::new(9.0, 1.2, 0.0));
    assert_near(vertex(&bent, 0, 1), DVec3::new(10.2, 0.0, 0.0));
    let half = 0.5f64.sqrt();
    assert_near(vertex(&scene("animation = 'bend'\ntime = 0.5"), 0, 2), DVec3::new(10.0 - half, 1.0 + half, 0.0));
    assert_near(vertex(&scene("animation = 'bend'"), 0, 2), DVec3::new(10.0, 2.0, 0.0));
    // Over again after the end; before the step, and after it.
    let mut scene = scene("animation = '1'\ntime = 3.5");
    assert_near(vertex(&scene, 0, 2), DVec3::new(10.0, 2.0, 0.0));
    scene.advance(0.5);
    assert_near(vertex(&scene, 0, 2), DVec3::new(10.0, 2.0, 0.0));
    let moment = Some(Moment { animation: 1, time_s: 2.0 });
    scene.instances[0].pose.as_mut().unwrap().moment = moment;
    assert_near(vertex(&scene, 0, 2), DVec3::new(11.0, 2.0, 0.0));
}

#[test]
fn nodes_without_a_skin_are_placed_at_that_moment() {
    let dir = folder(&arm());
    let scene = placed(dir.path(), "animation = '1'\ntime = 2").unwrap().scene;
    assert_eq!(scene.instances[1].pose, None);
    assert_near(vertex(&scene, 1, 2), DVec3::new(10.0, 2.0, 0.0));
    assert_near(vertex(&scene, 1, 3), DVec3::new(10.2, 2.0, 0.0));
    let flat = placed(dir.path(), "animation = '1'\ntime = 1").unwrap().scene;
    assert_near(vertex(&flat, 1, 3), DVec3::new(10.0, 2.0, 0.0));
}

#[test]
fn models_of_one_file_have_moments_of_their_own() {
    let dir = folder(&arm());
    let text = "[[model]]\npath = 'arm.gltf'\n[[model]]\npath = 'arm.gltf'\nanimation = 'bend'\ntime = 1";
    let opened = open_str(text, dir.path(), "test.scene.toml").unwrap();
    let scene = opened.scene;
    assert_eq!((scene.meshes.len(), scene.rigs.len(), scene.instances.len()), (2, 1, 4));
    assert_near(vertex(&scene, 0, 2), DVec3::new(0.0, 2.0, 0.0));
    assert_near(vertex(&scene, 2, 2), DVec3::new(-1.0, 1.0, 0.0));
    assert!(scene.bounds().min.x < -0.99, "bounds are those of poses: {:?}", scene.bounds());
}

#[test]
fn what_is_wrong_is_named_with_a_remedy() {
    let dir = folder(&arm());
    let error = |keys: &str| placed(dir.path(), keys).unwrap_err().to_string();
    for (keys, parts) in [
        ("animation = 'bent'", &[":4:", "`bent` is not in the model", "did you mean `bend`?"][..]),
        ("animation = 'xyz'", &["known are: bend, 1"]),
        ("animation = 3", &["must be a text"]),
        ("animation = 'bend'\ntime = nan", &[":5:", "`time` must be finite"]),
        ("time = 1", &[":4:", "`time` is that of an animation", "choose one with `animation`"]),
    ] {
        let message = error(keys);
        parts.iter().for_each(|part| assert!(message.contains(part), "{keys}: `{part}` is not in: {message}"));
    }
    let of_box = "[[model]]\nprimitive = 'box'\nsize = [1, 1, 1]\nanimation = 'bend'\n";
    let message = open_str(of_box, dir.path(), "test.scene.toml").unwrap_err().to_string();
    assert!(message.contains("unknown key `animation`"), "{message}");
    std::fs::write(dir.path().join("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let still = "[[model]]\npath = 'a.obj'\nanimation = 'bend'\n";
    let message = open_str(still, dir.path(), "test.scene.toml").unwrap_err().to_string();
    assert!(message.contains("no animation in it: remove the key"), "{message}");
}

#[test]
fn damaged_animations_are_errors() {
    for (from, to, parts) in [
        (
            r#""input":6,"output":7"#,
            r#""input":4,"output":2"#,
            &["accessor 2", "elements of 4 numbers instead of 3"][..],
        ),
        (r#""output":5}"#, r#""output":5,"interpolation":"CUBICSPLINE"}"#, &["2 values for 2 times; 3 for each"]),
        (r#""input":4"#, r#""input":8"#, &["not valid glTF"]),
        (r#""byteOffset":256,"#, r#""byteOffset":0,"#, &["animation 0, channel 0", "do not ascend"]),
        (r#""JOINTS_0":1"#, r#""JOINTS_0":2"#, &["accessor 2", "whole numbers"]),
        (r#""joints":[1,0]"#, r#""joints":[1]"#, &["mesh 0, primitive 0", "joint 1 is out of range: there are 1"]),
    ] {
        let whole = arm();
        assert!(whole.contains(from), "no {from}");
        let dir = folder(&whole.replacen(from, to, 1));
        let message = open(&dir.path().join("arm.gltf")).unwrap_err().to_string();
        parts.iter().for_each(|part| assert!(message.contains(part), "{to}: `{part}` is not in: {message}"));
    }
    let whole = arm();
    let matrix = whole.replacen(r#"{"translation":[0,1,0]}"#, r#"{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,1,0,1]}"#, 1);
    let opened = open(&folder(&matrix).path().join("arm.gltf")).unwrap();
    assert!(opened.notes.iter().any(|n| n.contains("node 0 is placed by a matrix")), "{:?}", opened.notes);
}

#[test]
#[ignore = "needs the shared references"]
fn the_fox_runs() {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let dir = std::env::var_os("UMBRAGE_SHARED").map_or_else(beside, PathBuf::from).join("data/gltf");
    assert!(dir.join("Fox.glb").is_file(), "{} has no Fox.glb; set UMBRAGE_SHARED", dir.display());
    let at = |keys: &str| {
        let text = format!("[[model]]\npath = 'Fox.glb'\n{keys}\n");
        open_str(&text, &dir, "fox.scene.toml").unwrap_or_else(|e| panic!("{e}")).scene
    };
    let mut heights = Vec::new();
    for time in [0.0, 0.2, 0.4, 0.6] {
        let scene = at(&format!("animation = 'Run'\ntime = {time}"));
        let size = scene.bounds().size();
        // A fox of about 155 units, nose to tail; its legs do not tear off.
        assert!((130.0..185.0).contains(&size.z) && (60.0..100.0).contains(&size.y), "at {time} s: {size}");
        heights.push(size.y);
    }
    let spread = heights.iter().fold(0.0, |s: f64, h| s.max((h - heights[0]).abs()));
    assert!(spread > 1.0, "it stands still: {heights:?}");
    let rig = &at("").rigs[0];
    let names: Vec<&str> = rig.animations.iter().map(|a| a.name.as_str()).collect();
    assert_eq!(names, ["Survey", "Walk", "Run"]);
    assert!((rig.animations[2].duration_s() - 1.158).abs() < 0.01, "{}", rig.animations[2].duration_s());
}

//! What OBJ and glTF files give.

use glam::{DVec3, Vec2, Vec3};
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use umbrage_core::{Image, LightShape, Scene};
use umbrage_io::{Opened, open, pictures};

fn file(name: &str, contents: &str) -> (TempDir, PathBuf) {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join(name);
    std::fs::write(&path, contents).unwrap();
    (dir, path)
}

fn open_text(name: &str, contents: &str) -> Opened {
    let (_dir, path) = file(name, contents);
    open(&path).unwrap_or_else(|e| panic!("{e}"))
}

/// The corners of every triangle of a mesh.
fn triangles(scene: &Scene, mesh: usize) -> Vec<[Vec3; 3]> {
    let mesh = &scene.meshes[mesh];
    mesh.triangles().map(|t| mesh.corners(t)).collect()
}

#[test]
fn obj_polygons_are_fans_and_every_triangle_is_kept() {
    let scene = open_text(
        "a.obj",
        "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5\nf 1 2 2\nf 1 2 3\nf 1 2 3 # again\n",
    )
    .scene;
    let p = |x: f32, y: f32| Vec3::new(x, y, 0.0);
    let want = [
        [p(0.0, 0.0), p(1.0, 0.0), p(2.0, 1.0)],
        [p(0.0, 0.0), p(2.0, 1.0), p(1.0, 2.0)],
        [p(0.0, 0.0), p(1.0, 2.0), p(0.0, 1.0)],
        [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 0.0)],
        [p(0.0, 0.0), p(1.0, 0.0), p(2.0, 1.0)],
        [p(0.0, 0.0), p(1.0, 0.0), p(2.0, 1.0)],
    ];
    assert_eq!(triangles(&scene, 0), want);
    assert_eq!(scene.meshes[0].positions.len(), 5);
    assert!(scene.meshes[0].normals.iter().all(|n| (*n - Vec3::Z).length() < 1e-6), "{:?}", scene.meshes[0].normals);
}

#[test]
fn obj_vertices_may_follow_and_lines_go_on() {
    let opened = open_text("a.obj", "f 1 2 \\\n 3\nl 1 2\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
    assert_eq!(opened.scene.triangle_count(), 1);
    assert!(opened.notes[0].contains("a.obj:3: `l` is not read"), "{:?}", opened.notes);
}

#[test]
fn obj_smooth_normals_do_not_break_at_texture_seams() {
    // A ridge along X whose two sides have texture coordinates of their own.
    let scene =
        open_text("a.obj", "v 0 1 0\nv 1 1 0\nv 0 0 1\nv 0 0 -1\nvt 0 0\nvt 1 0.25\nf 1/1 3/1 2/1\nf 1/2 2/2 4/2\n")
            .scene;
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.positions.len(), 6);
    let on_ridge = |i: &usize| mesh.positions[*i].y == 1.0;
    for i in (0..6).filter(on_ridge) {
        assert!((mesh.normals[i] - Vec3::Y).length() < 1e-6, "{:?}", mesh.normals[i]);
    }
    assert_eq!((mesh.uvs[0], mesh.uvs[3]), (Vec2::new(0.0, 1.0), Vec2::new(1.0, 0.75)));
}

#[test]
fn obj_objects_and_materials_are_meshes_and_a_mask_cuts_out() {
    let (dir, path) = file(
        "a.obj",
        "mtllib my materials.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no one\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\no two\nusemtl a\nf 1 2 3\nusemtl nothing\nf 1 2 3\n",
    );
    std::fs::write(
        dir.path().join("my materials.mtl"),
        "newmtl a\nmap_Kd -bm 2 color.png\nmap_d sub\\mask.png\nd 0.5\nnewmtl b\nKd 0.25 0.5 1\nTr 0.75\n",
    )
    .unwrap();
    std::fs::create_dir(dir.path().join("sub")).unwrap();
    pictures::save_png(&dir.path().join("color.png"), &Image::filled(4, 2, [1u8, 2, 3])).unwrap();
    pictures::save_png(&dir.path().join("sub/mask.png"), &Image::from_fn(2, 1, |x, _| 200 * x as u8)).unwrap();
    let Opened { scene, notes } = open(&path).unwrap();
    assert_eq!((scene.meshes.len(), scene.materials.len(), scene.textures.len()), (4, 3, 1));
    let used: Vec<usize> = scene.instances.iter().map(|i| i.material).collect();
    assert_eq!(used, [0, 1, 0, 2]);
    let row = [[1, 2, 3, 0], [1, 2, 3, 0], [1, 2, 3, 200], [1, 2, 3, 200]];
    assert_eq!(scene.textures[0].rgba, [row, row].concat());
    assert_eq!((scene.materials[0].alpha_cutoff, scene.materials[1].alpha_cutoff), (Some(0.5), None));
    assert_eq!(scene.materials[1].base_color.to_array(), [0.25, 0.5, 1.0, 1.0]);
    for part in ["`-bm` was left out", "`b` is 25 % opaque", "`nothing` is in none of its libraries"] {
        assert!(notes.iter().any(|n| n.contains(part)), "`{part}` is not in {notes:?}");
    }
    assert!(!notes.iter().any(|n| n.contains("`a` is")), "{notes:?}");
}

/// A glTF whose buffer holds the corners of a unit square, counter-clockwise.
fn square(rest: &str) -> String {
    let floats = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = floats.iter().flat_map(|v| v.to_le_bytes()).collect();
    let data = base64::Engine::encode(&base64::engine::general_purpose::STANDARD, bytes);
    format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":48,"uri":"data:application/octet-stream;base64,{data}"}}],
"bufferViews":[{{"buffer":0,"byteLength":48}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}}],{rest}}}"#
    )
}

fn squares(primitives: &str) -> Opened {
    open_text("a.gltf", &square(&format!(r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{primitives}]}}]"#)))
}

#[test]
fn gltf_strips_and_fans_keep_their_winding_and_other_modes_are_noted() {
    let opened = squares(
        r#"{"attributes":{"POSITION":0},"mode":5},{"attributes":{"POSITION":0},"mode":6},{"attributes":{"POSITION":0},"mode":1}"#,
    );
    let p = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
    assert_eq!(triangles(&opened.scene, 0), [[p[0], p[1], p[2]], [p[1], p[3], p[2]]]);
    assert_eq!(triangles(&opened.scene, 1), [[p[1], p[2], p[0]], [p[2], p[3], p[0]]]);
    assert_eq!(opened.scene.meshes.len(), 2);
    assert!(opened.notes[0].contains("mesh 0, primitive 2 holds Lines"), "{:?}", opened.notes);
}

#[test]
fn gltf_nodes_place_a_shared_mesh_by_their_hierarchy() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let scene = open_text(
        "a.gltf",
        &square(&format!(
            r#""scene":1,"scenes":[{{"nodes":[3]}},{{"nodes":[0,4]}}],"nodes":[
{{"translation":[10,0,0],"rotation":[0,{half},0,{half}],"children":[1]}},
{{"translation":[0,0,1],"scale":[2,2,2],"mesh":0}},{{}},{{"mesh":0}},{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"mode":6}}]}}]"#
        )),
    )
    .scene;
    assert_eq!((scene.meshes.len(), scene.instances.len()), (1, 2));
    // X is scaled to 2, moved to (2, 0, 1), turned by 90° about Y to (1, 0, −2), moved to (11, 0,
    // −2).
    let got = scene.instances[0].world_from_mesh.transform_point3(DVec3::X);
    assert!((got - DVec3::new(11.0, 0.0, -2.0)).length() < 1e-6, "{got}");
}

#[test]
fn gltf_materials_follow_the_documented_rule() {
    let opened = open_text(
        "a.gltf",
        &square(
            r#""nodes":[{"mesh":0}],"materials":[
{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,0.5],"metallicFactor":1,"roughnessFactor":0.5},"emissiveFactor":[0,1,0]},
{"name":"glass","alphaMode":"BLEND","pbrMetallicRoughness":{"metallicFactor":0}},
{"alphaMode":"MASK","alphaCutoff":0.25,"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.75]}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":5,"material":0},{"attributes":{"POSITION":0},"mode":5,"material":1},
{"attributes":{"POSITION":0},"mode":5,"material":2},{"attributes":{"POSITION":0},"mode":5}]}]"#,
        ),
    );
    let [metal, glass, masked, default] = &opened.scene.materials[..] else { panic!("{:?}", opened.scene.materials) };
    assert_eq!((metal.base_color.to_array(), metal.emissive), ([1.0, 0.0, 0.0, 1.0], Vec3::Y));
    assert!((metal.specular - 0.2126).abs() < 1e-6 && (metal.shininess - 30.0).abs() < 1e-4, "{metal:?}");
    assert!((glass.specular - 0.04).abs() < 1e-6 && glass.shininess == 1.0 && glass.alpha_cutoff.is_none());
    assert_eq!((masked.alpha_cutoff, masked.base_color.w), (Some(0.25), 0.75));
    assert_eq!(*default, umbrage_core::Material::default());
    assert!(opened.notes[0].contains("`glass` is transparent"), "{:?}", opened.notes);
}

#[test]
fn gltf_lights_and_the_first_camera_are_taken() {
    let opened = open_text(
        "a.gltf",
        &square(
            r#""extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[
{"type":"point","intensity":31.415927,"range":8},{"type":"directional","color":[1,0.5,0],"intensity":6.2831855},
{"type":"spot","spot":{"innerConeAngle":0.5235988,"outerConeAngle":1.5707964}}]}},
"cameras":[{"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":0.1,"zfar":9}},
{"type":"perspective","perspective":{"yfov":1.0471976,"znear":0.5}},{"type":"perspective","perspective":{"yfov":1,"znear":1}}],
"nodes":[{"mesh":0},{"translation":[0,5,0],"extensions":{"KHR_lights_punctual":{"light":0}}},
{"rotation":[-0.70710678,0,0,0.70710678],"extensions":{"KHR_lights_punctual":{"light":1}}},
{"extensions":{"KHR_lights_punctual":{"light":2}}},
{"camera":0},{"camera":1,"translation":[1,2,3],"scale":[4,4,4]},{"camera":2}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":5}]}]"#,
        ),
    );
    let [point, sun, spot] = &opened.scene.lights[..] else { panic!("{:?}", opened.scene.lights) };
    assert_eq!(point.shape, LightShape::Point { position: DVec3::new(0.0, 5.0, 0.0) });
    assert!((point.intensity - 10.0).abs() < 1e-5 && point.range == Some(8.0) && point.attenuation == Vec3::Z);
    let LightShape::Directional { direction, angle_deg } = sun.shape else { panic!("{sun:?}") };
    assert!((direction - DVec3::NEG_Y).length() < 1e-6 && angle_deg == 0.0, "{direction}");
    assert!((sun.intensity - 2.0).abs() < 1e-6 && sun.attenuation == Vec3::X && sun.color == Vec3::new(1.0, 0.5, 0.0));
    let LightShape::Spot { direction, inner_angle_deg, outer_angle_deg, .. } = spot.shape else { panic!("{spot:?}") };
    assert_eq!((direction, outer_angle_deg), (DVec3::NEG_Z, 89.9));
    assert!((inner_angle_deg - 30.0).abs() < 1e-5);
    let camera = &opened.scene.camera;
    assert_eq!((camera.eye, camera.target), (DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, 2.0, 2.0)));
    assert!((camera.fov_y_deg - 60.0).abs() < 1e-5 && camera.near == 0.5);
    for part in ["camera 0 is orthographic", "camera 2 is not used", "light 2 shines into a half-space"] {
        assert!(opened.notes.iter().any(|n| n.contains(part)), "`{part}` is not in {:?}", opened.notes);
    }
}

#[test]
fn a_scene_file_notes_that_it_does_not_use_the_camera_of_a_model() {
    let text = square(
        r#""cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],"nodes":[{"mesh":0},{"camera":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":5}]}]"#,
    );
    let (dir, _) = file("a.gltf", &text);
    let scene = "[[model]]\npath = 'a.gltf'\n";
    let notes = umbrage_io::open_str(scene, dir.path(), "s.toml").unwrap().notes;
    assert!(notes[0].contains("its camera and lights are not used"), "{notes:?}");
    assert!(open(Path::new("no such folder/a.gltf")).is_err());
}

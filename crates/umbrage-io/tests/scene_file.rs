//! What scene files mean: keys, defaults, transforms, lights.

use glam::{DVec2, DVec3, Vec3};
use std::path::Path;
use umbrage_core::{LightKind, LightShape, Material, Scene};
use umbrage_io::{Opened, open_str};

const BOX: &str = "[[model]]\nprimitive = 'box'\nsize = [1, 1, 1]\n";
const CAMERA: &str = "[camera]\neye = [0, 2, 6]\ntarget = [0, 0, 0]\nfov_y = 45\n";

fn open(text: &str) -> Opened {
    open_str(text, Path::new("."), "test.scene.toml").unwrap_or_else(|e| panic!("{e}"))
}

fn light(text: &str) -> umbrage_core::Light {
    open(&format!("{BOX}[[light]]\n{text}")).scene.lights.remove(0)
}

fn corner(scene: &Scene, instance: usize, point: DVec3) -> DVec3 {
    scene.instances[instance].world_from_mesh.transform_point3(point)
}

fn assert_near(got: DVec3, want: DVec3) {
    assert!((got - want).length() < 1e-12, "{got} instead of {want}");
}

#[test]
fn absent_keys_have_their_defaults() {
    let opened = open(&format!("{CAMERA}{BOX}[[light]]\nkind = 'point'\nposition = [1, 2, 3]\n"));
    assert!(opened.notes.is_empty(), "{:?}", opened.notes);
    let scene = opened.scene;
    assert_eq!((scene.name.as_str(), scene.ambient), ("test", Vec3::ZERO));
    assert_eq!((scene.camera.up, scene.camera.near, scene.camera.fov_y_deg), (DVec3::Y, 0.05, 45.0));
    let instance = &scene.instances[0];
    assert!(instance.casts && instance.receives && instance.model == 0);
    assert_eq!(scene.materials[instance.material], Material::default());
    let light = &scene.lights[0];
    assert_eq!((light.color, light.intensity, light.attenuation), (Vec3::ONE, 1.0, Vec3::X));
    assert!(light.range.is_none() && light.casts);
}

#[test]
fn a_camera_with_parallel_lines_of_sight_may_see_behind_its_eye() {
    let camera = "[camera]\neye = [0, 2, 6]\ntarget = [0, 2, 0]\nheight = 3\nnear = -10\nfar = 20\n";
    let scene = open(&format!("{camera}[[model]]\nprimitive = 'plane'\nsize = [1, 1]\n")).scene;
    let camera = &scene.camera;
    let (parallel, near) = (camera.parallel.unwrap(), camera.near);
    assert!(near > 0.0);
    // The same planes, seen from farther back.
    assert_eq!(camera.eye.z - near, 16.0);
    assert_eq!(camera.eye.z - parallel.far, -14.0);
    assert_eq!((parallel.height, camera.eye.x, camera.eye.y), (3.0, 0.0, 2.0));
}

#[test]
fn every_key_is_read() {
    let scene = open(
        "name = 'n'
        [camera]
        eye = [1, 2, 3]
        target = [4, 5, 6]
        up = [0, 0, 2]
        fov_y = 30.5
        near = 1
        [ambient]
        color = [0.1, 0.2, 0.3]
        [[model]]
        primitive = 'plane'
        size = [2, 4]
        casts = false
        receives = false
        material = { base_color = [1, 0.5, 0], specular = 0.25, shininess = 8, emissive = [0, 0, 3] }
        [[light]]
        kind = 'point'
        position = [0, 9, 0]
        color = [1, 0, 0]
        intensity = 4
        attenuation = [0, 1, 2]
        range = 50
        casts = false",
    )
    .scene;
    assert_eq!((scene.name.as_str(), scene.ambient), ("n", Vec3::new(0.1, 0.2, 0.3)));
    let c = &scene.camera;
    assert_eq!((c.eye, c.target), (DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)));
    assert_eq!((c.up, c.fov_y_deg, c.near), (DVec3::Z, 30.5, 1.0));
    let i = &scene.instances[0];
    assert!(!i.casts && !i.receives);
    let m = &scene.materials[i.material];
    assert_eq!((m.base_color.truncate(), m.specular, m.shininess), (Vec3::new(1.0, 0.5, 0.0), 0.25, 8.0));
    assert_eq!((m.emissive, m.texture, m.alpha_cutoff), (Vec3::new(0.0, 0.0, 3.0), None, None));
    let l = &scene.lights[0];
    assert_eq!((l.color, l.intensity, l.attenuation), (Vec3::X, 4.0, Vec3::new(0.0, 1.0, 2.0)));
    assert_eq!((l.range, l.casts), (Some(50.0), false));
}

#[test]
fn a_model_is_scaled_then_turned_about_x_y_z_then_moved() {
    let scene = open("[[model]]\nprimitive = 'box'\nsize = [2, 2, 2]\nscale = [1, 2, 3]\nrotate = [90, 90, 0]\ntranslate = [10, 0, 0]").scene;
    // (1, 1, 1) of the box is scaled to (1, 2, 3); about X: (1, −3, 2); about Y: (2, −3, −1).
    assert_near(corner(&scene, 0, DVec3::splat(0.5)), DVec3::new(12.0, -3.0, -1.0));
    let scene = open("[[model]]\nprimitive = 'box'\nsize = [2, 2, 2]\nscale = 3\nrotate = [0, 90, 90]").scene;
    // (3, 3, 3); about Y: (3, 3, −3); about Z: (−3, 3, −3).
    assert_near(corner(&scene, 0, DVec3::splat(0.5)), DVec3::new(-3.0, 3.0, -3.0));
}

#[test]
fn primitives_have_their_sizes_and_segments() {
    for (text, size, triangles) in [
        ("'plane'\nsize = [2, 3]", [2.0, 0.0, 3.0], 2),
        ("'box'\nsize = [2, 3, 4]", [2.0, 3.0, 4.0], 12),
        ("'sphere'\nradius = 2", [4.0, 4.0, 4.0], 64 * 31 * 2),
        ("'sphere'\nradius = 2\nsegments = [8, 4]", [4.0, 4.0, 4.0], 8 * 3 * 2),
        ("'cylinder'\nradius = 2\nheight = 3", [4.0, 3.0, 4.0], 32 * 4),
        ("'cone'\nradius = 2\nheight = 3\nsegments = [16, 2]", [4.0, 3.0, 4.0], 16 * 4),
        ("'torus'\nradii = [3, 1]", [8.0, 2.0, 8.0], 64 * 32 * 2),
    ] {
        let scene = open(&format!("[[model]]\nprimitive = {text}\n")).scene;
        assert!((scene.bounds().size() - DVec3::from(size)).length() < 1e-5, "{text}: {:?}", scene.bounds());
        assert_eq!(scene.triangle_count(), triangles, "{text}");
    }
}

#[test]
fn every_light_kind_is_read() {
    let p = DVec3::new(1.0, 2.0, 3.0);
    let at = "position = [1, 2, 3]\n";
    assert_eq!(light(&format!("kind = 'point'\n{at}")).shape, LightShape::Point { position: p });
    let spot = light(&format!("kind = 'spot'\n{at}direction = [0, -2, 0]\ninner_angle = 20\nouter_angle = 30"));
    let want = LightShape::Spot { position: p, direction: DVec3::NEG_Y, inner_angle_deg: 20.0, outer_angle_deg: 30.0 };
    assert_eq!(spot.shape, want);
    let sun = light("kind = 'directional'\ndirection = [0, 0, -5]\nangle = 0.53").shape;
    assert_eq!(sun, LightShape::Directional { direction: DVec3::NEG_Z, angle_deg: 0.53 });
    assert_eq!(light("kind = 'directional'\ndirection = [0, 0, -5]").shape.kind(), LightKind::Directional);
    let sphere = light(&format!("kind = 'sphere'\n{at}radius = 0.5"));
    assert_eq!(sphere.shape, LightShape::Sphere { position: p, radius: 0.5 });
    let ellipsoid = light(&format!("kind = 'ellipsoid'\n{at}radii = [1, 2, 3]\nrotate = [0, 0, 90]")).shape;
    let LightShape::Ellipsoid { radii, rotation, .. } = ellipsoid else { panic!("{ellipsoid:?}") };
    assert_near(rotation * radii, DVec3::new(-2.0, 1.0, 3.0));
    let disc = light(&format!("kind = 'disc'\n{at}direction = [0, -1, 0]\nradius = 2")).shape;
    assert_eq!(disc, LightShape::Disc { position: p, direction: DVec3::NEG_Y, radius: 2.0 });
    let rect = light(&format!("kind = 'rect'\n{at}direction = [0, -1, 0]\nup = [0, 1, 2]\nsize = [2, 3]")).shape;
    let LightShape::Rect { up, size, texture: None, .. } = rect else { panic!("{rect:?}") };
    assert_eq!((up, size), (DVec3::Z, DVec2::new(2.0, 3.0)));
    let line = light("kind = 'line'\nfrom = [0, 1, 0]\nto = [2, 1, 0]").shape;
    assert_eq!(line, LightShape::Line { from: DVec3::Y, to: DVec3::new(2.0, 1.0, 0.0) });
}

#[test]
fn files_are_read_once_and_their_material_can_be_replaced() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(dir.path().join(name), text).unwrap();
    write("a.mtl", "newmtl red\nKd 1 0 0\nKs 0.5 0.5 0.5\nNs 20\nKe 0 1 0\n");
    write("a.obj", "mtllib a.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    let text = "
        [[model]]
        path = 'a.obj'
        [[model]]
        path = './a.obj'
        translate = [5, 0, 0]
        material = { specular = 0.75 }";
    let scene = open_str(text, dir.path(), "s").unwrap().scene;
    assert_eq!((scene.meshes.len(), scene.instances.len()), (1, 2));
    assert_eq!(scene.instances.iter().map(|i| i.model).collect::<Vec<_>>(), [0, 1]);
    let of = |i: usize| &scene.materials[scene.instances[i].material];
    assert_eq!((of(0).base_color.truncate(), of(0).shininess, of(0).emissive), (Vec3::X, 20.0, Vec3::Y));
    assert!((of(0).specular - 0.5).abs() < 1e-6);
    assert_eq!(*of(1), Material { specular: 0.75, ..Material::default() });
}

#[test]
fn a_missing_camera_and_light_are_made_and_noted() {
    let opened = open(BOX);
    assert_eq!(opened.scene.lights.len(), 1);
    assert!(opened.notes[0].starts_with("no camera") && opened.notes[1].starts_with("no light"), "{:?}", opened.notes);
}

#[test]
fn sixteen_hundred_boxes_of_different_colours_are_one_mesh() {
    let one = |i: usize| {
        format!("[[model]]\nprimitive = 'box'\nsize = [1, {i}, 1]\nmaterial = {{ base_color = [0, 0, {i}] }}\n")
    };
    let scene = open(&(1..=1600).map(one).collect::<String>()).scene;
    assert_eq!((scene.meshes.len(), scene.materials.len(), scene.instances.len()), (1, 1600, 1600));
}

#[test]
fn files_at_hand_are_a_scene_with_all_that_it_names() {
    let scene = "[[model]]\npath = \"models/a.obj\"\n[[model]]\npath = \"models/../models/a.obj\"\n";
    let mut files = umbrage_io::Bytes::new();
    files.insert("room.scene.toml".into(), scene.into());
    let missing = umbrage_io::open_bytes("room.scene.toml", &files).unwrap_err().to_string();
    assert!(
        missing.contains("models/a.obj: is not among") && missing.contains("give `models/a.obj` together"),
        "{missing}"
    );
    files.insert("a.obj".into(), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".into());
    let opened = umbrage_io::open_bytes("room.scene.toml", &files).unwrap();
    assert_eq!((opened.scene.meshes.len(), opened.scene.instances.len()), (1, 2));
    assert_eq!(opened.scene.name, "room");
    let none = umbrage_io::open_bytes("b.scene.toml", &files).unwrap_err().to_string();
    assert!(none.contains("b.scene.toml: is not among"), "{none}");
}

/// The environment of a scene file with this table, beside a folder of pictures.
fn environment(table: &str, dir: &Path) -> Result<umbrage_core::Environment, String> {
    let text = format!("[environment]\n{table}\n[[model]]\nprimitive = \"plane\"\nsize = [1, 1]\n");
    let opened = open_str(&text, dir, "sky.toml").map_err(|e| e.to_string())?;
    assert!(opened.scene.lights.is_empty(), "a light was made up beside the sky");
    opened.scene.environment.ok_or_else(|| "none".to_owned())
}

#[test]
fn every_kind_of_environment_is_read() {
    use umbrage_core::glam::{DVec3, Vec3};
    let dir = tempfile::tempdir().unwrap();
    let pictures = umbrage_core::Image::from_fn(8, 4, |x, y| [x as f32, y as f32, 1.0]);
    umbrage_io::pictures::save_exr_rgb(&dir.path().join("sky.exr"), &pictures).unwrap();
    umbrage_io::pictures::save_exr_rgb(&dir.path().join("one.exr"), &umbrage_core::Image::filled(1, 1, [2.0; 3]))
        .unwrap();
    umbrage_io::pictures::save_exr_rgb(&dir.path().join("cross.exr"), &umbrage_core::Image::filled(12, 16, [3.0; 3]))
        .unwrap();
    let read = |table: &str| environment(table, dir.path()).unwrap();
    let picture = read("path = \"sky.exr\"\nrotate = 90\nintensity = 2");
    // What the picture shows at three quarters, +X, is seen at −Z.
    assert_eq!(picture.radiance(DVec3::NEG_Z), Vec3::new(11.0, 3.0, 2.0));
    assert_eq!(read("path = \"one.exr\"").radiance(DVec3::Y), Vec3::splat(2.0));
    assert_eq!(read("path = \"cross.exr\"").radiance(DVec3::Z), Vec3::splat(3.0));
    assert_eq!(read("color = [0.1, 0.2, 0.3]").radiance(DVec3::X), Vec3::new(0.1, 0.2, 0.3));
    let gradient = read("gradient = { zenith = [1, 1, 1], horizon = [0, 0, 0], nadir = [3, 3, 3] }");
    assert_eq!(gradient.radiance(DVec3::NEG_Y), Vec3::splat(3.0));
    let sky = read("sun-and-sky = { sun = [0.2, 0.5, 0.1], turbidity = 2.5 }");
    assert!(sky.radiance(DVec3::new(0.2, 0.5, 0.1).normalize()).y > 1e4);
}

#[test]
fn wrong_environments_are_refused_with_line_and_remedy() {
    let dir = tempfile::tempdir().unwrap();
    let save = |name: &str, pixel: [f32; 3]| {
        umbrage_io::pictures::save_exr_rgb(&dir.path().join(name), &umbrage_core::Image::filled(4, 2, pixel)).unwrap();
    };
    save("nan.exr", [1.0, f32::NAN, 0.0]);
    save("below.exr", [1.0, -1.0, 0.0]);
    std::fs::write(dir.path().join("text.hdr"), "no picture").unwrap();
    let mut huge = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8192 +X 16384\n".to_vec();
    huge.extend([0; 4096]);
    std::fs::write(dir.path().join("huge.hdr"), huge).unwrap();
    for (table, says) in [
        ("", "exactly one of: path, color, gradient, sun-and-sky"),
        ("color = [1, 1, 1]\npath = \"a.exr\"", "`path` are both given"),
        ("colour = [1, 1, 1]", "unknown key `colour`"),
        ("color = [1, -1, 1]", "must not be negative"),
        ("color = [1, 1, 1]\nintensity = -1", "`intensity` must not be negative"),
        ("color = [1, 1, 1]\nlayout = \"cross\"", "`layout` is for pictures"),
        ("path = \"below.exr\"\nlayout = \"sphere\"", "`sphere` is unknown"),
        ("path = \"below.exr\"\nlayout = \"cross\"", "no cross of a cube's faces"),
        ("path = \"gone.exr\"", "gone.exr: cannot be read"),
        ("path = \"text.hdr\"", "not a picture of a kind"),
        ("path = \"nan.exr\"", "pixel (0, 0); radiance is finite and not negative"),
        ("path = \"below.exr\"", "pixel (0, 0); radiance is finite and not negative"),
        ("path = \"huge.hdr\"", "too large with 16384 × 8192 pixels"),
        ("gradient = { zenith = [1, 1, 1], horizon = [0, 0, 0] }", "`nadir` is missing"),
        ("sun-and-sky = { sun = [0, -1, 0] }", "above the horizon"),
        ("sun-and-sky = { sun = [0, 1, 0], turbidity = 20 }", "turbidity 20"),
        ("sun-and-sky = { sun = [0, 1, 0], ground = [2, 0, 0] }", "what reflects is from 0 to 1"),
    ] {
        let error = environment(table, dir.path()).unwrap_err();
        assert!(error.starts_with("sky.toml:") && error.contains(says), "{table}: {error}");
    }
}

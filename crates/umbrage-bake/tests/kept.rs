//! What is kept on disk, and scenes that are not as they should be.

use glam::{DAffine3, Vec3, Vec4};
use std::fs;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};
use umbrage_bake::{Cache, Error, Key, Settings, bake};
use umbrage_core::{Material, Mesh, Scene, primitive, transfer::Kind};

fn scene() -> Scene {
    let mut scene = Scene::default();
    for (mesh, y) in [(primitive::plane(), 0.0), (primitive::cube(), 0.6)] {
        let (mesh, material) = (scene.add_mesh(mesh), scene.add_material(Material::default()));
        scene.place(mesh, material, DAffine3::from_translation(glam::DVec3::Y * y));
    }
    scene
}

fn settings() -> Settings {
    Settings { kind: Kind::Interreflected { bounces: 1 }, rays: 4, detail: 40.0, ..Settings::default() }
}

fn on(_: u64, _: u64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

#[test]
fn a_bake_is_kept_and_found_and_made_anew_where_it_is_damaged() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("new");
    let (cache, scene, settings) = (Cache::new(&folder), scene(), settings());
    let first = cache.bake(&scene, &settings, &on).unwrap();
    assert!(!first.was_kept && first.notes.is_empty());
    assert_eq!(first.transfer, bake(&scene, &settings, &on).unwrap());
    let again = cache.bake(&scene, &settings, &|_, _| ControlFlow::Break(())).unwrap();
    assert!(again.was_kept && again.transfer == first.transfer);
    // Truncated, changed, of another scene, and no transfer at all.
    let whole = fs::read(&first.path).unwrap();
    let mut changed = whole.clone();
    changed[100] ^= 1;
    let other = Settings { rays: 5, ..settings };
    let foreign = fs::read(cache.bake(&scene, &other, &on).unwrap().path).unwrap();
    for wrong in [&whole[..whole.len() / 2], &changed, &foreign, b"", b"no transfer"] {
        fs::write(&first.path, wrong).unwrap();
        let anew = cache.bake(&scene, &settings, &on).unwrap();
        assert!(!anew.was_kept && anew.transfer == first.transfer);
        assert!(anew.notes[0].contains("damaged") && anew.notes[0].contains("made anew"), "{:?}", anew.notes);
        assert_eq!(fs::read(&first.path).unwrap(), whole);
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 2, "something was left beside the two transfers");
}

#[test]
fn a_stopped_bake_is_continued_to_the_same_bits() {
    let place = tempfile::tempdir().unwrap();
    let (cache, scene, settings) = (Cache::new(place.path()), scene(), settings());
    let whole = bake(&scene, &settings, &on).unwrap();
    let unfinished = cache.unfinished_path(Key::new(&scene, &settings));
    let (mut stops, mut steps) = (0, 0);
    let finished = loop {
        let calls = AtomicU32::new(0);
        let stop_at_second = |_: u64, _: u64| match calls.fetch_add(1, Ordering::Relaxed) {
            0 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        };
        match cache.bake(&scene, &settings, &stop_at_second) {
            Ok(kept) => break kept,
            Err(error) => assert!(matches!(error, Error::Stopped) && error.to_string().contains("continues")),
        }
        stops += 1;
        steps += calls.load(Ordering::Relaxed);
        assert!(unfinished.exists() && stops < 100);
    };
    assert!(stops > 2 && steps == 2 * stops, "{stops} stops");
    assert!(finished.notes[0].contains("continued"), "{:?}", finished.notes);
    assert_eq!(finished.transfer, whole);
    assert!(!unfinished.exists());
    // What is damaged of an unfinished one is begun anew.
    fs::remove_file(&finished.path).unwrap();
    fs::write(&unfinished, b"half a file").unwrap();
    let anew = cache.bake(&scene, &settings, &on).unwrap();
    assert!(anew.notes[0].contains("damaged") && anew.transfer == whole);
}

#[test]
fn a_folder_that_is_none_is_an_error_that_names_it() {
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("file");
    fs::write(&file, b"x").unwrap();
    let error = Cache::new(&file).bake(&scene(), &settings(), &on).unwrap_err().to_string();
    assert!(error.contains("file"), "{error}");
}

#[test]
fn what_determines_a_transfer_changes_its_key_and_nothing_else_does() {
    let (mut scene, settings) = (scene(), settings());
    let key = Key::new(&scene, &settings);
    scene.name.push('x');
    scene.camera.near *= 2.0;
    assert_eq!(Key::new(&scene, &settings), key);
    let mut colored = scene.clone();
    colored.materials[0].base_color.x = 0.3;
    scene.meshes[1].positions[2].y += 1e-6;
    assert!(![Key::new(&colored, &settings), Key::new(&scene, &settings)].contains(&key));
}

#[test]
fn odd_scenes_give_numbers_or_errors() {
    let mut odd = scene();
    odd.meshes.push(Mesh::default());
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::X * 2.0, Vec3::Z, Vec3::NAN, Vec3::Y];
    // No normals, an open triangle, one without area, one with NaN, one out of range.
    odd.meshes.push(Mesh { positions, indices: vec![0, 1, 3, 0, 1, 2, 0, 4, 5, 7, 8, 9], ..Mesh::default() });
    odd.place(2, 99, DAffine3::IDENTITY);
    odd.place(3, 0, DAffine3::from_scale(glam::DVec3::new(-1.0, 1.0, 1.0)));
    let transfer = bake(&odd, &settings(), &on).unwrap();
    assert!(transfer.is_whole() && transfer.meshes.len() == 3);
    let mut vector = [0.0_f32; 75];
    for mesh in &transfer.meshes {
        for point in 0..mesh.point_count() {
            mesh.stored.read(point, &mut vector);
            assert!(vector.iter().all(|value| value.is_finite()), "{} {point}", mesh.instance);
        }
    }
    assert_eq!(bake(&Scene::default(), &settings(), &on).unwrap().meshes, []);

    let said = |scene: &Scene, settings: &Settings| bake(scene, settings, &on).unwrap_err().to_string();
    let mut bright = scene();
    bright.materials[0].base_color = Vec4::new(1.2, 0.5, 0.5, 1.0);
    assert!(said(&bright, &settings()).contains("material 0"), "{}", said(&bright, &settings()));
    assert!(bake(&bright, &Settings { kind: Kind::Shadowed, ..settings() }, &on).is_ok());
    assert!(said(&scene(), &Settings { rays: 0, ..settings() }).contains("65,536"));
    assert!(said(&scene(), &Settings { detail: f64::NAN, ..settings() }).contains("4096"));
    odd.instances[0].mesh = 77;
    assert!(said(&odd, &settings()).contains("mesh 77"));
}

//! The scenes and models that come with the references, where they are present: `UMBRAGE_SHARED`
//! names the folder, else it lies beside the workspace.

use std::path::{Path, PathBuf};
use std::time::Instant;
use umbrage_io::stored::StoredReference;

/// The folder. These tests are ignored by name where it may be missing; `cargo xtask test` runs
/// them where it is there.
fn shared() -> PathBuf {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let dir = std::env::var_os("UMBRAGE_SHARED").map_or_else(beside, PathBuf::from);
    assert!(dir.join("references").is_dir(), "{} has no references; set UMBRAGE_SHARED", dir.display());
    dir
}

fn files(dir: &Path, ending: &str) -> Vec<PathBuf> {
    let mut files: Vec<_> = std::fs::read_dir(dir)
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.to_string_lossy().ends_with(ending))
        .collect();
    files.sort();
    assert!(!files.is_empty(), "no {ending} in {}", dir.display());
    files
}

#[test]
#[ignore = "needs the shared references"]
fn every_scene_file_opens_without_a_note() {
    let dir = shared();
    for folder in ["references/scenes", "scenes"] {
        for file in files(&dir.join(folder), ".scene.toml") {
            let start = Instant::now();
            let opened = umbrage_io::open(&file).unwrap_or_else(|e| panic!("{e}"));
            let scene = &opened.scene;
            println!(
                "{}: {} triangles, {} instances of {} meshes, {} materials, {} lights, {:.1} ms",
                scene.name,
                scene.triangle_count(),
                scene.instances.len(),
                scene.meshes.len(),
                scene.materials.len(),
                scene.lights.len(),
                start.elapsed().as_secs_f64() * 1e3
            );
            assert!(opened.notes.is_empty(), "{}: {:?}", file.display(), opened.notes);
        }
    }
}

#[test]
#[ignore = "needs the shared references"]
fn scenes_have_the_triangles_of_their_references() {
    let dir = shared();
    for file in files(&dir.join("references/scenes"), ".scene.toml") {
        let name = file.file_name().unwrap().to_string_lossy().replace(".scene.toml", ".json");
        let json = std::fs::read_to_string(dir.join("references").join(name)).unwrap();
        let (_, after) = json.split_once("\"triangles\":").unwrap();
        let wanted: usize = after.split(',').next().unwrap().trim().parse().unwrap();
        assert_eq!(umbrage_io::open(&file).unwrap().scene.triangle_count(), wanted, "{}", file.display());
    }
}

#[test]
#[ignore = "needs the shared references"]
fn the_city_shares_its_box() {
    let dir = shared();
    let scene = umbrage_io::open(&dir.join("references/scenes/city.scene.toml")).unwrap().scene;
    assert!(scene.meshes.len() <= 2 && scene.instances.len() >= 1600, "{} meshes", scene.meshes.len());
}

#[test]
#[ignore = "needs the shared references"]
fn models_open_with_all_their_triangles() {
    let dir = shared();
    for (name, triangles) in
        [("stanford-bunny", 69_451), ("teapot", 6_320), ("suzanne", 968), ("fandisk", 12_946), ("spot", 5_856)]
    {
        let start = Instant::now();
        let opened = umbrage_io::open(&dir.join(format!("data/{name}.obj"))).unwrap_or_else(|e| panic!("{e}"));
        println!("{name}: {:.1} ms, {:?}", start.elapsed().as_secs_f64() * 1e3, opened.notes);
        assert_eq!(opened.scene.triangle_count(), triangles, "{name}");
    }
}

#[test]
#[ignore = "needs the shared references"]
fn every_stored_reference_opens_and_fits_its_scene() {
    let dir = shared();
    let dir = dir.join("references");
    let stored = umbrage_io::stored::list(&dir).unwrap();
    assert!(stored.len() >= 15 && stored["bunny"] == [0, 1], "{stored:?}");
    for (name, lights) in stored {
        for light in lights {
            let r = StoredReference::open(&dir, &name, light).unwrap_or_else(|e| panic!("{e}"));
            let scene = umbrage_io::open(&r.scene).unwrap().scene;
            let camera = &scene.camera;
            assert!(camera.eye.distance(r.camera.eye) < 1e-12, "{name}: {:?}", r.camera);
            assert!((camera.axes()[2] - r.camera.forward).length() < 1e-12, "{name}: {:?}", r.camera);
            let largest = r.model.data.iter().max().copied().unwrap();
            assert!(scene.instances.iter().any(|i| i.model == largest as usize), "{name}: no model {largest}");
            let seen = |i: usize| r.depth.data[i] > 0.0 && glam::Vec3::from(r.normal.data[i]).is_normalized();
            let scored = (0..r.mask.data.len()).filter(|&i| r.mask.data[i]);
            assert!(scored.clone().count() > 50_000, "{name}: {} pixels are scored", scored.count());
            assert!(scored.clone().all(|i| seen(i) && r.model.data[i] >= 0), "{name}: nothing is seen where scored");
        }
    }
    let message = |scene: &str, light| StoredReference::open(&dir, scene, light).unwrap_err().to_string();
    assert!(message("buny", 0).ends_with("did you mean `bunny`?"));
    assert!(message("bunny", 7).ends_with("it has lights [0, 1]"));
}

#[test]
#[ignore = "needs the shared references"]
fn gltf_files_open() {
    let dir = shared();
    // Triangles, instances, textures, height, notes apart from those on camera and light.
    for (name, triangles, instances, textures, height, notes) in [
        ("CornellBox.glb", 36, 6, 0, 548.8, 1),
        ("Cubes.glb", 36, 3, 0, 5.53, 0),
        ("Fox.glb", 576, 1, 1, 79.03, 1),
        ("FlightHelmet/FlightHelmet.gltf", 94_722, 6, 5, 0.716, 1),
    ] {
        let opened = umbrage_io::open(&dir.join("data/gltf").join(name)).unwrap_or_else(|e| panic!("{e}"));
        let scene = &opened.scene;
        let counts = (scene.triangle_count(), scene.instances.len(), scene.textures.len());
        assert_eq!(counts, (triangles, instances, textures), "{name}");
        let got = scene.bounds().size().y;
        assert!((got / height - 1.0).abs() < 1e-3, "{name}: {got} m high instead of {height}");
        let own = opened.notes.iter().filter(|n| n.contains(name)).count();
        assert_eq!(own, notes, "{name}: {:?}", opened.notes);
    }
}

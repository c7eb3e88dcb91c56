//! The scenes and models that come with the references, where they are present: `UMBRAGE_SHARED` names the folder, else
//! it lies beside the workspace.

use std::path::{Path, PathBuf};
use std::time::Instant;

/// The folder, or `None` with a line that says which test was skipped.
fn shared(test: &str) -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let dir = std::env::var_os("UMBRAGE_SHARED").map_or_else(beside, PathBuf::from);
    if !dir.join("references").is_dir() {
        println!("skipped {test}: {} does not exist; set UMBRAGE_SHARED", dir.display());
        return None;
    }
    Some(dir)
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
fn every_scene_file_opens_without_a_note() {
    let Some(dir) = shared("every_scene_file_opens_without_a_note") else { return };
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
fn scenes_have_the_triangles_of_their_references() {
    let Some(dir) = shared("scenes_have_the_triangles_of_their_references") else { return };
    for file in files(&dir.join("references/scenes"), ".scene.toml") {
        let name = file.file_name().unwrap().to_string_lossy().replace(".scene.toml", ".json");
        let json = std::fs::read_to_string(dir.join("references").join(name)).unwrap();
        let (_, after) = json.split_once("\"triangles\":").unwrap();
        let wanted: usize = after.split(',').next().unwrap().trim().parse().unwrap();
        assert_eq!(umbrage_io::open(&file).unwrap().scene.triangle_count(), wanted, "{}", file.display());
    }
}

#[test]
fn the_city_shares_its_box() {
    let Some(dir) = shared("the_city_shares_its_box") else { return };
    let scene = umbrage_io::open(&dir.join("references/scenes/city.scene.toml")).unwrap().scene;
    assert!(scene.meshes.len() <= 2 && scene.instances.len() >= 1600, "{} meshes", scene.meshes.len());
}

#[test]
fn models_open_with_all_their_triangles() {
    let Some(dir) = shared("models_open_with_all_their_triangles") else { return };
    for (name, triangles) in
        [("stanford-bunny", 69_451), ("teapot", 6_320), ("suzanne", 968), ("fandisk", 12_946), ("spot", 5_856)]
    {
        let start = Instant::now();
        let opened = umbrage_io::open(&dir.join(format!("data/{name}.obj"))).unwrap_or_else(|e| panic!("{e}"));
        println!("{name}: {:.1} ms, {:?}", start.elapsed().as_secs_f64() * 1e3, opened.notes);
        assert_eq!(opened.scene.triangle_count(), triangles, "{name}");
    }
}

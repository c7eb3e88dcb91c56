//! Techniques of radiance in `compare`, `sweep` and `bench`. Needs a graphics adapter.

use std::path::Path;
use umbrage::{Answer, Gpu, Registry};
use umbrage_report::record::Status;
use umbrage_report::{Bench, Choice, Compare, Moving, Silent, Source, Sweep, Vary};

fn gpu() -> Gpu {
    Gpu::request(None).unwrap_or_else(|e| panic!("this test needs a graphics adapter: {e}"))
}

fn choices(names: &[&str]) -> Vec<Choice> {
    let names: Vec<String> = names.iter().map(|name| (*name).to_string()).collect();
    Choice::list(&Registry::default(), &names, &[]).unwrap()
}

/// A small courtyard, and the number of its sky.
fn scenes() -> Vec<(Source, Vec<usize>)> {
    let source = Source::open("courtyard:0.1").unwrap();
    let lights = source.lights(None, &[Answer::Radiance]).unwrap();
    vec![(source, lights)]
}

const PLAIN: &str = "prt:order=3:detail=16:bake-samples=16";
const REFLECTED: &str = "prt:order=3:detail=16:bake-samples=16:transfer=interreflected:bounces=1";

fn compare(cache: &Path) -> Compare {
    Compare {
        scenes: scenes(),
        choices: choices(&[REFLECTED, PLAIN, "pcf"]),
        size: (40, 30),
        samples: 64,
        reference: None,
        truth_cache: Some(cache.to_path_buf()),
        bake_cache: Some(cache.to_path_buf()),
        frames: 1,
        still: 0,
        command: Vec::new(),
    }
}

#[test]
fn each_is_held_against_paths_of_as_many_bounces() {
    let (gpu, place) = (gpu(), tempfile::tempdir().unwrap());
    let mut report = compare(place.path()).run(&gpu, &Silent).unwrap().report;
    // Two truths and two bakes are kept, and found again.
    let files = || std::fs::read_dir(place.path()).unwrap().count();
    assert_eq!(files(), 4);
    let again = compare(place.path()).run(&gpu, &Silent).unwrap().report;
    assert_eq!(files(), 4);
    let lights = report.scenes.remove(0).lights;
    assert_eq!(lights.iter().map(|light| (light.light, light.kind)).collect::<Vec<_>>(), [(2, "environment"); 2]);
    for (light, (bounces, same)) in lights.iter().zip([("0 bounces", 0), ("1 bounces", 1)]) {
        assert!(light.reference.source.ends_with(bounces), "{}", light.reference.source);
        let found = light.results[0].radiance.as_ref().unwrap();
        // Few functions, few vertices, few rays; noise of the truth is a part of it.
        assert!(found.relative_mae.is_some_and(|mae| (0.01..0.3).contains(&mae)), "{found:?}");
        assert!(found.flip > 0.0 && light.results[0].pictures.contains_key("error"), "{found:?}");
        let before = &again.scenes[0].lights[same];
        assert_eq!(before.results[0].radiance.as_ref().unwrap().relative_mae, found.relative_mae);
        assert_eq!(before.reference.seconds, light.reference.seconds, "it was traced again");
    }
    let refused = &lights[0].results[1];
    assert_eq!((refused.status, lights[1].results.len()), (Status::Unsupported, 1));
    assert!(refused.reason.as_ref().is_some_and(|reason| reason.contains("choose prt")), "{:?}", refused.reason);
}

#[test]
fn it_is_swept_and_timed() {
    let gpu = gpu();
    let sweep = Sweep {
        scenes: scenes(),
        registry: Registry::default(),
        choices: choices(&["prt"]),
        vary: vec![Vary::parse("prt:order=2|4,detail=16,bake-samples=16").unwrap()],
        size: (40, 30),
        samples: 16,
        reference: None,
        truth_cache: None,
        bake_cache: None,
        frames: 1,
        command: Vec::new(),
    };
    let light = sweep.run(&gpu, &Silent).unwrap().report.scenes.remove(0).lights.remove(0);
    assert_eq!(light.results.len(), 2, "{:?}", light.skipped);
    assert!(light.results.iter().all(|r| r.errors["relative_mae"] > 0.0 && r.over_floor_ms.is_some()));
    let bench = Bench {
        scenes: scenes(),
        choices: choices(&[PLAIN]),
        size: (40, 30),
        frames: 1,
        moving: Moving::None,
        path: None,
        samples: 1,
        together: false,
        overlay: false,
        bytes: false,
        churn: 0,
        bake_cache: None,
        command: Vec::new(),
    };
    let light = bench.run(&gpu, &Silent).unwrap().scenes.remove(0).lights.remove(0);
    assert!(light.results.iter().all(|r| r.status == Status::Ok), "{:?}", light.results);
}

//! Shadow rays a second: `cargo run --release --example speed -p umbrage-reference -- SCENE [LIGHT
//! [SAMPLES]]`.
//!
//! Without a scene it is the Stanford bunny of the reference pictures.

use std::path::{Path, PathBuf};
use std::time::Instant;
use umbrage_reference::{Options, Tracer};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let bunny = || references().join("scenes/bunny.scene.toml");
    let path = arguments.next().map_or_else(bunny, PathBuf::from);
    let light = arguments.next().map_or(Ok(0), |a| a.parse::<usize>())?;
    let samples = arguments.next().map_or(Ok(64), |a| a.parse::<u32>())?;

    let scene = umbrage_io::open(&path)?.scene;
    let light = scene.lights.get(light).ok_or("the scene has fewer lights")?;
    let start = Instant::now();
    let tracer = Tracer::new(&scene);
    println!("{}: {} triangles, hierarchy {:.2?}", path.display(), tracer.triangle_count(), start.elapsed());
    let start = Instant::now();
    let geometry = tracer.geometry(&scene.camera, 512, 384);
    println!("512 x 384 primary rays {:.2?}", start.elapsed());

    let threads = std::thread::available_parallelism()?.get();
    for gather in [false, true] {
        let options = Options { samples, gather, ..Options::default() };
        let start = Instant::now();
        let truth = tracer.visibility(&geometry, light, &scene.textures, &options, &|_, _| ());
        let seconds = start.elapsed().as_secs_f64();
        let scored = truth.scored.data.iter().filter(|s| **s).count();
        let all = scored as f64 * f64::from(samples);
        let millions = |n: f64| n / seconds / threads as f64 * 1e-6;
        println!(
            "{}: {seconds:.2} s; millions a second and core: {:.2} tested against triangles, {:.2} decided",
            if gather { "gathered" } else { "one by one" },
            millions(truth.rays as f64),
            millions(all),
        );
    }
    Ok(())
}

fn references() -> PathBuf {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    std::env::var_os("UMBRAGE_SHARED").map_or(beside, PathBuf::from).join("references")
}

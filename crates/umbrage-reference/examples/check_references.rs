//! Holds the tracer against pictures that other software has traced: `cargo run --release --example
//! check_references -p umbrage-reference -- [FOLDER] [SAMPLES] [--pixels]`.
//!
//! One line a light; `--pixels` lists the pixels that are off by more than 0.02. Ends with an error
//! where a picture misses the goal: for soft lights mae ≤ 0.001 and 99.8 % correct at 1024 samples,
//! for hard ones mae ≤ 0.0002.

use std::path::{Path, PathBuf};
use std::time::Instant;
use umbrage_core::Image;
use umbrage_io::stored::{self, StoredReference};
use umbrage_metrics::{Comparison, TOLERANCE, discontinuities, score};
use umbrage_reference::{Options, Tracer, Truth};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let (flags, arguments): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|a| a.starts_with("--"));
    let folder = arguments.first().map_or_else(references, PathBuf::from);
    let samples = arguments.get(1).map_or(Ok(1024), |a| a.parse::<u32>())?;
    println!("| scene | light | scored | mask differs | mae | rmse | correct | off by > 0.02 | largest | seconds |");
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let mut missed = Vec::new();
    for (scene, lights) in stored::list(&folder)? {
        let loaded = umbrage_io::open(&folder.join(format!("scenes/{scene}.scene.toml")))?.scene;
        let tracer = Tracer::new(&loaded);
        for light in lights {
            let stored = StoredReference::open(&folder, &scene, light)?;
            let (width, height) = stored.visibility.size();
            let start = Instant::now();
            let geometry = tracer.geometry(&loaded.camera, width, height);
            let shape = loaded.lights.get(light).ok_or("the scene has fewer lights than there are pictures")?;
            let options = Options { samples, ..Options::default() };
            let truth = tracer.visibility(&geometry, shape, &loaded.textures, &options, &|_, _| ());
            let ours = Checked::new(&truth, &stored)?;
            println!("| {scene} | {light} | {} | {:.1} |", ours.row, start.elapsed().as_secs_f64());
            if flags.iter().any(|f| f == "--pixels") {
                ours.off.iter().for_each(|pixel| println!("{pixel}"));
            }
            let soft = shape.shape.kind().is_soft();
            if ours.mae > if soft { 1e-3 } else { 2e-4 } || ours.correct_pct < 99.8 || ours.mask_differs {
                missed.push(format!("{scene}.light{light}"));
            }
        }
    }
    if missed.is_empty() { Ok(()) } else { Err(format!("goal missed by {}", missed.join(", ")).into()) }
}

/// What came out for one light.
struct Checked {
    row: String,
    off: Vec<String>,
    mae: f64,
    correct_pct: f64,
    mask_differs: bool,
}

impl Checked {
    fn new(truth: &Truth, stored: &StoredReference) -> Result<Self, Failure> {
        let mask_differs = truth.scored.data.iter().zip(&stored.mask.data).filter(|(a, b)| a != b).count();
        let edge = discontinuities(&stored.depth, &stored.model.map(|&m| m.into()));
        let mask = Image::from_fn(edge.width, edge.height, |x, y| stored.mask[(x, y)] && !edge[(x, y)]);
        let (produced, reference) = (&truth.visibility, &stored.visibility);
        let scores = score(&Comparison { produced, reference, mask: &mask, hard: None, reach: None, contacts: None })?;
        // The band beside discontinuities, too, should be the same for a tracer; its pixels are
        // listed with a mark.
        let (mut off, mut largest, mut off_in_band) = (Vec::new(), 0.0_f64, 0);
        for (x, y) in (0..edge.height).flat_map(|y| (0..edge.width).map(move |x| (x, y))) {
            let d = f64::from(produced[(x, y)]) - f64::from(reference[(x, y)]);
            if stored.mask[(x, y)] {
                largest = largest.max(d.abs());
                if d.abs() > TOLERANCE {
                    off_in_band += usize::from(edge[(x, y)]);
                    let mark = if edge[(x, y)] { ", beside a discontinuity" } else { "" };
                    off.push(format!("  ({x}, {y}): {:.4}, stored {:.4}{mark}", produced[(x, y)], reference[(x, y)]));
                }
            }
        }
        let row = format!(
            "{} | {mask_differs} | {:.6} | {:.6} | {:.3} % | {} + {off_in_band} | {largest:.4}",
            scores.scored_pixels,
            scores.mae,
            scores.rmse,
            scores.correct_pct,
            off.len() - off_in_band,
        );
        Ok(Self { row, off, mae: scores.mae, correct_pct: scores.correct_pct, mask_differs: mask_differs > 0 })
    }
}

fn references() -> PathBuf {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    std::env::var_os("UMBRAGE_SHARED").map_or(beside, PathBuf::from).join("references")
}

//! Holds the path tracer against pictures of radiance that other software has traced: `cargo run
//! --release --example check_radiance -p umbrage-reference -- FOLDER [SAMPLES] [--smooth]`.
//!
//! One line a picture. Stored pictures are shaded by the normals of triangles, those of spheres
//! apart; `--smooth` leaves the normals of vertices to all. Ends with an error where a picture
//! misses the goal: mean luminance within 0.3 %, and no more difference in a pixel than the noise
//! of both explains.

use std::f64::consts::FRAC_2_PI;
use std::path::PathBuf;
use std::time::Instant;
use umbrage_core::{Mesh, Scene};
use umbrage_io::stored::{StoredRadiance, list_radiance};
use umbrage_metrics::luminance;
use umbrage_reference::{PathTracer, RadianceOptions, RadianceTruth, Tracer};

type Failure = Box<dyn std::error::Error>;

/// Of the mean luminance.
const GOAL: f64 = 0.003;

/// Noise explains a mean difference up to this multiple of what it makes where it is spread as the
/// bell curve: its strength is known of the mean pixel alone, and differs from one to another.
const UNEVEN: f64 = 1.15;

fn main() -> Result<(), Failure> {
    let (flags, arguments): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|a| a.starts_with("--"));
    let folder = arguments.first().map(PathBuf::from).ok_or("name a folder of stored references")?;
    let samples = arguments.get(1).map_or(Ok(256), |a| a.parse::<u32>())?;
    println!("| scene | bounces | scored | mean luminance | stored | differs | pixels differ | by noise | seconds |");
    println!("|---|---|---|---|---|---|---|---|---|");
    let mut missed = Vec::new();
    for (name, numbers) in list_radiance(&folder)? {
        let mut scene = umbrage_io::open(&folder.join(format!("scenes/{name}.scene.toml")))?.scene;
        if !flags.iter().any(|f| f == "--smooth") {
            flatten(&mut scene);
        }
        let tracer = Tracer::new(&scene);
        let paths = PathTracer::new(&tracer, &scene)?;
        for bounces in numbers {
            let stored = StoredRadiance::open(&folder, &name, bounces)?;
            let start = Instant::now();
            let geometry = tracer.geometry_where(&scene.camera, &stored.mask);
            let options = RadianceOptions { samples, bounces };
            let truth = paths.radiance((&geometry, &scene.camera), &options, &|_, _| ())?;
            let found = Checked::new(&truth, &stored)?;
            println!("| {name} | {bounces} | {} | {:.1} |", found.row, start.elapsed().as_secs_f64());
            if !found.is_good {
                missed.push(format!("{name}.bounces{bounces}"));
            }
        }
    }
    if missed.is_empty() { Ok(()) } else { Err(format!("goal missed by {}", missed.join(", ")).into()) }
}

/// What came out for one picture.
struct Checked {
    row: String,
    is_good: bool,
}

impl Checked {
    fn new(truth: &RadianceTruth, stored: &StoredRadiance) -> Result<Self, Failure> {
        let (mut ours, mut theirs, mut off, mut count) = (0.0, 0.0, 0.0, 0.0);
        for (i, _) in stored.mask.data.iter().enumerate().filter(|(_, scored)| **scored) {
            let [a, b] = [&truth.radiance.data[i], &stored.radiance.data[i]].map(luminance);
            (ours, theirs, off, count) = (ours + a, theirs + b, off + (a - b).abs(), count + 1.0);
        }
        if theirs <= 0.0 {
            return Err("the stored picture is black".into());
        }
        let differs = ours / theirs - 1.0;
        let noise = FRAC_2_PI.sqrt() * truth.relative_error().hypot(stored.relative_error);
        let row = format!(
            "{count} | {:.6} | {:.6} | {:+.3} % | {:.3} % | {:.3} %",
            ours / count,
            theirs / count,
            100.0 * differs,
            100.0 * off / theirs,
            100.0 * noise,
        );
        Ok(Self { row, is_good: differs.abs() <= GOAL && off / theirs <= UNEVEN * noise })
    }
}

/// Takes the normals of vertices from all meshes but spheres.
fn flatten(scene: &mut Scene) {
    scene.meshes.iter_mut().filter(|mesh| !is_sphere(mesh)).for_each(|mesh| mesh.normals.clear());
}

fn is_sphere(mesh: &Mesh) -> bool {
    let radius = mesh.positions.first().map_or(0.0, |p| p.length());
    let mut vertices = mesh.positions.iter().zip(&mesh.normals);
    radius > 0.0 && vertices.all(|(p, n)| (*p / radius - *n).length() < 1e-4)
}

//! How fast a bake is, and what light costs each frame.
//!
//! `cargo run --release -p umbrage-bake --example speed`

mod body;

use glam::{DQuat, DVec3};
use std::ops::ControlFlow;
use std::time::Instant;
use umbrage_bake::{Settings, bake};
use umbrage_core::Image;
use umbrage_core::harmonics::{Order, project_equirect};
use umbrage_core::transfer::Kind;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (scene, settings) = (body::scene(), Settings::default());
    for kind in [Kind::Unshadowed, Kind::Shadowed, Kind::Interreflected { bounces: 1 }] {
        let (begun, used) = (Instant::now(), cpu_seconds());
        let transfer = bake(&scene, &Settings { kind, ..settings }, &|_, _| ControlFlow::Continue(()))?;
        let (seconds, used) = (begun.elapsed().as_secs_f64(), cpu_seconds() - used);
        let points: usize = transfer.meshes.iter().map(|mesh| mesh.point_count()).sum();
        let passes = match kind {
            Kind::Unshadowed => 0.0,
            Kind::Shadowed => 1.0,
            Kind::Interreflected { bounces } => 1.0 + f64::from(bounces),
        };
        let rays = points as f64 * f64::from(settings.rays) * passes;
        let millions = rays / used / 1e6;
        println!(
            "{kind:?}: {points} points, {seconds:.2} s, {used:.2} s of cores, {millions:.2} M rays a second and core"
        );
    }
    let picture = Image::filled(256, 128, [0.4, 0.5, 0.6]);
    for n in [5, 10] {
        let order = Order::new(n)?;
        let ms = fastest(20, || project_equirect(order, &picture));
        println!("projection of 256×128, order {n}: {ms:.3} ms");
        let light = project_equirect(order, &picture);
        let mut angle = 0.0;
        let ms = fastest(200, || {
            angle += 0.1;
            light.rotated(DQuat::from_axis_angle(DVec3::new(0.6, 0.64, 0.48), angle))
        });
        println!("rotation of order {n}: {ms:.4} ms");
    }
    Ok(())
}

/// Seconds that all cores together have spent on this program; 0 where the system does not tell as
/// Linux does. On a machine that others use, too, this is what compares.
fn cpu_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let numbers = text.rsplit(')').next().unwrap_or_default().split_whitespace();
    let ticks: f64 = numbers.skip(11).take(2).filter_map(|n| n.parse::<f64>().ok()).sum();
    ticks / 100.0
}

/// Milliseconds of the fastest of so many.
fn fastest<T>(count: u32, mut run: impl FnMut() -> T) -> f64 {
    let one = |_| {
        let begun = Instant::now();
        std::hint::black_box(run());
        begun.elapsed().as_secs_f64() * 1e3
    };
    (0..count).map(one).fold(f64::INFINITY, f64::min)
}

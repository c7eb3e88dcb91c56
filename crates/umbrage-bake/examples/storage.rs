//! What each way to store costs in bytes and errors, as a table for `benchmarks/`.
//!
//! `cargo run --release -p umbrage-bake --example storage`

mod body;

use glam::{DVec3, Vec3};
use std::ops::ControlFlow;
use std::time::Instant;
use umbrage_bake::{Loss, Settings, Storage, bake, radiance, vectors};
use umbrage_core::harmonics::{Light, Order, project};
use umbrage_core::transfer::BakedMesh;

/// Orders that are stored.
const ORDERS: [u32; 2] = [5, 10];

/// Ways to store them.
const WAYS: [&str; 13] = [
    "full",
    "bytes",
    "pca:4",
    "pca:8",
    "vq:64",
    "vq:256",
    "vq:1024",
    "cpca:64:1",
    "cpca:64:2",
    "cpca:64:3",
    "cpca:64:4",
    "cpca:64:8",
    "cpca:256:4",
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rays = std::env::args().nth(1).map_or(Ok(512), |text| text.parse())?;
    let truth = baked(Order::MAX, rays * 2)?;
    let wanted = radiance(&truth, Order::MAX, &sky());
    println!("{} vertices; truth: order 10, {} rays\n", truth.mesh.positions.len(), rays * 2);
    for n in ORDERS {
        let order = Order::new(n)?;
        let mesh = baked(order, rays)?;
        println!("## Order {n}\n");
        println!(
            "| storage | bytes | of full | loss of vectors | rms error of radiance | over full's | largest difference to full | encode s | all points ms |"
        );
        println!("|---|---|---|---|---|---|---|---|---|");
        table(order, &mesh, &wanted)?;
        println!();
    }
    Ok(())
}

fn table(order: Order, mesh: &BakedMesh, wanted: &[Vec3]) -> Result<(), String> {
    let (all, len) = (vectors(mesh, order), mesh.vector_len(order));
    let full = radiance(mesh, order, &sky());
    let full_error = rms(&full, wanted);
    for text in WAYS {
        let begun = Instant::now();
        let stored = text.parse::<Storage>()?.encode(&all, len);
        let encoding = begun.elapsed().as_secs_f64();
        let mesh = BakedMesh { stored, ..mesh.clone() };
        let begun = Instant::now();
        let found = radiance(&mesh, order, &sky());
        let lighting = begun.elapsed().as_secs_f64() * 1e3;
        let error = rms(&found, wanted);
        let most = found.iter().zip(&full).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f32::max);
        let bytes = mesh.stored.bytes();
        println!(
            "| `{text}` | {bytes} | {:.3} | {:.4} | {error:.4} | {:+.1} % | {most:.3} | {encoding:.1} | {lighting:.1} |",
            bytes as f64 / (4 * all.len()) as f64,
            Loss::of(&mesh.stored, &all, len).relative,
            100.0 * (error / full_error - 1.0),
        );
    }
    Ok(())
}

fn baked(order: Order, rays: u32) -> Result<BakedMesh, umbrage_bake::Error> {
    let settings = Settings { order, rays, ..Settings::default() };
    let transfer = bake(&body::scene(), &settings, &|_, _| ControlFlow::Continue(()))?;
    transfer.meshes.into_iter().next().ok_or_else(|| umbrage_bake::Error::Scene("no mesh".into()))
}

/// A blue sky over brown ground with a soft sun, the brighter the closer to it.
fn sky() -> Light {
    let sun = DVec3::new(0.5, 0.7, 0.4).normalize();
    project(Order::MAX, 80, |s| {
        let up = (0.5 + 4.0 * s.y).clamp(0.0, 1.0) as f32;
        let ground = Vec3::new(0.25, 0.2, 0.15);
        ground.lerp(Vec3::new(0.35, 0.55, 0.9), up)
            + Vec3::new(9.0, 8.0, 6.0) * (40.0 * (s.dot(sun) - 1.0)).exp() as f32
    })
}

/// Root mean square difference over that of the truth itself.
fn rms(found: &[Vec3], wanted: &[Vec3]) -> f64 {
    let sum = |all: &mut dyn Iterator<Item = Vec3>| all.map(|v| f64::from(v.length_squared())).sum::<f64>();
    let off = sum(&mut found.iter().zip(wanted).map(|(a, b)| *a - *b));
    (off / sum(&mut wanted.iter().copied())).sqrt()
}

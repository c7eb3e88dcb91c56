//! The built-in city at night under 64 street lamps, whose maps share one budget of bytes.
//!
//!     cargo run --release -p umbrage-renderer --example many_lights -- lamps.png
//!
//! Prints what 1, 8 and 64 lamps cost, and writes the picture of all.

mod city;

use city::{BUDGET, Measured, city, measure};
use std::path::Path;
use umbrage::Gpu;

/// Pixels across and down.
const SIZE: (u32, u32) = (480, 270);

/// Frames that are timed.
const FRAMES: u32 = 20;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::request(None)?;
    println!("{}, maps of at most {} MiB", gpu.adapter().name, BUDGET >> 20);
    for lamps in [1, 8, 64] {
        let scene = city(1.0, lamps).ok_or("there is no city")?;
        let Measured { picture, first_ms, still_ms, drawn_ms, whole_ms, bytes, sizes } =
            measure(&gpu, &scene, SIZE, FRAMES)?;
        let mib = bytes as f64 / f64::from(1 << 20);
        println!(
            "{lamps} lamps: {still_ms:.1} ms a frame, {drawn_ms:.1} ms with all maps drawn, {whole_ms:.1} ms with every \
             lamp shaded everywhere, {first_ms:.0} ms the first; {mib:.1} MiB in maps of {sizes:?}"
        );
        if let Some(file) = std::env::args().nth(1).filter(|_| lamps == 64) {
            umbrage_io::pictures::save_png(Path::new(&file), &picture)?;
        }
    }
    Ok(())
}

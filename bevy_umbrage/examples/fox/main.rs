//! A fox walks in the sun and past a lamp, without a window.
//!
//!     cargo run --example fox -- --shadows umbrage,bevy,none --frames 20 --out fox.png [FOX.glb]
//!
//! Renders so many frames with the shadows of each kind in turn, prints the time that a frame took,
//! and writes the last moment with each as `fox-umbrage.png` and so on. Without a glTF file, whose
//! second animation is played, the fox is one made in code. `--sun TECHNIQUE` and
//! `--lamp TECHNIQUE` say what umbrage's lights use. `--truth SAMPLES` traces rays for the last
//! moment and prints how far the pictures are from it.

mod stage;
#[cfg(test)]
mod tests;
mod truth;

use bevy::prelude::*;
use stage::{Shadows, Stage, Wanted};
use std::path::PathBuf;
use std::time::Instant;

fn main() -> Result {
    let options = Options::read(std::env::args().skip(1))?;
    let mut stage = Stage::new(&options.wanted)?;
    let mut rounds: Vec<(Shadows, Vec<f64>)> = options.shadows.iter().map(|kind| (*kind, Vec::new())).collect();
    // Kinds take turns, so that whatever else the machine does is shared among them.
    for _ in 0..options.frames.div_ceil(BLOCK) {
        for (kind, times) in &mut rounds {
            stage.choose(*kind);
            for frame in 0..WARM_UP + BLOCK {
                let start = Instant::now();
                stage.frame();
                if frame >= WARM_UP {
                    times.push(start.elapsed().as_secs_f64() * 1e3);
                }
            }
            println!("{kind}: {}", stage.gpu_times());
        }
    }
    stage.freeze();
    let mut pictures = Vec::new();
    for (kind, times) in &mut rounds {
        times.sort_by(f64::total_cmp);
        let picture = stage.picture(*kind)?;
        let path = options.out.with_file_name(format!("{}-{kind}.png", stem(&options.out)));
        picture.save(&path)?;
        println!("{kind}: {:.1} ms a frame (median of {}), {}", times[times.len() / 2], times.len(), path.display());
        pictures.push((*kind, picture));
    }
    if options.truth > 0 {
        truth::compare(&mut stage, options.truth, &pictures, &options.out)?;
    }
    Ok(())
}

/// Frames that are drawn, but not timed, after each change of shadows; then frames that are.
const WARM_UP: u32 = 3;
const BLOCK: u32 = 5;

struct Options {
    wanted: Wanted,
    shadows: Vec<Shadows>,
    frames: u32,
    truth: u32,
    out: PathBuf,
}

impl Options {
    fn read(mut arguments: impl Iterator<Item = String>) -> Result<Self> {
        let (wanted, shadows) = (Wanted::default(), vec![Shadows::Umbrage]);
        let mut options = Self { wanted, shadows, frames: 10, truth: 0, out: "fox.png".into() };
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().ok_or(format!("{argument} lacks a value"));
            match argument.as_str() {
                "--shadows" => options.shadows = value()?.split(',').map(str::parse).collect::<Result<_, _>>()?,
                "--frames" => options.frames = value()?.parse()?,
                "--truth" => options.truth = value()?.parse()?,
                "--out" => options.out = value()?.into(),
                "--sun" => options.wanted.sun = value()?,
                "--lamp" => options.wanted.lamp = value()?,
                "--size" => {
                    let text = value()?;
                    let (width, height) = text.split_once('x').ok_or("a size is WIDTHxHEIGHT")?;
                    options.wanted.size = (width.parse()?, height.parse()?);
                }
                other if other.starts_with("--") => return Err(format!("there is no option {other}").into()),
                file => options.wanted.model = Some(std::path::absolute(file)?),
            }
        }
        Ok(options)
    }
}

fn stem(path: &std::path::Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

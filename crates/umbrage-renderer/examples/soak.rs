//! All techniques for a while, with everything moving, sizes changing, lights coming and going: for
//! `cargo xtask soak`. Memory has to stay level, and pictures at the end have to be those of a
//! renderer made anew.
//!
//! A driver may keep something of every frame: what empty frames cost is measured first, by itself.

use std::error::Error;
use std::time::{Duration, Instant};
use std::{env, fs};
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, LightShape, Scene, scenes};
use umbrage::{Gpu, baseline, techniques};
use umbrage_renderer::{LightPass, Renderer};

type Outcome<T> = Result<T, Box<dyn Error>>;

const SIZES: [(u32, u32); 3] = [(160, 120), (97, 61), (200, 150)];

/// Frames of each technique before it is another's turn.
const TURN: u32 = 12;

/// Kilobytes that an allocator may hold more at one time than at another, whatever is drawn.
const NOISE_KB: f64 = 8192.0;

/// Share of white by which pictures may differ on average: drivers may round in another order.
const TOLERANCE: f64 = 1e-4;

fn main() -> Outcome<()> {
    let minutes: f64 = env::args().nth(1).ok_or("name a number of minutes")?.parse()?;
    let gpu = Gpu::request(None)?;
    println!("adapter: {} ({})", gpu.adapter().name, gpu.adapter().driver);
    let scene = (scenes::find("primitives").ok_or("the scene is gone")?.build)(0.5);
    let time = Duration::from_secs_f64(60.0 * minutes);
    let empty = soak(&mut Soak::new(&gpu, &scene, false)?, time.mul_f64(0.2))?;
    println!("frames without a technique: {empty}");
    let mut all = Soak::new(&gpu, &scene, true)?;
    let growth = soak(&mut all, time.mul_f64(0.8))?;
    println!("all techniques: {growth}");
    let off = all.off_from_new()?;
    println!("pictures at the end: off by {off:.1e} at most");
    let noise_kb = NOISE_KB / growth.frames as f64;
    if growth.of_process_kb > 1.5 * empty.of_process_kb.max(0.0) + noise_kb {
        return Err("memory of the process grows with techniques".into());
    }
    if growth.of_gpu_kb > 0.0 {
        return Err("memory of the GPU grows with techniques".into());
    }
    if off > TOLERANCE {
        return Err("pictures at the end are not those of a renderer made anew".into());
    }
    Ok(())
}

/// Kilobytes a frame.
struct Growth {
    of_process_kb: f64,
    of_gpu_kb: f64,
    frames: u64,
}

impl std::fmt::Display for Growth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { of_process_kb, of_gpu_kb, frames } = self;
        write!(f, "{of_process_kb:.1} kB of the process and {of_gpu_kb:.2} kB of the GPU a frame, {frames} frames")
    }
}

/// Draws rounds until the time is over; what grows is counted from the third one on.
fn soak(soak: &mut Soak, time: Duration) -> Outcome<Growth> {
    let start = Instant::now();
    soak.round()?;
    soak.round()?;
    let (frames, process, of_gpu) = (soak.frame, process_kb(), soak.gpu_kb());
    while start.elapsed() < time || soak.frame == frames {
        soak.round()?;
    }
    let drawn = soak.frame - frames;
    let per_frame = |before: f64, after: f64| (after - before) / drawn as f64;
    Ok(Growth {
        of_process_kb: per_frame(process, process_kb()),
        of_gpu_kb: per_frame(of_gpu, soak.gpu_kb()),
        frames: drawn,
    })
}

/// Memory of this process; 0 where the system does not say.
fn process_kb() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0.0)
}

struct Soak {
    gpu: Gpu,
    scene: Scene,
    renderer: Renderer,
    has_techniques: bool,
    frame: u64,
}

impl Soak {
    fn new(gpu: &Gpu, scene: &Scene, has_techniques: bool) -> Outcome<Self> {
        let resting = LightPass { light: 0, technique: baseline::floor(gpu) };
        let renderer = Renderer::new(gpu, scene, SIZES[0].0, SIZES[0].1, vec![resting])?;
        Ok(Self { gpu: gpu.clone(), scene: scene.clone(), renderer, has_techniques, frame: 0 })
    }

    fn gpu_kb(&self) -> f64 {
        let counters = self.gpu.device.get_internal_counters().hal;
        (counters.buffer_memory.read() + counters.texture_memory.read()) as f64 / 1024.0
    }

    /// Every technique has its turn, with another light each time.
    fn round(&mut self) -> Outcome<()> {
        for (number, info) in techniques().iter().enumerate() {
            let technique =
                if self.has_techniques { info.default_settings().make(&self.gpu)? } else { baseline::floor(&self.gpu) };
            let light = number % self.scene.lights.len();
            self.renderer.exchange(0, LightPass { light, technique })?;
            for _ in 0..TURN {
                self.draw()?;
            }
        }
        let resting = LightPass { light: 0, technique: baseline::floor(&self.gpu) };
        self.renderer.exchange(0, resting)?;
        self.renderer.resize(SIZES[0].0, SIZES[0].1)?;
        self.renderer.frame(&self.scene.camera)?;
        Ok(self.renderer.wait()?)
    }

    /// A frame with everything a little further.
    fn draw(&mut self) -> Outcome<()> {
        let time = self.frame as f64 * 0.1;
        let shift = 0.2 * DVec3::new(time.sin(), 0.0, time.cos());
        if self.frame.is_multiple_of(5) {
            let (width, height) = SIZES[(self.frame / 5) as usize % SIZES.len()];
            self.renderer.resize(width, height)?;
        }
        for (number, instance) in self.scene.instances.iter().enumerate() {
            let moved = DAffine3::from_translation(shift) * instance.world_from_mesh;
            move_to(&mut self.renderer, number, &moved)?;
        }
        if let Some(LightShape::Point { position } | LightShape::Sphere { position, .. }) =
            self.renderer.light_mut(0).map(|light| &mut light.shape)
        {
            *position += 0.02 * shift;
        }
        let camera = Camera { eye: self.scene.camera.eye + shift, ..self.scene.camera.clone() };
        self.renderer.frame(&camera)?;
        self.renderer.wait()?;
        self.frame += 1;
        Ok(())
    }

    /// Everything back where it was: how far pictures are off those of a renderer made anew.
    fn off_from_new(&mut self) -> Outcome<f64> {
        self.renderer.resize(SIZES[0].0, SIZES[0].1)?;
        for (number, instance) in self.scene.instances.iter().enumerate() {
            move_to(&mut self.renderer, number, &instance.world_from_mesh)?;
        }
        let mut most: f64 = 0.0;
        for info in techniques() {
            let pass =
                || Ok::<_, umbrage::Error>(LightPass { light: 0, technique: info.default_settings().make(&self.gpu)? });
            self.renderer.exchange(0, pass()?)?;
            let mut new = Renderer::new(&self.gpu, &self.scene, SIZES[0].0, SIZES[0].1, vec![pass()?])?;
            self.renderer.frame(&self.scene.camera)?;
            new.frame(&self.scene.camera)?;
            let (old, new) = (self.renderer.color()?, new.color()?);
            let pairs = old.data.as_flattened().iter().zip(new.data.as_flattened());
            let sum: f64 = pairs.map(|(a, b)| f64::from(a.abs_diff(*b)) / 255.0).sum();
            let off = sum / old.data.as_flattened().len() as f64;
            if off > TOLERANCE {
                println!("{}: off by {off:.1e}", info.id);
            }
            most = most.max(off);
        }
        Ok(most)
    }
}

fn move_to(renderer: &mut Renderer, number: usize, world_from_mesh: &DAffine3) -> Result<(), umbrage::Error> {
    match renderer.casters().instance(number) {
        Some(instance) => renderer.casters_mut().move_instance(instance, world_from_mesh),
        None => Ok(()),
    }
}

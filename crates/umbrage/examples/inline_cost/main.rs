//! What a look-up costs in a host's own shader, over what the technique's full-screen pass costs.
//!
//!     cargo run --release -p umbrage --example inline_cost -- ROUNDS [TECHNIQUE …]
//!
//! In each round every technique has a frame: its full-screen pass, then two passes over the same
//! triangles, one without a look-up and one with it. Prints medians over the rounds as a table.

mod host;

use host::Host;
use umbrage::core::{Light, scenes};
use umbrage::{Casters, Gpu, Inline, PassTime, Receivers, Recorder, Settings, Technique, View, VisibilityTarget};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Pixels across and down.
const SIZE: (u32, u32) = (640, 480);

/// A technique and what the host has of it.
struct Case {
    settings: Settings,
    light: usize,
    technique: Box<dyn Technique>,
    /// Follows the first frame.
    inline: Option<(Inline, wgpu::RenderPipeline)>,
    /// Of each round: the full-screen pass, the host's pass without a look-up and with it.
    times: Vec<[f64; 3]>,
}

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let rounds: usize = arguments.next().map_or(Ok(15), |rounds| rounds.parse())?;
    let named: Vec<String> = arguments.collect();
    let gpu = Gpu::request(None)?;
    if !gpu.has(wgpu::Features::TIMESTAMP_QUERY) {
        return Err("this adapter measures no times; choose another one".into());
    }
    let scene = (scenes::find("primitives").ok_or("there is no such scene")?.build)(1.0);
    let host = Host::new(&gpu, &scene, SIZE);
    let casters = Casters::new(&gpu, &scene)?;
    let receivers = Receivers::new(&gpu, &host.depth, Some(&host.normals), SIZE)?;
    let visibility = VisibilityTarget::new(&gpu, SIZE.0, SIZE.1)?;
    let mut recorder = Recorder::new(&gpu);
    let mut cases = cases(&gpu, &named, &scene.lights)?;
    // The first round makes pipelines.
    for round in 0..=rounds {
        for case in &mut cases {
            let camera = scene.camera.view(SIZE.0, SIZE.1);
            let light = &scene.lights[case.light];
            let view = View { camera, receivers: &receivers, casters: &casters, light, textures: &[] };
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut passes = recorder.begin(&mut encoder);
            host.record_gbuffer(&mut passes);
            case.technique.prepare(&gpu, &view)?.record(&mut passes, &visibility)?;
            if case.inline.is_none() {
                let inline = Inline::new(&gpu, case.technique.lend(&gpu)?, 1, "sun")?;
                let pipeline = host.pipeline(&gpu, &inline);
                case.inline = Some((inline, pipeline));
            }
            host.record_shading(&mut passes, "own", None);
            host.record_shading(&mut passes, "inline", case.inline.as_ref().map(|(i, p)| (i.bind_group(), p)));
            passes.finish();
            gpu.queue.submit([encoder.finish()]);
            gpu.wait()?;
            if round > 0 {
                let times = recorder.times();
                case.times.push(["visibility", "own", "inline"].map(|pass| of(&times, pass)));
            }
        }
    }
    println!("{}, medians of {rounds} rounds, ms\n", gpu.adapter().name);
    println!("| technique | light | full screen | host's pass | with the look-up | look-up / full screen |");
    println!("|---|---|---|---|---|---|");
    for case in &cases {
        let [full, own, inline] = [0, 1, 2].map(|i| median(case.times.iter().map(|times| times[i])));
        let ratio = median(case.times.iter().map(|[full, own, inline]| (inline - own) / full));
        let light = scene.lights[case.light].shape.kind().name();
        println!("| `{}` | {light} | {full:.2} | {own:.2} | {inline:.2} | {ratio:.2} |", case.settings);
    }
    Ok(())
}

/// Every technique that lends its look-up under each light, or those that are named.
fn cases(gpu: &Gpu, named: &[String], lights: &[Light]) -> Result<Vec<Case>> {
    let all = || umbrage::techniques().iter().filter(|info| info.is_lent() && info.id != "none").map(|i| i.id.into());
    let named: Vec<String> = if named.is_empty() { all().collect() } else { named.to_vec() };
    let mut cases = Vec::new();
    for name in &named {
        for light in 0..lights.len() {
            let settings = umbrage::parse(name)?;
            let technique = settings.make(gpu)?;
            cases.push(Case { settings, light, technique, inline: None, times: Vec::new() });
        }
    }
    Ok(cases)
}

fn of(times: &[PassTime], pass: &str) -> f64 {
    times.iter().filter(|time| time.pass == pass).map(|time| time.time_ms).sum()
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

//! What a frame of the laboratory takes of the CPU while nothing changes: menus, statistics and
//! settings, from input to triangles.

use eframe::egui::Key;
use egui_kittest::Harness;
use egui_kittest::wgpu::WgpuTestRenderer;
use std::time::Instant;
use umbrage::Registry;
use umbrage_viewer::{Lab, Options, setup};

/// Frames until the first picture is there and the truth has been traced for a while.
const BEFORE: usize = 400;
/// Frames that are timed.
const TIMED: usize = 401;

fn main() {
    let registry = Registry::default();
    let renderer = WgpuTestRenderer::from_setup(setup(None));
    let options = Options { techniques: vec!["pcss".into()], ..Options::default() };
    let builder = Harness::builder().with_size([1280.0, 800.0]).renderer(renderer);
    let mut harness = builder
        .build_eframe(|context| Lab::new(context, &registry, &options).unwrap_or_else(|error| panic!("{error}")));
    (0..BEFORE).for_each(|_| harness.step());
    let mut timed = |what: &str| {
        let mut ms: Vec<f64> = (0..TIMED)
            .map(|_| {
                let start = Instant::now();
                harness.step();
                start.elapsed().as_secs_f64() * 1e3
            })
            .collect();
        ms.sort_by(f64::total_cmp);
        println!("{what}: {:.3} ms, 95 % under {:.3} ms", ms[TIMED / 2], ms[TIMED * 95 / 100]);
        harness.key_press(Key::I);
        harness.run_steps(10);
    };
    timed("with all that is written");
    timed("without");
}

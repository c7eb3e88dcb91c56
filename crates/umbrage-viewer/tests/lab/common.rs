//! A laboratory to test.

use egui_kittest::Harness;
use egui_kittest::wgpu::WgpuTestRenderer;
use std::time::{Duration, Instant};
use umbrage_viewer::{Lab, Options, setup};

/// Longest time that anything may take, on a machine with other things to do.
const LIMIT: Duration = Duration::from_secs(90);

/// A laboratory of this size in points.
pub fn lab(size: [f32; 2], options: Options) -> Harness<'static, Lab> {
    let renderer = WgpuTestRenderer::from_setup(setup(None));
    let builder = Harness::builder().with_size(size).renderer(renderer);
    let registry = umbrage::Registry::default();
    builder.build_eframe(move |context| Lab::new(context, &registry, &options).unwrap_or_else(|e| panic!("{e}")))
}

/// Draws frame by frame until `done`.
pub fn until(lab: &mut Harness<'static, Lab>, what: &str, done: impl Fn(&Lab) -> bool) {
    let start = Instant::now();
    while !done(lab.state()) {
        if start.elapsed() > LIMIT {
            // What is seen then tells most.
            let seen = std::env::temp_dir().join("umbrage-lab.png");
            lab.render().unwrap().save(&seen).unwrap();
            panic!("not within {LIMIT:?}: {what}; see {}", seen.display());
        }
        lab.step();
        std::thread::sleep(Duration::from_millis(5));
    }
    lab.step();
}

/// With the scene open and its picture drawn.
pub fn open(size: [f32; 2], options: Options) -> Harness<'static, Lab> {
    let mut lab = lab(size, options);
    until(&mut lab, "the first picture", Lab::is_shown);
    lab
}

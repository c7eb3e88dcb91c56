//! Walks through all techniques as the page does in `cargo xtask browser`, in a window of the same
//! size that nobody sees.

use egui_kittest::Harness;
use egui_kittest::wgpu::WgpuTestRenderer;
use umbrage::Registry;
use umbrage_viewer::{Lab, Options, Walk, setup};

/// The laboratory on its walk.
struct Walker {
    lab: Lab,
    walk: Walk,
}

impl eframe::App for Walker {
    fn ui(&mut self, ui: &mut eframe::egui::Ui, frame: &mut eframe::Frame) {
        self.lab.ui(ui, frame);
        self.walk.step(&mut self.lab, |line| println!("{line}"));
    }
}

fn main() {
    let registry = Registry::default();
    let renderer = WgpuTestRenderer::from_setup(setup(None));
    let builder = Harness::builder().with_size([960.0, 480.0]).renderer(renderer);
    let mut harness = builder.build_eframe(|context| Walker {
        lab: Lab::new(context, &registry, &Options::default()).unwrap_or_else(|error| panic!("{error}")),
        walk: Walk::new(&registry),
    });
    while !harness.state().walk.has_ended() {
        harness.step();
    }
}

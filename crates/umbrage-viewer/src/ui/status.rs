//! The line at the bottom: messages, and what the scene is.

use crate::app::Lab;
use eframe::egui;

pub(super) fn show(lab: &mut Lab, ui: &mut egui::Ui) {
    for message in lab.face.messages() {
        ui.label(message);
    }
    ui.horizontal(|ui| {
        if let Some(opening) = lab.opening.as_ref().filter(|opening| lab.state.scene != opening.name) {
            ui.spinner();
            ui.label(format!("opening {}", opening.name));
        }
        let Some(stage) = &lab.stage else { return };
        let scene = &stage.source.scene;
        ui.weak(format!("{}, {} triangles, {} lights", scene.name, scene.triangle_count(), scene.lights.len()));
        if let Some(text) = super::panes::under_cursor(lab) {
            ui.separator();
            ui.monospace(text);
        }
    });
}

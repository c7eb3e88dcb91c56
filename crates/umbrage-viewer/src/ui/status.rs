//! The line at the bottom, and messages over the pictures, which stay as large as they are.

use crate::app::Lab;
use eframe::egui;

pub(super) fn show(lab: &mut Lab, ui: &mut egui::Ui) {
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

/// Messages, over the lower edge of the pictures.
pub(super) fn messages(lab: &mut Lab, context: &egui::Context) {
    let messages: Vec<String> = lab.face.messages().map(String::from).collect();
    if messages.is_empty() {
        return;
    }
    let area = egui::Area::new(egui::Id::unique("messages")).anchor(egui::Align2::CENTER_BOTTOM, [0.0, -40.0]);
    area.interactable(false).show(context, |ui| {
        egui::Frame::popup(ui.style()).show(ui, |ui| {
            ui.set_max_width(720.0);
            messages.iter().for_each(|message| _ = ui.label(message));
        });
    });
}

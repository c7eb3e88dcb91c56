//! Settings at a click: those that break a technique, and those that were measured.

use crate::app::Lab;
use crate::{lessons, record};
use eframe::egui::{self, Color32, RichText};
use umbrage::TechniqueInfo;

/// The presets of the active technique, whose settings are `now`; the one that was chosen, as the
/// command line has it.
pub(super) fn show(lab: &mut Lab, info: &'static TechniqueInfo, now: &str, ui: &mut egui::Ui) -> Option<String> {
    let header = egui::CollapsingHeader::new("Presets").show(ui, |ui| {
        let broken = lessons(lab, info, ui);
        measured(info, now, ui).or(broken)
    });
    header.body_returned.flatten()
}

/// Breaks the active technique on purpose.
pub(super) fn lessons(lab: &mut Lab, info: &'static TechniqueInfo, ui: &mut egui::Ui) -> Option<String> {
    let lessons = lessons::of(info);
    if lessons.is_empty() {
        return None;
    }
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        ui.label("Break it:").on_hover_text("What a setting is for is seen best where it is at its end");
        for lesson in lessons {
            if ui.button(lesson.title()).on_hover_text(lesson.about).clicked() {
                lab.face.say(format!("{}: {}", lesson.title(), lesson.about));
                chosen = Some(lesson.label(info));
            }
        }
    });
    chosen
}

/// What was measured of the technique's settings.
fn measured(info: &'static TechniqueInfo, now: &str, ui: &mut egui::Ui) -> Option<String> {
    let mut found = record::of(info.id);
    found.sort_by(|a, b| a.place.cmp(b.place).then(a.mae.total_cmp(&b.mae)));
    let mut chosen = None;
    let mut place = "";
    for measured in &found {
        if place != measured.place {
            ui.weak(format!("Measured on {}:", measured.place))
                .on_hover_text("Of a stored sweep. Green: on the Pareto front of error and cost of all its techniques");
            place = measured.place;
        }
        let settings = measured.label.split_once(':').map_or("defaults", |(_, settings)| settings);
        let text = format!("{settings}: mae {:.4}, {:.1} × bare minimum", measured.mae, measured.times_bare);
        let text = RichText::new(text);
        let text = if measured.is_on_front { text.color(Color32::LIGHT_GREEN) } else { text };
        if ui.selectable_label(measured.label == now, text).clicked() {
            chosen = Some(measured.label.to_string());
        }
    }
    chosen
}

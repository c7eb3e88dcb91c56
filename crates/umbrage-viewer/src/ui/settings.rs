//! The settings of the active pane's technique: each as a slider, a choice or a switch.

use super::{bar, presets};
use crate::app::Lab;
use eframe::egui::{self, Slider};
use umbrage::{Param, ParamKind, Registry, Settings, TechniqueInfo, Value};
use umbrage_report::{Choice, LIGHT_SAMPLES, RAY_TRACED, RAY_TRACED_SUMMARY};

/// Beyond this ratio of its ends a slider is logarithmic.
const WIDE: f64 = 64.0;
/// Points of the light that brute force may take here.
const MOST_LIGHT_SAMPLES: u32 = 256;

pub(super) fn show(lab: &mut Lab, ui: &mut egui::Ui) {
    let pane = lab.state.panes[lab.face.active].clone();
    ui.horizontal(|ui| {
        ui.heading(pane.id());
        ui.menu_button("Change…", |ui| bar::technique_menu(lab, ui)).response.on_hover_text("Another technique");
        let text = "How it works, what it can't do, a tour in five steps (H)";
        if pane.technique != RAY_TRACED && ui.button("Read").on_hover_text(text).clicked() {
            lab.face.reads = Some(pane.id().into());
        }
    });
    if pane.technique == RAY_TRACED {
        ui.label(RAY_TRACED_SUMMARY);
        return;
    }
    let choice = match Choice::parse(&lab.registry, &pane.technique, &[]) {
        Ok(choice) => choice,
        Err(error) => {
            ui.colored_label(ui.visuals().error_fg_color, error.to_string());
            return;
        }
    };
    let info: &'static TechniqueInfo = choice.info;
    ui.label(info.summary);
    ui.weak(info.source);
    let (mut settings, mut samples) = (choice.settings.clone(), choice.light_samples);
    egui::Grid::new("params").num_columns(2).show(ui, |ui| {
        for param in info.params() {
            if let Some(text) = row(ui, &lab.registry, param, &settings)
                && let Err(error) = settings.set(&lab.registry, param.name, &text)
            {
                lab.face.say(error.to_string());
            }
            ui.end_row();
        }
        if settings.is_hard() {
            light_samples(ui, &mut samples);
            ui.end_row();
        }
    });
    let is_changed = settings.changed().next().is_some() || samples.is_some();
    if ui.add_enabled(is_changed, egui::Button::new("All defaults")).clicked() {
        (settings, samples) = (info.default_settings(), None);
    }
    let mut label = settings.to_string();
    if let Some(samples) = samples.filter(|_| settings.is_hard()) {
        label += &format!(":{LIGHT_SAMPLES}={samples}");
    }
    let preset = presets::show(lab, info, &label, ui);
    lab.state.panes[lab.face.active].technique = preset.unwrap_or(label);
}

/// A parameter; the text of its new value where it was changed.
fn row(ui: &mut egui::Ui, registry: &Registry, param: &Param, settings: &Settings) -> Option<String> {
    let value = settings.get(param.name)?;
    let unit = if param.unit.is_empty() { String::new() } else { format!(" {}", param.unit) };
    let live = if param.live { "" } else { " Makes the technique anew." };
    let help = format!("{} Range: {}{unit}.{live}", param.help, param.kind.range_of(registry));
    let is_changed = value != param.kind.default();
    let name = egui::RichText::new(param.name);
    let label = ui.label(if is_changed { name.strong() } else { name }).on_hover_text(&help).id;
    ui.horizontal(|ui| {
        let new = widget(ui, registry, param, value, label);
        let reset = ui.add_enabled(is_changed, egui::Button::new("reset").small());
        let reset = reset.on_hover_text(format!("Back to {}", param.kind.default()));
        if reset.clicked() { Some(param.kind.default().to_string()) } else { new }
    })
    .inner
}

fn widget(ui: &mut egui::Ui, registry: &Registry, param: &Param, value: Value, label: egui::Id) -> Option<String> {
    match (param.kind, value) {
        (ParamKind::Int { min, max, .. }, Value::Int(mut number)) => {
            let is_wide = max as f64 / min.max(1) as f64 > WIDE;
            let slider = Slider::new(&mut number, min..=max).logarithmic(is_wide);
            ui.add(named(slider, param)).labelled_by(label).changed().then(|| number.to_string())
        }
        (ParamKind::Float { min, max, .. }, Value::Float(mut number)) => {
            let is_wide = max / min.max(max * 1e-4) > WIDE;
            let slider = Slider::new(&mut number, min..=max).logarithmic(is_wide).smallest_positive(max * 1e-5);
            ui.add(named(slider, param)).labelled_by(label).changed().then(|| number.to_string())
        }
        (ParamKind::Switch { .. }, Value::Switch(mut on)) => {
            let changed = ui.checkbox(&mut on, "").labelled_by(label).changed();
            changed.then(|| Value::Switch(on).to_string())
        }
        (kind, value) => {
            let now = value.to_string();
            let mut new = None;
            let list = egui::ComboBox::from_id_salt(param.name).selected_text(&now).show_ui(ui, |ui| {
                for word in kind.words(registry) {
                    if ui.selectable_label(word == now, word).clicked() {
                        new = Some(word.to_string());
                    }
                }
            });
            list.response.labelled_by(label);
            new
        }
    }
}

fn named<'a>(slider: Slider<'a>, param: &Param) -> Slider<'a> {
    slider.suffix(if param.unit.is_empty() { String::new() } else { format!(" {}", param.unit) })
}

/// Brute force, which any hard technique can be put to.
fn light_samples(ui: &mut egui::Ui, samples: &mut Option<u32>) {
    const HELP: &str = "Averages the shadows of so many points of the light, each found anew.";
    let mut count = samples.unwrap_or(1);
    let label = ui.label(LIGHT_SAMPLES).on_hover_text(HELP).id;
    let slider = Slider::new(&mut count, 1..=MOST_LIGHT_SAMPLES).logarithmic(true);
    if ui.add(slider).labelled_by(label).changed() {
        *samples = (count > 1).then_some(count);
    }
}

//! What the active pane costs, and how far from the truth it is.

use crate::app::Lab;
use crate::pane::{HISTORY, Pane};
use crate::yardstick::Of;
use eframe::egui::{self, Color32, Pos2, Stroke, Vec2};
use std::collections::BTreeMap;
use umbrage::Owner;
use umbrage_report::RAY_TRACED;

pub(super) fn show(lab: &mut Lab, ui: &mut egui::Ui) {
    yardstick(lab, ui);
    let Some(pane) = lab.panes.get(lab.face.active) else { return };
    times(pane, lab.gpu.has(wgpu::Features::TIMESTAMP_QUERY), ui);
    sparkline(pane, ui);
    egui::Grid::new("stats").num_columns(2).show(ui, |ui| {
        let mut line = |name: &str, value: String| {
            ui.label(name);
            ui.label(value);
            ui.end_row();
        };
        let stats = &pane.stats;
        line("prepare (CPU)", format!("{:.3} ms", pane.prepare_ms));
        line("draws", stats.draws.to_string());
        line("triangles", stats.triangles.to_string());
        line("casters drawn", stats.casters_drawn.to_string());
        line("casters culled", stats.casters_culled.to_string());
        line("memory", format!("{:.1} MiB", stats.bytes as f64 / 1_048_576.0));
        pane.counts.iter().for_each(|(name, count)| line(name, count.to_string()));
    });
    let (width, height) = pane.size();
    ui.separator();
    ui.heading("Error");
    errors(lab, ui);
    ui.separator();
    ui.heading("Picture");
    let divisor = lab.divisor();
    ui.label(format!("{width} × {height} pixels, 1 of {} of the window's", divisor * divisor));
    let mut chosen = lab.state.divisor;
    let label = ui.label("resolution").id;
    let list = egui::ComboBox::from_id_salt("resolution").selected_text(resolution(chosen)).show_ui(ui, |ui| {
        for divisor in [None, Some(1), Some(2), Some(4), Some(8)] {
            ui.selectable_value(&mut chosen, divisor, resolution(divisor));
        }
    });
    list.response.labelled_by(label);
    lab.state.divisor = chosen;
    ui.add(egui::Slider::new(&mut lab.state.gain, crate::GAINS[0]..=crate::GAINS[1]).logarithmic(true).text("error ×"));
    range(lab, ui);
    ui.weak(format!("{} ({})", lab.gpu.adapter().name, lab.gpu.adapter().driver));
}

fn resolution(divisor: Option<u32>) -> String {
    match divisor {
        None => "as the adapter can".into(),
        Some(1) => "full".into(),
        Some(n) => format!("1/{n}"),
    }
}

/// The active pane's cost over the least that any technique can have.
fn yardstick(lab: &mut Lab, ui: &mut egui::Ui) {
    let can = lab.state.panes.get(lab.face.active).is_some_and(|pane| pane.technique != RAY_TRACED);
    let text = "Times it against a pass that does nothing and against maps with one comparison, all of them doing the \
                whole of their work in every frame";
    ui.horizontal(|ui| {
        ui.heading("Costs");
        let is_measuring = lab.yardstick.is_some();
        let button = ui.add_enabled(can && !is_measuring, egui::Button::new("Measure × floor")).on_hover_text(text);
        if button.clicked() {
            lab.start_to_measure();
        }
        if is_measuring {
            ui.spinner();
        }
    });
    let now = Of::new(&lab.state, lab.face.active);
    if let Some((_, ratios)) = lab.ratios.as_ref().filter(|(of, _)| Some(of) == now.as_ref()) {
        ui.label(format!("{:.1} × floor", ratios.floor)).on_hover_text(FLOOR);
        ui.label(format!("{:.2} × bare minimum", ratios.bare_minimum)).on_hover_text(BARE_MINIMUM);
    }
}

const FLOOR: &str = "GPU time and preparation over those of a pass that reads depth and writes visibility";
const BARE_MINIMUM: &str = "The same over maps as large, without bias and with one comparison";

/// GPU time by pass, as bars.
fn times(pane: &Pane, keeps_time: bool, ui: &mut egui::Ui) {
    if pane.times.is_empty() {
        // Times of a frame arrive some frames later, and none where rays are traced.
        ui.weak(if keeps_time { "No frame has been timed yet." } else { "This adapter keeps no time." });
        return;
    }
    let mut passes: BTreeMap<&str, f64> = BTreeMap::new();
    for time in pane.times.iter().filter(|t| matches!(t.owner, Owner::Light(_))) {
        *passes.entry(&time.pass).or_default() += time.time_ms;
    }
    let all: f64 = passes.values().sum();
    ui.label(format!("technique {all:.2} ms"));
    for (name, ms) in &passes {
        let share = (ms / all.max(1e-9)) as f32;
        ui.add(egui::ProgressBar::new(share).text(format!("{name} {ms:.2} ms")).corner_radius(2));
    }
    ui.weak(format!("the rest of the frame {:.2} ms", Lab::host_ms(pane)));
}

/// The technique's time in the last frames.
fn sparkline(pane: &Pane, ui: &mut egui::Ui) {
    let (area, painter) = ui.allocate_painter(Vec2::new(ui.available_width(), 36.0), egui::Sense::hover());
    let highest = pane.history.iter().copied().fold(0.0, f32::max);
    if highest <= 0.0 {
        return;
    }
    let rect = area.rect;
    let at = |(i, ms): (usize, &f32)| {
        let x = rect.left() + rect.width() * i as f32 / (HISTORY - 1) as f32;
        Pos2::new(x, rect.bottom() - rect.height() * ms / highest)
    };
    let points: Vec<Pos2> = pane.history.iter().enumerate().map(at).collect();
    painter.line(points, Stroke::new(1.0, Color32::LIGHT_BLUE));
    area.on_hover_text(format!("The last {} frames; the slowest took {highest:.2} ms", pane.history.len()));
}

fn errors(lab: &Lab, ui: &mut egui::Ui) {
    let truth = lab.truth.of(lab.state.light.unwrap_or_default());
    match truth {
        Some(truth) if truth.samples > 0 => {
            let error = truth.standard_error.map(|e| format!(", standard error {e:.4}")).unwrap_or_default();
            ui.weak(format!("truth: {} rays a pixel{error}", truth.samples));
        }
        _ if lab.truth_waits() => _ = ui.weak("the truth waits until the casters stand (K)"),
        _ if lab.face.traces => _ = ui.weak("the truth is being traced…"),
        _ => _ = ui.weak("the truth is not traced (Panes, Trace the truth)"),
    }
    let Some(scores) = lab.panes.get(lab.face.active).and_then(|pane| pane.scores) else { return };
    egui::Grid::new("scores").num_columns(2).show(ui, |ui| {
        let mut line = |name: &str, value: f64, about: &str| {
            ui.label(name).on_hover_text(about);
            ui.label(format!("{value:.4}"));
            ui.end_row();
        };
        line("mae", scores.mae, "Mean of the absolute error of visibility");
        line("leak", scores.leak, "Light in the shadow");
        line("false shadow", scores.false_shadow, "Shadow in the light");
        line("p99", scores.p99, "One pixel of a hundred is off by more");
        line("correct %", scores.correct_pct, "Pixels that are off by 0.02 at most");
    });
}

/// What is black and what is white in pictures of numbers.
fn range(lab: &mut Lab, ui: &mut egui::Ui) {
    let found = lab.panes.get(lab.face.active).and_then(|pane| pane.extremes);
    let mut is_set = lab.state.range.is_some();
    if ui
        .checkbox(&mut is_set, "stretch")
        .on_hover_text("From which number to which views show black to white")
        .changed()
    {
        lab.state.range = is_set.then(|| found.unwrap_or([0.0, 1.0]));
    }
    if let Some([low, high]) = &mut lab.state.range {
        ui.horizontal(|ui| {
            ui.add(egui::DragValue::new(low).speed(0.002).range(f32::MIN..=*high - f32::EPSILON));
            ui.add(egui::DragValue::new(high).speed(0.002).range(*low + f32::EPSILON..=f32::MAX));
        });
    }
}

//! The page of a technique: its README, made readable, and a tour in five steps.

use super::presets;
use crate::app::Lab;
use crate::lessons;
use crate::state::{COLOR, ERROR, VISIBILITY};
use crate::text::{self, Block, Span};
use eframe::egui::text::LayoutJob;
use eframe::egui::{self, Color32, FontId, Stroke, TextFormat};
use umbrage::TechniqueInfo;

/// The window, where it is open.
pub(super) fn show(lab: &mut Lab, context: &egui::Context) {
    let Some(info) = lab.face.reads.as_deref().and_then(|id| lab.registry.find(id).ok()) else { return };
    let mut is_open = true;
    let height = context.content_rect().height();
    egui::Window::new(format!("Read: {}", info.id)).open(&mut is_open).default_width(720.0).show(context, |ui| {
        tour(lab, info, ui);
        if let Some(broken) = presets::lessons(lab, info, ui) {
            lab.state.panes[lab.face.active].technique = broken;
        }
        ui.separator();
        egui::ScrollArea::vertical().max_height(height * 0.7).show(ui, |ui| {
            for (number, block) in text::blocks(info.readme).iter().enumerate() {
                ui.push_id(number, |ui| show_block(block, ui));
            }
        });
    });
    if !is_open {
        lab.face.reads = None;
    }
}

/// Five looks at the technique, one button each.
fn tour(lab: &mut Lab, info: &'static TechniqueInfo, ui: &mut egui::Ui) {
    let lesson = lessons::of(info).into_iter().next();
    let steps = [
        (Some(COLOR), "1 the picture", "The shaded scene under it"),
        (
            Some(VISIBILITY),
            "2 what points see",
            "The share of the light that each point sees, all that it is asked for",
        ),
        (info.views.first().copied(), "3 inside", "What it keeps to find that: more of it is in the menu Picture"),
        (Some(ERROR), "4 where it errs", "Against the truth: red where light leaks in, blue where shadow is false"),
        (Some(ERROR), "5 break it", "One setting at its end, and where the picture is wrong then"),
    ];
    ui.horizontal_wrapped(|ui| {
        ui.label("A tour:");
        for (step, (picture, name, about)) in steps.into_iter().enumerate() {
            let breaks = step == 4;
            let can = picture.is_some() && (!breaks || lesson.is_some());
            if ui.add_enabled(can, egui::Button::new(name)).on_hover_text(about).clicked()
                && let Some(picture) = picture
            {
                let pane = &mut lab.state.panes[lab.face.active];
                pane.technique = info.id.into();
                pane.picture = picture.into();
                if let (true, Some(lesson)) = (breaks, &lesson) {
                    pane.technique = lesson.label(info);
                    lab.face.say(format!("{}: {}", lesson.title(), lesson.about));
                }
            }
        }
    });
}

fn show_block(block: &Block, ui: &mut egui::Ui) {
    match block {
        Block::Heading(level, spans) => {
            ui.add_space(6.0);
            let size = [22.0, 18.0, 15.5][usize::from(level - 1).min(2)];
            ui.label(job(spans, size, ui));
        }
        Block::Paragraph(spans) => {
            ui.label(job(spans, 14.0, ui));
            ui.add_space(4.0);
        }
        Block::Item(mark, spans) => {
            ui.horizontal_top(|ui| {
                ui.add_space(10.0);
                ui.label(mark);
                ui.vertical(|ui| ui.label(job(spans, 14.0, ui)));
            });
        }
        Block::Code(code) => {
            egui::Frame::group(ui.style()).show(ui, |ui| {
                egui::ScrollArea::horizontal().show(ui, |ui| ui.monospace(code));
            });
        }
        Block::Table(rows) => {
            egui::ScrollArea::horizontal().show(ui, |ui| {
                egui::Grid::new("table").striped(true).spacing([12.0, 4.0]).show(ui, |ui| {
                    for row in rows {
                        for (column, cell) in row.iter().enumerate() {
                            ui.vertical(|ui| {
                                // The last one has the sentences.
                                ui.set_max_width(if column + 1 == row.len() { 380.0 } else { 140.0 });
                                ui.label(job(cell, 13.0, ui));
                            });
                        }
                        ui.end_row();
                    }
                });
            });
            ui.add_space(4.0);
        }
    }
}

/// Text of several kinds in one paragraph.
fn job(spans: &[Span], size: f32, ui: &egui::Ui) -> LayoutJob {
    let (plain, strong) = (ui.visuals().text_color(), ui.visuals().strong_text_color());
    let mut job = LayoutJob::default();
    for span in spans {
        let format = |font_id, color| TextFormat { font_id, color, ..TextFormat::default() };
        let proportional = FontId::proportional(size);
        let (text, format) = match span {
            Span::Text(text) => (text, format(proportional, plain)),
            Span::Strong(text) => (text, format(proportional, strong)),
            Span::Code(text) => (text, format(FontId::monospace(size - 1.0), Color32::LIGHT_BLUE)),
            Span::Link(text) => {
                let underline = Stroke::new(1.0, plain.gamma_multiply(0.5));
                (text, TextFormat { underline, ..format(proportional, plain) })
            }
        };
        job.append(text, 0.0, format);
    }
    job
}

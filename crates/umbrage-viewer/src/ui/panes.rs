//! The pictures, and what the mouse does on them.

use super::{bar, gizmo, over};
use crate::app::Lab;
use crate::camera;
use crate::state::Layout;
use eframe::egui::{self, Color32, FontId, Pos2, Rect, Sense, Stroke, StrokeKind, Vec2};
use umbrage_core::glam::DVec2;

/// How often blinking panes change, seconds.
const BLINK_S: f64 = 0.6;
/// Half the width of what takes the split bar, points.
const GRIP: f32 = 6.0;

pub(super) fn show(lab: &mut Lab, ui: &mut egui::Ui) {
    let area = ui.max_rect();
    ui.painter().rect_filled(area, 0.0, Color32::from_gray(14));
    let cells = cells(area, lab.state.panes.len(), lab.state.layout);
    let scale = ui.ctx().pixels_per_point();
    lab.face.cell = cells.first().map(|cell| (cell.size() * scale).into());
    lab.face.cursor = None;
    let split = area.left() + area.width() * lab.state.split;
    let shown: Vec<(usize, Rect)> = match lab.state.layout {
        Layout::Split if cells.len() > 1 => {
            let (left, right) = (area.with_max_x(split), area.with_min_x(split));
            vec![(0, left), (1, right)]
        }
        Layout::Blink if cells.len() > 1 => {
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(100));
            vec![(usize::from(lab.face.clock_s % (2.0 * BLINK_S) >= BLINK_S), area)]
        }
        _ => cells.iter().copied().enumerate().collect(),
    };
    for (number, part) in shown {
        let cell = cells.get(number).copied().unwrap_or(area);
        pane(lab, ui, number, cell, part);
    }
    if lab.state.layout == Layout::Split && cells.len() > 1 {
        let grip = Rect::from_x_y_ranges(split - GRIP..=split + GRIP, area.y_range());
        let bar = ui
            .interact(grip, ui.scope_id().with("split"), Sense::drag())
            .on_hover_cursor(egui::CursorIcon::ResizeHorizontal);
        if bar.dragged() {
            lab.state.split = (lab.state.split + bar.drag_delta().x / area.width().max(1.0)).clamp(0.0, 1.0);
        }
        ui.painter().vline(split, area.y_range(), Stroke::new(2.0, Color32::WHITE));
    }
}

/// Where panes lie: all of one size.
fn cells(area: Rect, count: usize, layout: Layout) -> Vec<Rect> {
    if layout != Layout::Grid && count > 1 {
        return vec![area; count];
    }
    let (columns, rows) = match count {
        0 | 1 => (1, 1),
        2 => (2, 1),
        3 if area.width() > 2.2 * area.height() => (3, 1),
        _ => (2, 2),
    };
    let size = area.size() / Vec2::new(columns as f32, rows as f32);
    let corner = |i: usize| area.min + Vec2::new((i % columns) as f32 * size.x, (i / columns) as f32 * size.y);
    (0..count).map(|i| Rect::from_min_size(corner(i), size)).collect()
}

/// One pane: `cell` is its picture, `part` what of it is seen.
fn pane(lab: &mut Lab, ui: &mut egui::Ui, number: usize, cell: Rect, part: Rect) {
    let response = ui.interact(part, ui.scope_id().with(("pane", number)), Sense::click_and_drag());
    let label = format!("pane {number}");
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &label));
    let painter = ui.painter_at(part);
    let wanted = lab.state.panes[number].clone();
    match lab.panes.get(number) {
        Some(pane) if pane.error.is_none() && lab.stage.is_some() => {
            painter.image(pane.id, cell, Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0)), Color32::WHITE);
        }
        pane => {
            let text = pane.and_then(|pane| pane.error.clone()).unwrap_or_else(|| "no scene is open yet".into());
            painter.rect_filled(part, 0.0, Color32::from_gray(24));
            let text = painter.layout(text, FontId::proportional(15.0), Color32::LIGHT_RED, part.width() * 0.8);
            painter.galley(part.center() - text.size() * 0.5, text, Color32::LIGHT_RED);
        }
    }
    over::draw(lab, &painter, number, cell);
    if lab.face.shows_text {
        let name = format!("{}\n{}", wanted.technique, wanted.picture);
        let place = part.left_top() + Vec2::splat(6.0);
        let text = painter.layout(name, FontId::proportional(13.0), Color32::WHITE, part.width() - 12.0);
        painter.rect_filled(Rect::from_min_size(place, text.size()).expand(3.0), 3.0, Color32::from_black_alpha(150));
        painter.galley(place, text, Color32::WHITE);
    }
    if number == lab.face.active && lab.state.panes.len() > 1 {
        painter.rect_stroke(part, 0.0, Stroke::new(1.0, Color32::LIGHT_BLUE), StrokeKind::Inside);
    }
    take(lab, ui, number, cell, &response);
    gizmo::show(lab, ui, number, cell, part);
}

/// What the mouse does on a pane.
fn take(lab: &mut Lab, ui: &egui::Ui, number: usize, cell: Rect, response: &egui::Response) {
    if response.clicked() || response.drag_started() || response.secondary_clicked() {
        lab.face.active = number;
    }
    if let Some(at) = response.interact_pointer_pos().filter(|_| response.clicked()) {
        over::click(lab, number, at, cell);
    }
    response.context_menu(|ui| {
        lab.face.active = number;
        egui::ScrollArea::vertical().max_height(600.0).show(ui, |ui| bar::technique_menu(lab, ui));
    });
    if let Some(position) = response.hover_pos() {
        let share = (position - cell.min) / cell.size();
        lab.face.cursor = Some((number, [share.x, share.y]));
        let scroll = ui.input(|i| i.smooth_scroll_delta().y + i.zoom_delta().ln() * 200.0);
        if scroll != 0.0 {
            camera::zoom(eye(lab), f64::from(scroll) * 0.004);
        }
    }
    let drag = response.drag_delta() / cell.height().max(1.0);
    let drag = DVec2::new(drag.x.into(), drag.y.into());
    if drag == DVec2::ZERO {
        return;
    }
    let is_looking = ui.input(|i| i.modifiers.shift);
    if response.dragged_by(egui::PointerButton::Primary) {
        if is_looking { camera::look(eye(lab), drag) } else { camera::orbit(eye(lab), drag) }
    } else if response.dragged_by(egui::PointerButton::Middle) {
        let from = lab.state.eye().clone();
        let number = lab.state.light.unwrap_or_default();
        if let Some(light) = lab.state.lights.get_mut(number) {
            camera::drag_light(light, &from, drag);
        }
    }
}

/// The camera that hands move: the observer's where there is one.
pub(super) fn eye(lab: &mut Lab) -> &mut umbrage_core::Camera {
    match &mut lab.state.observer {
        Some(observer) => observer,
        None => &mut lab.state.camera,
    }
}

/// What is known of the pixel under the cursor.
pub(super) fn under_cursor(lab: &Lab) -> Option<String> {
    let (number, [x, y]) = lab.face.cursor?;
    let pane = lab.panes.get(number)?;
    let (width, height) = pane.size();
    let (x, y) = ((x * width as f32) as u32, (y * height as f32) as u32);
    let mut text = format!("({x}, {y})");
    let place = (i64::from(x), i64::from(y));
    if let Some(value) = pane.visibility.as_ref().and_then(|v| v.get(place.0, place.1)) {
        text += &format!("  visibility {value:.3}");
    }
    let truth = lab.truth.of(lab.state.light.unwrap_or_default());
    if let Some(truth) = truth.filter(|t| t.visibility.size() == pane.size()) {
        let is_scored = truth.scored.get(place.0, place.1).copied().unwrap_or_default();
        match truth.visibility.get(place.0, place.1) {
            Some(value) if is_scored => text += &format!("  truth {value:.3}"),
            _ => text += "  not scored",
        }
    }
    Some(text)
}

//! The light's gizmo on a picture: painted, and taken by its handles.

use crate::app::Lab;
use crate::gizmo::{self, Gizmo, Grip, Handle};
use crate::screen::Screen;
use crate::state::{PICTURES, is_overlooked};
use eframe::egui::{self, Color32, Rect, Sense, Stroke, Vec2};
use umbrage_core::glam::DVec3;
use umbrage_core::{Camera, Light, lit_part};

/// How long arms are, points.
const ARM: f32 = 70.0;
/// How wide a handle is, points.
const WIDTH: f32 = 14.0;

/// Shows it over the picture in `cell`, of which `part` is seen.
pub(super) fn show(lab: &mut Lab, ui: &mut egui::Ui, pane: usize, cell: Rect, part: Rect) {
    let picture = lab.state.panes[pane].picture.as_str();
    if !PICTURES.iter().any(|(name, _)| *name == picture) {
        // The inside of a technique is another place.
        return;
    }
    let Some(stage) = &lab.stage else { return };
    let seen = stage.seen(&lab.state);
    let Some(light) = seen.main_light() else { return };
    let camera = if is_overlooked(picture) { seen.eye() } else { &seen.camera };
    let screen = Screen::new(camera, cell, stage.renderer.size());
    if lab.face.shows_lit_part {
        rectangle(ui, camera, light, stage.receivers(), &screen, part);
    }
    if !lab.face.shows_gizmo {
        return;
    }
    let anchor = gizmo::anchor(&light.shape, stage.middle);
    if screen.point(anchor).is_none_or(|at| !part.contains(at)) {
        point_out(ui, &screen, anchor, part);
    }
    let arm = screen.metres(anchor, ARM);
    if !(arm.is_finite() && arm > 0.0) {
        return;
    }
    let [right, ..] = camera.axes();
    let gizmo = Gizmo::of(&light.shape, stage.middle, arm, right);
    paint(ui, &gizmo, &screen, part);
    let number = lab.state.light.unwrap_or_default();
    for grip in &gizmo.grips {
        if let Some(to) = taken(ui, grip, &screen, pane, part)
            && let Some(light) = lab.state.lights.get_mut(number)
        {
            gizmo::drag(&mut light.shape, grip, to, arm);
        }
    }
}

/// The rectangle that the light can light, white.
fn rectangle(
    ui: &egui::Ui,
    camera: &Camera,
    light: &Light,
    receivers: umbrage_core::Bounds,
    screen: &Screen,
    part: Rect,
) {
    let (width, height) = screen.size;
    let Some(lit) = lit_part(light, &camera.view(width, height), &receivers) else { return };
    let corners = [lit.min, lit.max].map(|ndc| screen.of_ndc(ndc));
    let rect = Rect::from_two_pos(corners[0], corners[1]);
    let stroke = Stroke::new(2.0, Color32::WHITE);
    ui.painter_at(part).rect_stroke(rect, 0.0, stroke, egui::StrokeKind::Inside);
}

/// An arrow at the edge of the picture, towards a light that is outside of it.
fn point_out(ui: &egui::Ui, screen: &Screen, light: DVec3, part: Rect) {
    let Some(way) = screen.way(light) else { return };
    let room = part.shrink(16.0);
    let reach = (room.size() * 0.5 / way.abs().max(Vec2::splat(1e-3))).min_elem();
    let tip = room.center() + way * reach;
    let painter = ui.painter_at(part);
    painter.arrow(tip - way * 28.0, way * 28.0, Stroke::new(2.0, Color32::YELLOW));
    let text = "light".to_string();
    painter.text(
        tip - way * 44.0,
        egui::Align2::CENTER_CENTER,
        text,
        egui::FontId::proportional(13.0),
        Color32::YELLOW,
    );
}

fn paint(ui: &egui::Ui, gizmo: &Gizmo, screen: &Screen, part: Rect) {
    let painter = ui.painter_at(part);
    let line = |from: DVec3, to: DVec3, stroke: Stroke| {
        if let Some(ends) = screen.segment(from, to) {
            // On bright ground, too.
            painter.line_segment(ends, Stroke::new(stroke.width + 2.0, Color32::from_black_alpha(120)));
            painter.line_segment(ends, stroke);
        }
    };
    for strip in &gizmo.lines {
        strip.windows(2).for_each(|ends| line(ends[0], ends[1], Stroke::new(1.0, Color32::WHITE)));
    }
    for grip in &gizmo.grips {
        line(grip.from, grip.at, Stroke::new(2.0, color(grip.handle)));
    }
}

fn color(handle: Handle) -> Color32 {
    match handle {
        Handle::Move(axis) => {
            [Color32::from_rgb(240, 90, 90), Color32::from_rgb(100, 220, 100), Color32::from_rgb(100, 150, 255)][axis]
        }
        Handle::Aim => Color32::YELLOW,
        Handle::Size(_) | Handle::End(_) => Color32::WHITE,
    }
}

fn name(handle: Handle) -> String {
    match handle {
        Handle::Move(axis) => format!("light: move {}", ["x", "y", "z"][axis]),
        Handle::Aim => "light: aim".into(),
        Handle::Size(axis) => format!("light: size {axis}"),
        Handle::End(end) => format!("light: end {end}"),
    }
}

/// Shows a handle; where it was dragged to.
fn taken(ui: &egui::Ui, grip: &Grip, screen: &Screen, pane: usize, part: Rect) -> Option<DVec3> {
    let at = screen.point(grip.at)?;
    let area = Rect::from_center_size(at, Vec2::splat(WIDTH));
    let name = name(grip.handle);
    let response = ui.interact(area.intersect(part), ui.scope_id().with((pane, &name)), Sense::drag());
    if area.intersects(part) {
        let color = color(grip.handle);
        let grows = if response.hovered() || response.dragged() { 1.5 } else { 0.0 };
        let painter = ui.painter_at(part);
        painter.circle_filled(at, WIDTH * 0.5 - 2.0 + grows, Color32::from_black_alpha(150));
        painter.circle_filled(at, WIDTH * 0.5 - 3.5 + grows, color);
    }
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, &name));
    let response = response.on_hover_cursor(egui::CursorIcon::Grab);
    let by = response.drag_delta();
    if by == Vec2::ZERO || !response.dragged_by(egui::PointerButton::Primary) {
        return None;
    }
    match grip.handle {
        Handle::Move(_) | Handle::Size(_) => screen.along(grip.from, grip.at, by),
        Handle::Aim | Handle::End(_) => screen.beside(grip.at, by),
    }
}

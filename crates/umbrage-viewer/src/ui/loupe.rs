//! The loupe: the pixel under the cursor, all that is known of it, and the light as it sees it.

use super::over;
use crate::app::Lab;
use crate::loupe::{Known, Place, Texel};
use crate::pane::Pane;
use eframe::egui::{self, Color32, ColorImage, Rect, Sense, Stroke, StrokeKind, TextureHandle, TextureOptions, Vec2};
use std::collections::BTreeMap;
use std::sync::Arc;
use umbrage_reference::LightSeen;

/// Points for each pixel of the picture.
const ZOOM: f32 = 8.0;
/// Pixels across and down that are seen.
const AROUND: f32 = 17.0;

/// What the window of the loupe keeps between frames.
#[derive(Default)]
pub(crate) struct Kept {
    /// The pane and the pixel.
    at: Option<(usize, (u32, u32))>,
    /// The picture of the light, and of what it is.
    picture: Option<(TextureHandle, Arc<Known>)>,
}

pub(super) fn show(lab: &mut Lab, context: &egui::Context) {
    if !lab.face.see.has_loupe {
        lab.face.see.loupe.hold(None);
        return;
    }
    if let Some(at) = under_cursor(lab) {
        lab.face.see.kept.at = Some(at);
    }
    let place = lab.face.see.kept.at.and_then(|at| place(lab, at));
    lab.face.see.loupe.hold(place);
    if lab.face.see.loupe.is_under_way() {
        context.request_repaint_after(std::time::Duration::from_millis(15));
    }
    let mut is_open = true;
    let corner = egui::pos2(context.content_rect().right() - 455.0, 60.0).max(egui::Pos2::ZERO);
    egui::Window::new("Loupe").open(&mut is_open).default_pos(corner).resizable(false).show(context, |ui| {
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                zoom(lab, ui);
                light(lab, ui);
            });
            ui.vertical(|ui| numbers(lab, ui));
        });
    });
    lab.face.see.has_loupe = is_open;
}

fn under_cursor(lab: &Lab) -> Option<(usize, (u32, u32))> {
    let (number, share) = lab.face.cursor?;
    if !over::is_of_screen(lab, number, &lab.state.panes.get(number)?.picture) {
        return None;
    }
    let (width, height) = lab.panes.get(number)?.size();
    let of = |share: f32, length: u32| ((share * length as f32).max(0.0) as u32).min(length - 1);
    Some((number, (of(share[0], width), of(share[1], height))))
}

fn place(lab: &Lab, (number, pixel): (usize, (u32, u32))) -> Option<Place> {
    let (stage, pane) = (lab.stage.as_ref()?, lab.panes.get(number)?);
    let is_overlooked = crate::state::is_overlooked(&lab.state.panes.get(number)?.picture);
    let seen = stage.seen(&lab.state);
    Some(Place {
        tracer: stage.tracer.clone()?,
        textures: stage.textures.clone(),
        camera: if is_overlooked { seen.eye().clone() } else { seen.camera.clone() },
        size: pane.size(),
        pixel,
        light: seen.main_light()?.clone(),
        maps: pane.maps.clone(),
    })
}

/// The pixels around the one under the cursor, each as a square.
fn zoom(lab: &Lab, ui: &mut egui::Ui) {
    let (area, painter) = ui.allocate_painter(Vec2::splat(AROUND * ZOOM), Sense::hover());
    painter.rect_filled(area.rect, 0.0, Color32::BLACK);
    let Some((number, (x, y))) = lab.face.see.kept.at else { return };
    let Some(pane) = lab.panes.get(number) else { return };
    let size = Vec2::new(pane.size().0 as f32, pane.size().1 as f32);
    let middle = egui::pos2(x as f32 + 0.5, y as f32 + 0.5);
    let seen = Rect::from_center_size(middle, Vec2::splat(AROUND));
    // Only what there is of the picture.
    let part = seen.intersect(Rect::from_min_size(egui::Pos2::ZERO, size));
    let to_screen = |p: egui::Pos2| area.rect.min + (p - seen.min) * ZOOM;
    let shares = Rect::from_min_max((part.min.to_vec2() / size).to_pos2(), (part.max.to_vec2() / size).to_pos2());
    painter.image(pane.id, Rect::from_min_max(to_screen(part.min), to_screen(part.max)), shares, Color32::WHITE);
    let pixel = Rect::from_center_size(to_screen(middle), Vec2::splat(ZOOM));
    painter.rect_stroke(pixel, 0.0, Stroke::new(1.0, Color32::YELLOW), StrokeKind::Outside);
}

/// The light as the point sees it, and what hides it.
fn light(lab: &mut Lab, ui: &mut egui::Ui) {
    let see = &mut lab.face.see;
    let Some((_, Some(known))) = see.loupe.known() else { return };
    let known = known.clone();
    let is_new = see.kept.picture.as_ref().is_none_or(|(_, of)| !Arc::ptr_eq(of, &known));
    if is_new {
        let picture = picture(&known.light);
        match &mut see.kept.picture {
            Some((texture, of)) => {
                texture.set(picture, TextureOptions::NEAREST);
                *of = known.clone();
            }
            none => *none = Some((ui.ctx().load_texture("light", picture, TextureOptions::NEAREST), known.clone())),
        }
    }
    ui.label("the light from there").on_hover_text(
        "The light's shape as the point sees it: bright where it is seen, in the colour of the model where that hides it.",
    );
    if let Some((texture, _)) = &see.kept.picture {
        ui.image((texture.id(), Vec2::splat(AROUND * ZOOM)));
    }
    for (model, share) in hidden(&known.light) {
        ui.horizontal(|ui| {
            let (area, painter) = ui.allocate_painter(Vec2::splat(10.0), Sense::hover());
            painter.rect_filled(area.rect, 2.0, color(model));
            let own = if model == known.shown.model { ", its own" } else { "" };
            ui.label(format!("model {model}{own}: {:.0} %", share * 100.0));
        });
    }
}

/// The share of the light that each model hides, the largest first.
fn hidden(light: &LightSeen) -> Vec<(i32, f64)> {
    let mut shares: BTreeMap<i32, f64> = BTreeMap::new();
    let mut all = 0.0;
    for spot in &light.spots.data {
        all += f64::from(spot.brightness);
        if let Some(blocker) = spot.blocker {
            *shares.entry(blocker.model).or_default() += f64::from(spot.brightness);
        }
    }
    let mut shares: Vec<_> = shares.into_iter().map(|(m, s)| (m, s / all)).filter(|(_, s)| *s > 0.0).collect();
    shares.sort_by(|a, b| b.1.total_cmp(&a.1));
    shares.truncate(5);
    shares
}

fn picture(light: &LightSeen) -> ColorImage {
    let (width, height) = light.spots.size();
    let pixels = light.spots.data.iter().map(|spot| match spot.blocker {
        None if spot.brightness > 0.0 => lit(spot.brightness),
        None => Color32::from_gray(28),
        // Beside the light what hides it is there too, darker.
        Some(blocker) if spot.brightness > 0.0 => color(blocker.model),
        Some(blocker) => darker(color(blocker.model)),
    });
    ColorImage::new([width as usize, height as usize], pixels.collect())
}

fn darker(color: Color32) -> Color32 {
    Color32::from_rgb(color.r() / 3, color.g() / 3, color.b() / 3)
}

/// Warm white, darker where a textured light is.
fn lit(brightness: f32) -> Color32 {
    let share = brightness.sqrt().clamp(0.25, 1.0);
    Color32::from_rgb((255.0 * share) as u8, (244.0 * share) as u8, (200.0 * share) as u8)
}

/// Each model has a colour; neighbouring numbers differ most.
fn color(model: i32) -> Color32 {
    let hue = (model as f32 * 0.618_034 + 0.55).rem_euclid(1.0);
    egui::ecolor::Hsva::new(hue, 0.75, 0.6, 1.0).into()
}

fn numbers(lab: &Lab, ui: &mut egui::Ui) {
    ui.set_min_width(230.0);
    let Some((pixel, known)) = lab.face.see.loupe.known() else {
        let is_ready = lab.stage.as_ref().is_some_and(|stage| stage.tracer.is_some());
        ui.weak(if is_ready { "Point at a picture." } else { "The scene is being made ready for rays." });
        return;
    };
    egui::Grid::new("loupe").num_columns(2).show(ui, |ui| {
        let mut line = |name: &str, value: String, about: &str| {
            ui.label(name).on_hover_text(about);
            ui.monospace(value);
            ui.end_row();
        };
        line("pixel", format!("{}, {}", pixel.0, pixel.1), "From the left top corner of the picture");
        let pane = lab.face.see.kept.at.and_then(|(number, _)| lab.panes.get(number));
        if let Some(value) = pane.and_then(|pane| produced(pane, pixel)) {
            line("visibility", format!("{value:.4}"), "By the technique");
        }
        let Some(known) = known else {
            line("surface", "none".into(), "The pixel shows the background");
            return;
        };
        let (truth, error) = truth(lab, pixel, known);
        line("truth", truth, "The share of the light that the pixel's middle sees, by rays");
        line("its error", error, "Standard error of the progressive truth, of the whole picture");
        of_surface(known, &mut line);
        of_shadow(known, &mut line);
        match &known.texel {
            Some(texel) => of_map(texel, &mut line),
            None => line("map", "none here".into(), "No map of the technique covers the point"),
        }
    });
}

/// The technique's visibility.
fn produced(pane: &Pane, (x, y): (u32, u32)) -> Option<f32> {
    pane.visibility.as_ref()?.get(x.into(), y.into()).copied()
}

fn truth(lab: &Lab, _: (u32, u32), known: &Known) -> (String, String) {
    let traced = lab.truth.of(lab.state.light.unwrap_or_default());
    let error = traced.and_then(|traced| traced.standard_error);
    let text = match () {
        () if known.cosine <= 0.0 => "not scored: it faces away".into(),
        () if !known.shown.receives => "not scored: it receives none".into(),
        () => format!("{:.4}", known.visibility),
    };
    (text, error.map_or("not known yet".into(), |e| format!("± {e:.4}")))
}

fn of_surface(known: &Known, line: &mut impl FnMut(&str, String, &str)) {
    let position = known.shown.surface.position;
    line("model", known.shown.model.to_string(), "Number of the model in the scene file");
    line("place", format!("{:.3} {:.3} {:.3}", position.x, position.y, position.z), "Of the surface, metres");
    line("depth", length(known.shown.depth), "Along the view");
    line("to the light", known.distance.map_or("parallel".into(), length), "To the light's centre");
    line("N·L", format!("{:.4}", known.cosine), "Cosine between the normal and the way to the light's centre");
}

fn of_shadow(known: &Known, line: &mut impl FnMut(&str, String, &str)) {
    let Some(blocker) = known.blocker else {
        line("blocker", "none".into(), "Nothing is on the way to the light's centre");
        return;
    };
    let what = if blocker.distance > 0.0 {
        format!("model {}, {}", blocker.model, length(blocker.distance))
    } else {
        "its own plane".into()
    };
    line("blocker", what, "The first on the way to the light's centre, and how far away it is");
    if let Some(width) = known.penumbra {
        let about = "Across the light, of an edge as far away as the blocker: light's width × gap / (distance − gap)";
        line("penumbra", length(width), about);
    }
}

fn of_map(texel: &Texel, line: &mut impl FnMut(&str, String, &str)) {
    line("map", format!("layer {} of {}²", texel.layer, texel.size), "Of the technique, where it looks the point up");
    line("texel", format!("{:.1}, {:.1}", texel.place.x, texel.place.y), "From the left top corner of the map");
    let pixels = format!("{:.2} px, {}", texel.on_screen, length(texel.across));
    line("its size", pixels, "On the screen, and in the scene across the light");
    line("bias", length(texel.bias), "How much deeper the surface is half a texel away, as the light sees it");
}

/// A length that can be read.
fn length(metres: f64) -> String {
    match metres.abs() {
        m if m.is_infinite() => "endless".into(),
        m if m < 1.0 => format!("{:.2} mm", metres * 1e3),
        _ => format!("{metres:.3} m"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_the_unit_they_need() {
        assert_eq!([0.0012, 2.5, f64::INFINITY].map(length), ["1.20 mm", "2.500 m", "endless"]);
    }

    #[test]
    fn neighbouring_models_differ() {
        let colors: Vec<Color32> = (-1..12).map(color).collect();
        let unique: std::collections::BTreeSet<_> = colors.iter().map(|c| c.to_array()).collect();
        assert_eq!(unique.len(), colors.len());
    }
}

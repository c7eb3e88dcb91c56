//! What is drawn over the pictures: the frozen camera and what belongs to it, and the mark.

use crate::app::Lab;
use crate::loupe::texel_of;
use crate::overlay::{Line, Shapes, What, geometry};
use crate::see::Lines;
use crate::show::fitted;
use crate::state::{PICTURES, is_overlooked};
use eframe::egui::{self, Color32, Painter, Pos2, Rect, Stroke, Vec2};
use std::sync::Arc;
use umbrage_core::Camera;
use umbrage_core::glam::{DMat4, DVec2, DVec3, DVec4};
use umbrage_core::light_view::LightView;

/// Half the size of the mark, points.
const MARK: f32 = 7.0;

/// What each line looks like.
fn color(what: What) -> Color32 {
    match what {
        What::Camera => Color32::WHITE,
        What::Split => Color32::from_rgb(120, 200, 255),
        What::Map => Color32::from_rgb(255, 200, 60),
        What::Kept => Color32::from_rgb(90, 220, 110),
        What::Culled => Color32::from_rgb(230, 80, 70),
        What::Silhouette => Color32::from_rgb(255, 120, 230),
        What::Volume => Color32::from_rgba_unmultiplied(150, 120, 255, 120),
        What::Wedge => Color32::from_rgba_unmultiplied(255, 150, 60, 120),
    }
}

/// The window of what is drawn, where there is an observer.
pub(super) fn window(lab: &mut Lab, context: &egui::Context) {
    if lab.state.observer.is_none() {
        return;
    }
    let corner = egui::pos2(290.0, context.content_rect().bottom() - 300.0).max(Pos2::ZERO);
    egui::Window::new("Observer").default_pos(corner).resizable(false).show(context, |ui| {
        ui.set_max_width(230.0);
        ui.label("The camera is frozen, and techniques work for it. Bright: what it sees, with the shadows found for it; dark: what it does not.");
        for (what, name) in What::ALL {
            let shows = &mut lab.face.see.shows;
            let mut is_on = shows.contains(&what);
            if ui.checkbox(&mut is_on, egui::RichText::new(name).color(color(what).to_opaque())).changed() {
                shows.retain(|other| *other != what);
                shows.extend(is_on.then_some(what));
            }
        }
        if ui.button("Back to the camera").on_hover_text("Key O").clicked() {
            lab.state.observer = None;
        }
    });
}

/// Draws over the picture of pane `number`, which lies in `cell`.
pub(super) fn draw(lab: &mut Lab, painter: &Painter, number: usize, cell: Rect) {
    let Some(picture) = lab.state.panes.get(number).map(|pane| pane.picture.clone()) else { return };
    if lab.state.observer.is_some() && is_overlooked(&picture) {
        let lines = lines(lab, number, cell, painter.ctx());
        let clip_from_world = clip_from_world(lab.state.eye(), cell);
        for line in lines.iter() {
            if let Some(ends) = seen(line, &clip_from_world, cell) {
                painter.line_segment(ends, Stroke::new(1.0, color(line.what)));
            }
        }
    }
    let at = lab.face.see.mark.and_then(|mark| on_pane(lab, number, &picture, mark, cell));
    let crosses = &mut lab.face.see.crosses;
    crosses.resize(crosses.len().max(number + 1), None);
    crosses[number] = at.map(Into::into);
    if let Some(at) = at {
        cross(painter, at);
    }
}

fn cross(painter: &Painter, at: Pos2) {
    for (width, color) in [(3.0, Color32::BLACK), (1.0, Color32::YELLOW)] {
        for by in [Vec2::new(MARK, 0.0), Vec2::new(0.0, MARK)] {
            painter.line_segment([at - by, at + by], Stroke::new(width, color));
        }
    }
}

fn clip_from_world(camera: &Camera, cell: Rect) -> DMat4 {
    let size = cell.size().max(Vec2::splat(1.0));
    camera.view(size.x.round() as u32, size.y.round() as u32).clip_from_world()
}

/// The lines of a pane, found anew where something has changed.
fn lines(lab: &mut Lab, number: usize, cell: Rect, context: &egui::Context) -> Arc<Vec<Line>> {
    let (Some(stage), Some(pane)) = (&lab.stage, lab.panes.get(number)) else { return Arc::default() };
    let see = &mut lab.face.see;
    let version = lab.stage_version;
    if let Some((of, shapes)) = see.shaping.take() {
        see.shapes = Some((of, shapes));
    }
    if see.shapes.as_ref().is_none_or(|(of, _)| *of != version) {
        if !see.shaping.is_under_way() {
            let scene = geometry(&stage.source.scene);
            see.shaping.start(move || (version, Arc::new(Shapes::new(scene))));
        }
        context.request_repaint_after(std::time::Duration::from_millis(30));
        return Arc::default();
    }
    let (Some((_, shapes)), Some(light)) = (&see.shapes, lab.state.main_light()) else { return Arc::default() };
    let mut maps = pane.maps.clone();
    if maps.camera != lab.state.camera {
        // The picture is one frame behind, or its technique has no maps.
        Arc::make_mut(&mut maps).camera.clone_from(&lab.state.camera);
    }
    let of = Lines { version, light: light.clone(), maps, shows: see.shows.clone(), aspect: cell.aspect_ratio() };
    see.lines.resize_with(see.lines.len().max(number + 1), Default::default);
    let known = &mut see.lines[number];
    if known.as_ref().is_none_or(|(old, _)| *old != of) {
        let lines = shapes.lines(&of.light, &of.maps, of.aspect.into(), &of.shows);
        *known = Some((of, Arc::new(lines)));
    }
    known.as_ref().map(|(_, lines)| lines.clone()).unwrap_or_default()
}

/// A line on the screen: the part of it before the near plane.
fn seen(line: &Line, clip_from_world: &DMat4, cell: Rect) -> Option<[Pos2; 2]> {
    let [mut a, mut b] = [line.from, line.to].map(|p| *clip_from_world * p.extend(1.0));
    // Before the near plane depth is 1 at most.
    let before = |p: DVec4| p.w - p.z;
    let (at_a, at_b) = (before(a), before(b));
    if at_a < 0.0 && at_b < 0.0 {
        return None;
    }
    let cut = a + (b - a) * (at_a / (at_a - at_b));
    if at_a < 0.0 {
        a = cut;
    } else if at_b < 0.0 {
        b = cut;
    }
    let ends = [a, b].map(|p| on_screen(p, cell));
    // Far outside of the window coordinates mean nothing to who paints.
    ends.iter().all(|p| p.x.abs() < 1e6 && p.y.abs() < 1e6).then_some(ends)
}

fn on_screen(clip: DVec4, cell: Rect) -> Pos2 {
    let ndc = clip.truncate() / clip.w;
    let share = Vec2::new((ndc.x * 0.5 + 0.5) as f32, (0.5 - ndc.y * 0.5) as f32);
    cell.min + share * cell.size()
}

/// The view that a picture of a map is of.
fn view_of<'a>(lab: &'a Lab, number: usize, picture: &str) -> Option<&'a LightView> {
    let layer: u32 = picture.strip_prefix("map-")?.parse().ok()?;
    lab.panes.get(number)?.maps.views.iter().find(|view| view.layer == layer)
}

/// Where a map lies in a cell: its left top corner, and points for each texel.
fn map_in(lab: &Lab, number: usize, view: &LightView, cell: Rect) -> Option<(Pos2, f32)> {
    let (width, height) = lab.panes.get(number)?.size();
    let (size, pane) = (view.size as f32, Vec2::new(width as f32, height as f32));
    let [begin, end] = fitted([size; 2], pane.into());
    let scale = cell.size() / pane;
    Some((cell.min + Vec2::from(begin) * scale, (end[0] - begin[0]) * scale.x / size))
}

/// Where a point of the world is in a pane.
fn on_pane(lab: &Lab, number: usize, picture: &str, point: DVec3, cell: Rect) -> Option<Pos2> {
    if let Some(view) = view_of(lab, number, picture) {
        let texel = texel_of(view, point)?;
        let is_inside = texel.min_element() >= 0.0 && texel.max_element() <= f64::from(view.size);
        let (corner, scale) = map_in(lab, number, view, cell)?;
        return is_inside.then(|| corner + Vec2::new(texel.x as f32, texel.y as f32) * scale);
    }
    if !is_of_screen(lab, number, picture) {
        return None;
    }
    let seen = lab.seen();
    let eye = if is_overlooked(picture) { seen.eye() } else { &seen.camera };
    let clip = clip_from_world(eye, cell) * point.extend(1.0);
    (clip.w > 0.0).then(|| on_screen(clip, cell))
}

/// The picture shows the scene from the camera.
pub(super) fn is_of_screen(lab: &Lab, number: usize, picture: &str) -> bool {
    let is_one = |(name, _): &(&str, &str)| *name == picture;
    number < lab.panes.len() && PICTURES.iter().any(is_one)
}

/// Marks what was clicked: a point of the scene, or what the light first meets through a texel.
pub(super) fn click(lab: &mut Lab, number: usize, at: Pos2, cell: Rect) {
    let Some(picture) = lab.state.panes.get(number).map(|pane| pane.picture.clone()) else { return };
    let Some(tracer) = lab.stage.as_ref().and_then(|stage| stage.tracer.clone()) else { return };
    lab.face.see.mark = if let Some(view) = view_of(lab, number, &picture) {
        let Some((corner, scale)) = map_in(lab, number, view, cell) else { return };
        let texel = (at - corner) / scale;
        let (from, way) = view.ray(DVec2::new(texel.x.into(), texel.y.into()));
        let is_inside = texel.min_elem() >= 0.0 && texel.max_elem() <= view.size as f32;
        is_inside.then(|| tracer.first_caster(from, way)).flatten()
    } else if is_of_screen(lab, number, &picture) {
        let size = cell.size().max(Vec2::splat(1.0));
        let pixel = (at - cell.min).clamp(Vec2::ZERO, size - Vec2::splat(1.0));
        let seen = lab.seen();
        let camera = if is_overlooked(&picture) { seen.eye() } else { &seen.camera };
        let shown = tracer.look(camera, (pixel.x as u32, pixel.y as u32), (size.x as u32, size.y as u32));
        shown.map(|shown| shown.surface.position)
    } else {
        None
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_at_the_near_plane() {
        let camera = Camera { eye: DVec3::ZERO, target: DVec3::NEG_Z, ..Camera::default() };
        let clip = camera.view(100, 100).clip_from_world();
        let cell = Rect::from_min_size(Pos2::ZERO, Vec2::splat(100.0));
        let line = |from, to| Line { from, to, what: What::Map };
        let behind = line(DVec3::new(0.0, 0.0, 3.0), DVec3::new(1.0, 0.0, 2.0));
        assert_eq!(seen(&behind, &clip, cell), None);
        let through = line(DVec3::new(0.0, 0.0, 3.0), DVec3::new(0.0, 0.0, -3.0));
        let ends = seen(&through, &clip, cell).unwrap_or_default();
        assert!(ends.iter().all(|p| p.distance(Pos2::new(50.0, 50.0)) < 1e-3), "{ends:?}");
    }
}

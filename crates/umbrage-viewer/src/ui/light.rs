//! The light that is shown: its kind, place and size.

use crate::app::Lab;
use crate::camera::{sun_angles, sun_direction};
use crate::kinds;
use eframe::egui::{self, DragValue, Slider};
use umbrage_core::glam::DVec3;
use umbrage_core::{Light, LightKind, LightShape};

pub(super) fn show(lab: &mut Lab, ui: &mut egui::Ui) {
    let radius = lab.stage.as_ref().map_or(1.0, |stage| stage.radius).max(1e-3);
    ui.heading("Light");
    ui.horizontal(|ui| {
        let text = "Handles to move, aim and size the light with the mouse (G)";
        ui.checkbox(&mut lab.face.shows_gizmo, "handles").on_hover_text(text);
        let text = "The rectangle of the screen that the light can light (Shift+G)";
        ui.checkbox(&mut lab.face.shows_lit_part, "rectangle").on_hover_text(text);
    });
    let names: Vec<String> = (lab.state.lights.iter().enumerate())
        .map(|(number, light)| format!("{number}: {}", light.shape.kind().name()))
        .collect();
    let now = lab.state.light.and_then(|light| names.get(light).cloned()).unwrap_or_else(|| "all".into());
    egui::ComboBox::from_label("shines").selected_text(now).show_ui(ui, |ui| {
        for (number, name) in names.iter().enumerate() {
            ui.selectable_value(&mut lab.state.light, Some(number), name);
        }
        ui.selectable_value(&mut lab.state.light, None, "all");
    });
    let number = lab.state.light.unwrap_or_default();
    let Some(light) = lab.state.lights.get_mut(number) else { return };
    kind(light, radius, ui);
    egui::Grid::new("light").num_columns(2).show(ui, |ui| shape(&mut light.shape, radius, ui));
    ui.add(Slider::new(&mut light.intensity, 0.0..=20.0).logarithmic(true).text("intensity"));
    let original = lab.stage.as_ref().and_then(|stage| stage.source.scene.lights.get(number));
    if let Some(original) = original
        && ui.add_enabled(original != light, egui::Button::new("As the scene has it")).clicked()
    {
        light.clone_from(original);
    }
}

fn kind(light: &mut Light, radius: f64, ui: &mut egui::Ui) {
    let now = light.shape.kind();
    let mut chosen = now;
    egui::ComboBox::from_label("kind").selected_text(now.name()).show_ui(ui, |ui| {
        for kind in LightKind::ALL {
            ui.selectable_value(&mut chosen, kind, kind.name());
        }
    });
    if chosen != now {
        light.shape = kinds::changed(&light.shape, chosen, radius);
    }
}

fn shape(shape: &mut LightShape, radius: f64, ui: &mut egui::Ui) {
    match shape {
        LightShape::Point { position } => place(ui, "position", position, radius),
        LightShape::Spot { position, direction, inner_angle_deg, outer_angle_deg } => {
            place(ui, "position", position, radius);
            aim(ui, direction);
            number(ui, "inner angle", inner_angle_deg, 0.0..=*outer_angle_deg, "°");
            number(ui, "outer angle", outer_angle_deg, inner_angle_deg.max(0.5)..=89.0, "°");
        }
        LightShape::Directional { direction, angle_deg } => {
            aim(ui, direction);
            time_of_day(ui, direction);
            number(ui, "diameter", angle_deg, 0.0..=20.0, "°");
        }
        LightShape::Sphere { position, radius: size } => {
            place(ui, "position", position, radius);
            number(ui, "radius", size, 0.0..=radius * 0.5, " m");
        }
        LightShape::Ellipsoid { position, radii, .. } => {
            place(ui, "position", position, radius);
            for (name, size) in ["radius x", "radius y", "radius z"].into_iter().zip(radii.as_mut()) {
                number(ui, name, size, radius * 1e-3..=radius * 0.5, " m");
            }
        }
        LightShape::Disc { position, direction, radius: size } => {
            place(ui, "position", position, radius);
            aim(ui, direction);
            number(ui, "radius", size, 0.0..=radius * 0.5, " m");
        }
        LightShape::Rect { position, direction, up, size, .. } => {
            place(ui, "position", position, radius);
            let before = *direction;
            aim(ui, direction);
            if before != *direction {
                let turned = up.reject_from_normalized(*direction);
                *up = turned.try_normalize().unwrap_or_else(|| direction.any_orthonormal_vector());
            }
            number(ui, "width", &mut size.x, radius * 1e-3..=radius, " m");
            number(ui, "height", &mut size.y, radius * 1e-3..=radius, " m");
        }
        LightShape::Line { from, to } => {
            let before = *to;
            place(ui, "from", from, radius);
            place(ui, "to", to, radius);
            if from == to {
                // A line without length is none.
                *to = if before == *from { *from + DVec3::X * radius * 1e-3 } else { before };
            }
        }
        LightShape::Environment(sky) => number(ui, "turn", &mut sky.rotate_deg, -180.0..=180.0, "°"),
    }
}

fn number(ui: &mut egui::Ui, name: &str, value: &mut f64, range: std::ops::RangeInclusive<f64>, unit: &str) {
    let label = ui.label(name).id;
    ui.add(Slider::new(value, range).suffix(unit)).labelled_by(label);
    ui.end_row();
}

fn place(ui: &mut egui::Ui, name: &str, value: &mut DVec3, radius: f64) {
    let label = ui.label(name).id;
    ui.horizontal(|ui| {
        for part in value.as_mut() {
            ui.add(DragValue::new(part).speed(radius * 0.005).max_decimals(4).suffix(" m")).labelled_by(label);
        }
    });
    ui.end_row();
}

fn aim(ui: &mut egui::Ui, direction: &mut DVec3) {
    let mut angles = sun_angles(*direction);
    let [azimuth, height] = &mut angles;
    ui.label("from");
    let round = ui.add(Slider::new(azimuth, 0.0..=360.0).suffix("°").text("round"));
    ui.end_row();
    ui.label("");
    let up = ui.add(Slider::new(height, -90.0..=90.0).suffix("°").text("up"));
    ui.end_row();
    if round.changed() || up.changed() {
        *direction = sun_direction(angles);
    }
}

/// How high the sun gets, degrees: that of the middle latitudes in spring.
const NOON_DEG: f64 = 50.0;

/// The sun of a day in spring: it rises in the east at six and sets in the west at eighteen.
fn time_of_day(ui: &mut egui::Ui, direction: &mut DVec3) {
    let to = -*direction;
    let noon = NOON_DEG.to_radians();
    let mut hour = 12.0 + (-to.x).atan2((to.y / noon.sin()).max(1e-9)).to_degrees() / 15.0;
    let label = ui.label("time of day").id;
    let text = |hour: f64| format!("{:02}:{:02}", hour as u32, (hour.fract() * 60.0) as u32);
    let slider = Slider::new(&mut hour, 6.1..=17.9).custom_formatter(move |hour, _| text(hour));
    if ui.add(slider).labelled_by(label).changed() {
        let angle = ((hour - 12.0) * 15.0f64).to_radians();
        *direction = -DVec3::new(-angle.sin(), angle.cos() * noon.sin(), angle.cos() * noon.cos()).normalize();
    }
    ui.end_row();
}

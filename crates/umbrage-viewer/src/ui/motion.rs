//! What moves by itself: the bench's motions and ways of the camera, and animations.

use crate::app::Lab;
use crate::stage::Stage;
use eframe::egui::{self, DragValue, Slider};
use umbrage_report::{CameraPath, Moving, PERIOD};

/// Frames a second.
const RATE: f64 = 30.0;
/// Slowest and fastest play.
const SPEEDS: std::ops::RangeInclusive<f64> = 0.05..=4.0;

/// What can move, with the words for it.
const MOVING: [(Moving, &str); 5] = [
    (Moving::None, "nothing"),
    (Moving::Lights, "lights"),
    (Moving::Casters, "casters"),
    (Moving::Camera, "camera"),
    (Moving::All, "all"),
];

pub(super) fn show(lab: &mut Lab, ui: &mut egui::Ui) {
    ui.heading("Motion");
    let word = MOVING.iter().find(|(moving, _)| *moving == lab.state.moving).map_or("nothing", |(_, word)| *word);
    egui::ComboBox::from_label("moves").selected_text(word).show_ui(ui, |ui| {
        for (moving, word) in MOVING {
            ui.selectable_value(&mut lab.state.moving, moving, word);
        }
    });
    let word = lab.state.path.map_or("none", CameraPath::name);
    egui::ComboBox::from_label("camera's way").selected_text(word).show_ui(ui, |ui| {
        ui.selectable_value(&mut lab.state.path, None, "none");
        for path in CameraPath::ALL {
            ui.selectable_value(&mut lab.state.path, Some(path), path.name());
        }
    });
    ui.horizontal(|ui| {
        let word = if lab.face.plays { "Pause" } else { "Play" };
        if ui.button(word).on_hover_text("K").clicked() {
            play(lab);
        }
        if ui.button("Step back").on_hover_text("One frame (,)").clicked() {
            step(lab, false);
        }
        if ui.button("Step").on_hover_text("One frame (.)").clicked() {
            step(lab, true);
        }
    });
    if moves_by_frames(lab) {
        let last = period(lab) - 1;
        lab.state.frame = lab.state.frame.min(last);
        ui.add(Slider::new(&mut lab.state.frame, 0..=last).text("frame"));
    }
    if lab.stage.as_ref().is_some_and(Stage::is_animated) {
        ui.horizontal(|ui| {
            let label = ui.label("time").on_hover_text("How far animations have moved on").id;
            ui.add(DragValue::new(&mut lab.state.time_s).speed(0.01).suffix(" s")).labelled_by(label);
        });
    }
    ui.add(Slider::new(&mut lab.face.speed, SPEEDS).logarithmic(true).text("speed ×"));
}

fn moves_by_frames(lab: &Lab) -> bool {
    let moves = [Moving::Lights, Moving::Casters, Moving::Camera].into_iter().any(|part| lab.state.moving.moves(part));
    moves || lab.state.path.is_some()
}

/// Frames until all is as at the start.
fn period(lab: &Lab) -> u32 {
    let height = lab.stage.as_ref().map_or(1, |stage| stage.renderer.size().1);
    match (lab.state.moving, lab.state.path) {
        (Moving::None, Some(_)) => CameraPath::period(height),
        (_, None) => PERIOD,
        (_, Some(_)) => common_multiple(PERIOD, CameraPath::period(height)),
    }
}

/// The smallest one.
fn common_multiple(a: u32, b: u32) -> u32 {
    let (mut x, mut y) = (a, b);
    while y != 0 {
        (x, y) = (y, x % y);
    }
    a / x.max(1) * b
}

/// Lets what can move play, and stops it. Where nothing can, lights do.
pub(super) fn play(lab: &mut Lab) {
    lab.face.plays = !lab.face.plays;
    let is_animated = lab.stage.as_ref().is_some_and(Stage::is_animated);
    if lab.face.plays && !moves_by_frames(lab) && !is_animated {
        lab.state.moving = Moving::Lights;
    }
}

/// One frame forward or back.
pub(super) fn step(lab: &mut Lab, forward: bool) {
    lab.face.plays = false;
    if moves_by_frames(lab) {
        let period = period(lab);
        let by = if forward { 1 } else { period - 1 };
        lab.state.frame = (lab.state.frame % period + by) % period;
    } else {
        lab.state.time_s += if forward { 1.0 } else { -1.0 } / RATE;
    }
}

/// Lets what plays go ahead.
pub(super) fn advance(lab: &mut Lab, passed_s: f64) {
    if !lab.face.plays {
        return;
    }
    if lab.stage.as_ref().is_some_and(Stage::is_animated) && !lab.state.moving.moves(Moving::Casters) {
        lab.state.time_s += passed_s * lab.face.speed;
    }
    if moves_by_frames(lab) {
        let passed = lab.face.part_of_frame + passed_s * lab.face.speed * RATE;
        lab.face.part_of_frame = passed.fract();
        lab.state.frame = (lab.state.frame % period(lab) + passed as u32) % period(lab);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_periods_have_a_common_one() {
        assert_eq!([common_multiple(60, 96), common_multiple(60, 60), common_multiple(60, 4)], [480, 60, 60]);
    }
}

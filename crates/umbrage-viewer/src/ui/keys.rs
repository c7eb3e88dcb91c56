//! What keys do. The letters are those of the thesis' program.

use super::panes::eye;
use super::{bar, motion};
use crate::app::Lab;
use crate::camera;
use eframe::egui::{self, Key, Modifiers};
use umbrage_core::glam::DVec3;
use umbrage_report::RAY_TRACED;

/// How far keys go: shares of the scene's radius a second.
const SPEED: f64 = 0.6;

/// What hands can do, as the help shows it.
const HELP: &[(&str, &str)] = &[
    ("left drag", "turns the scene"),
    ("left click", "marks a point in all panes: in the scene, and its texel in maps"),
    ("shift + left drag", "looks around"),
    ("middle drag", "moves the light at constant height; turns the sun"),
    ("right click", "menu of all techniques"),
    ("wheel, + and −", "nearer and farther away"),
    ("W A S D", "walk; with shift fly where the camera looks"),
    ("Space", "next technique; with shift the one before"),
    ("Return", "starts and stops the scene's rotation"),
    ("Page up, Page down", "light up and down"),
    ("Tab", "next pane"),
    ("T", "technique, truth and error side by side"),
    ("B", "blinks between two panes"),
    ("V", "visibility only, and back"),
    ("E", "error against the truth, and back"),
    ("L", "next light; after the last all of them"),
    ("G", "the light's handles: move, aim, size; with shift the rectangle that it can light"),
    ("H", "reads about the technique: how it works, its limits, a tour"),
    ("K", "lets what can move play, and stops it"),
    (", and .", "one frame of it back and forward"),
    ("O", "freezes the camera and looks on from outside"),
    ("P", "loupe: all that is known of the pixel, and the light as it sees it"),
    ("I", "text on the pictures"),
    ("C", "copies the camera as the scene format has it"),
    ("Ctrl+S", "snapshot"),
    ("Ctrl+Z, Ctrl+Y, Ctrl+F", "undo, redo, find"),
    ("Esc", "closes what is open, then the window"),
];

pub(super) fn take(lab: &mut Lab, context: &egui::Context, passed_s: f64) {
    if context.text_edit_focused() {
        if context.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape)) {
            lab.face.search = None;
        }
        return;
    }
    for (modifiers, key, act) in COMMANDS {
        if context.input_mut(|i| i.consume_key(*modifiers, *key)) {
            act(lab, context);
        }
    }
    walk(lab, context, passed_s);
}

type Act = fn(&mut Lab, &egui::Context);

/// Keys that are pressed once. Those with modifiers come first, since they are the same keys.
const COMMANDS: &[(Modifiers, Key, Act)] = &[
    (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z, |lab, _| bar::redo(lab)),
    (Modifiers::COMMAND, Key::Z, |lab, _| bar::undo(lab)),
    (Modifiers::COMMAND, Key::Y, |lab, _| bar::redo(lab)),
    (Modifiers::COMMAND, Key::F, |lab, _| _ = lab.face.search.get_or_insert_default()),
    #[cfg(not(target_family = "wasm"))]
    (Modifiers::COMMAND, Key::S, |lab, _| lab.face.keep = Some(crate::keep::Kind::Png)),
    (Modifiers::SHIFT, Key::Space, |lab, _| next_technique(lab, true)),
    (Modifiers::NONE, Key::Space, |lab, _| next_technique(lab, false)),
    (Modifiers::NONE, Key::Enter, |lab, _| lab.face.turns = !lab.face.turns),
    (Modifiers::NONE, Key::Tab, |lab, _| lab.face.active = (lab.face.active + 1) % lab.state.panes.len().max(1)),
    (Modifiers::NONE, Key::T, |lab, _| bar::compare_with_truth(lab)),
    (Modifiers::NONE, Key::B, |lab, _| blink(lab)),
    (Modifiers::NONE, Key::V, |lab, _| toggle_picture(lab, crate::state::VISIBILITY)),
    (Modifiers::NONE, Key::E, |lab, _| toggle_picture(lab, crate::state::ERROR)),
    (Modifiers::NONE, Key::L, |lab, _| next_light(lab)),
    (Modifiers::SHIFT, Key::G, |lab, _| lab.face.shows_lit_part = !lab.face.shows_lit_part),
    (Modifiers::NONE, Key::G, |lab, _| lab.face.shows_gizmo = !lab.face.shows_gizmo),
    (Modifiers::NONE, Key::H, |lab, _| read(lab)),
    (Modifiers::NONE, Key::K, |lab, _| motion::play(lab)),
    (Modifiers::NONE, Key::Comma, |lab, _| motion::step(lab, false)),
    (Modifiers::NONE, Key::Period, |lab, _| motion::step(lab, true)),
    (Modifiers::NONE, Key::O, |lab, _| {
        lab.state.observer = if lab.state.observer.is_some() { None } else { Some(lab.state.camera.clone()) };
    }),
    (Modifiers::NONE, Key::P, |lab, _| lab.face.see.has_loupe ^= true),
    (Modifiers::NONE, Key::I, |lab, _| lab.face.shows_text = !lab.face.shows_text),
    (Modifiers::NONE, Key::C, copy_camera),
    (Modifiers::SHIFT, Key::Questionmark, |lab, _| lab.face.shows_help = !lab.face.shows_help),
    (Modifiers::NONE, Key::Questionmark, |lab, _| lab.face.shows_help = !lab.face.shows_help),
    (Modifiers::NONE, Key::F1, |lab, _| lab.face.shows_help = !lab.face.shows_help),
    (Modifiers::NONE, Key::Escape, close),
];

fn next_technique(lab: &mut Lab, back: bool) {
    let ids: Vec<&str> = lab.registry.techniques().iter().map(|info| info.id).chain([RAY_TRACED]).collect();
    let kind = lab.state.main_light().map(|light| light.shape.kind());
    let now = lab.state.panes[lab.face.active].id().to_string();
    let place = ids.iter().position(|id| *id == now).unwrap_or_default();
    let count = ids.len();
    let step = |i: usize| if back { (place + count - i) % count } else { (place + i) % count };
    let can = |id: &str| match lab.registry.find(id) {
        Ok(info) => kind.is_none_or(|kind| info.supports(kind).is_ok()),
        Err(_) => true,
    };
    if let Some(id) = (1..=count).map(|i| ids[step(i)]).find(|id| can(id)) {
        bar::choose_technique(lab, id);
    }
}

fn next_light(lab: &mut Lab) {
    let next = lab.state.light.map_or(0, |light| light + 1);
    lab.state.light = (next < lab.state.lights.len()).then_some(next);
}

fn blink(lab: &mut Lab) {
    use crate::state::Layout::{Blink, Grid};
    if lab.state.panes.len() < 2 {
        bar::add_pane(lab);
    }
    lab.state.layout = if lab.state.layout == Blink { Grid } else { Blink };
}

fn toggle_picture(lab: &mut Lab, picture: &str) {
    let pane = &mut lab.state.panes[lab.face.active];
    pane.picture = if pane.picture == picture { crate::state::COLOR.into() } else { picture.into() };
}

/// Opens and closes the page of the active technique.
fn read(lab: &mut Lab) {
    let id = lab.state.panes[lab.face.active].id();
    lab.face.reads = (lab.face.reads.as_deref() != Some(id)).then(|| id.into());
}

fn copy_camera(lab: &mut Lab, context: &egui::Context) {
    let text = umbrage_io::changes(Some(lab.state.eye()), &[]);
    context.copy_text(text.clone());
    lab.face.say(format!("Copied: {text}"));
    lab.face.copied = Some(text);
}

fn close(lab: &mut Lab, context: &egui::Context) {
    let has_mark = |lab: &mut Lab| lab.face.see.mark.take().is_some();
    let has_help = |lab: &mut Lab| std::mem::take(&mut lab.face.shows_help);
    if lab.face.search.take().is_some() || lab.face.reads.take().is_some() || has_help(lab) || has_mark(lab) {
        return;
    }
    if cfg!(not(target_family = "wasm")) && !egui::Popup::is_any_open(context) {
        context.send_viewport_cmd(egui::ViewportCommand::Close);
    }
}

/// Keys that act as long as they are down.
fn walk(lab: &mut Lab, context: &egui::Context, passed_s: f64) {
    let radius = lab.stage.as_ref().map_or(1.0, |stage| stage.radius);
    let step = SPEED * passed_s;
    let (held, flies) = context.input(|i| {
        let down = |key| f64::from(u8::from(i.key_down(key) && !i.modifiers.command));
        let by = DVec3::new(down(Key::D) - down(Key::A), 0.0, down(Key::W) - down(Key::S));
        let rise = down(Key::PageUp) - down(Key::PageDown);
        let nearer = down(Key::Plus) + down(Key::Equals) - down(Key::Minus);
        ((by, rise, nearer), i.modifiers.shift)
    });
    let (by, rise, nearer) = held;
    if by != DVec3::ZERO {
        let eye = eye(lab);
        if flies { camera::shift(eye, by * step) } else { camera::walk(eye, by * (step * radius)) }
    }
    if nearer != 0.0 {
        camera::zoom(eye(lab), nearer * passed_s);
    }
    let number = lab.state.light.unwrap_or_default();
    if let Some(light) = lab.state.lights.get_mut(number).filter(|_| rise != 0.0) {
        camera::raise_light(light, rise * step * 0.5, radius);
    }
    if by != DVec3::ZERO || nearer != 0.0 || rise != 0.0 {
        context.request_repaint();
    }
}

/// The window of all keys, where it is open.
pub(super) fn help(lab: &mut Lab, context: &egui::Context) {
    let mut is_open = lab.face.shows_help;
    egui::Window::new("Keys and mouse").open(&mut is_open).show(context, |ui| {
        egui::Grid::new("keys").num_columns(2).striped(true).show(ui, |ui| {
            for &(keys, what) in HELP {
                ui.strong(keys);
                ui.label(what);
                ui.end_row();
            }
        });
    });
    lab.face.shows_help = is_open;
}

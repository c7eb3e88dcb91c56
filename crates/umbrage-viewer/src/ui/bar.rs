//! The bar at the top: menus, and the search for everything.

use crate::app::Lab;
use crate::state::{COLOR, Layout, PICTURES, PaneState};
use crate::{MOST_PANES, link};
use eframe::egui;
use umbrage::{Family, TechniqueInfo};
use umbrage_core::scenes;
use umbrage_report::{RAY_TRACED, RAY_TRACED_SUMMARY};

pub(super) fn show(lab: &mut Lab, ui: &mut egui::Ui) {
    egui::MenuBar::new().ui(ui, |ui| {
        ui.menu_button("Scene", |ui| scene_menu(lab, ui));
        ui.menu_button("Technique", |ui| technique_menu(lab, ui));
        ui.menu_button("Picture", |ui| picture_menu(lab, ui));
        ui.menu_button("Panes", |ui| pane_menu(lab, ui));
        ui.menu_button("Edit", |ui| edit_menu(lab, ui));
        ui.menu_button("Keep", |ui| keep_menu(lab, ui));
        if ui.button("Find…").on_hover_text("Everything by name: techniques, scenes, settings (Ctrl+F)").clicked() {
            lab.face.search.get_or_insert_default();
        }
        if ui.button("Keys").on_hover_text("What keys and mouse do (?)").clicked() {
            lab.face.shows_help = !lab.face.shows_help;
        }
    });
}

fn scene_menu(lab: &mut Lab, ui: &mut egui::Ui) {
    for entry in scenes::SCENES {
        let is_open = lab.state.scene == entry.id;
        let button = ui.selectable_label(is_open, entry.id).on_hover_text(format!("{}. {}", entry.title, entry.about));
        if button.clicked() {
            lab.open(entry.id);
            ui.close();
        }
    }
    ui.separator();
    ui.weak("Files: drop one on the window\n(.scene.toml, .gltf, .glb, .obj)");
}

/// The name of a family as a heading.
fn heading(family: Family) -> &'static str {
    match family {
        Family::Control => "To compare with",
        Family::DepthMaps => "Depth maps",
        Family::MomentMaps => "Filtered moments",
        Family::FittedMaps => "Splits and warps",
        Family::Projected => "Projected on planes",
        Family::Volumes => "Shadow volumes",
        Family::AreaLights => "Area lights",
        _ => "Others",
    }
}

/// All techniques in groups; the one that is clicked goes into the active pane.
pub(super) fn technique_menu(lab: &mut Lab, ui: &mut egui::Ui) {
    let pane = lab.state.panes[lab.face.active].clone();
    let kind = lab.state.main_light().map(|light| light.shape.kind());
    let mut chosen = None;
    if ui.selectable_label(pane.technique == RAY_TRACED, RAY_TRACED).on_hover_text(RAY_TRACED_SUMMARY).clicked() {
        chosen = Some(RAY_TRACED);
    }
    let mut family = None;
    let techniques: Vec<&'static TechniqueInfo> = lab.registry.techniques().to_vec();
    for info in techniques {
        if family.replace(info.family) != Some(info.family) {
            ui.separator();
            ui.weak(heading(info.family));
        }
        let can = kind.is_none_or(|kind| info.supports(kind).is_ok());
        let label = ui.add_enabled(can, egui::Button::selectable(pane.id() == info.id, info.id));
        let label = label.on_hover_text(info.summary);
        if label.on_disabled_hover_text("It can't do this kind of light").clicked() {
            chosen = Some(info.id);
        }
    }
    if let Some(id) = chosen {
        choose_technique(lab, id);
        ui.close();
    }
}

/// Gives the active pane another technique; its picture stays where the technique has it.
pub(super) fn choose_technique(lab: &mut Lab, id: &str) {
    let views = lab.registry.find(id).map_or(&[] as &[&str], |info| info.views);
    let pane = &mut lab.state.panes[lab.face.active];
    if !PICTURES.iter().any(|(name, _)| *name == pane.picture) && !views.contains(&pane.picture.as_str()) {
        pane.picture = COLOR.into();
    }
    pane.technique = id.into();
    lab.pace.forget();
}

fn picture_menu(lab: &mut Lab, ui: &mut egui::Ui) {
    let pane = lab.state.panes[lab.face.active].clone();
    let views = lab.registry.find(pane.id()).map_or(&[] as &[&str], |info| info.views);
    let mut chosen = None;
    for (name, about) in PICTURES {
        if ui.selectable_label(pane.picture == name, name).on_hover_text(about).clicked() {
            chosen = Some(name);
        }
    }
    if !views.is_empty() {
        ui.separator();
        ui.weak(format!("Inside of {}", pane.id()));
    }
    for view in views {
        if ui.selectable_label(pane.picture == *view, *view).clicked() {
            chosen = Some(view);
        }
    }
    if let Some(name) = chosen {
        lab.state.panes[lab.face.active].picture = name.into();
        ui.close();
    }
}

fn pane_menu(lab: &mut Lab, ui: &mut egui::Ui) {
    let count = lab.state.panes.len();
    if ui.add_enabled(count < MOST_PANES, egui::Button::new("Add a pane")).clicked() {
        add_pane(lab);
    }
    if ui.add_enabled(count > 1, egui::Button::new("Remove this pane")).clicked() {
        lab.state.panes.remove(lab.face.active);
    }
    if ui.button("Compare with the truth").on_hover_text("Technique, truth and error side by side (T)").clicked() {
        compare_with_truth(lab);
        ui.close();
    }
    ui.separator();
    for (layout, name) in Layout::ALL {
        if ui.add_enabled(count > 1, egui::Button::selectable(lab.state.layout == layout, name)).clicked() {
            lab.state.layout = layout;
        }
    }
    ui.separator();
    let mut watches = lab.state.observer.is_some();
    let text = "Freezes the camera that techniques work for, and looks on with another one";
    if ui.checkbox(&mut watches, "Observer").on_hover_text(text).changed() {
        lab.state.observer = watches.then(|| lab.state.camera.clone());
    }
    let text = "All that is known of the pixel under the cursor, and the light as it sees it (P)";
    ui.checkbox(&mut lab.face.see.has_loupe, "Loupe").on_hover_text(text);
    ui.checkbox(&mut lab.face.traces, "Trace the truth").on_hover_text("On idle cores, in the background");
    ui.checkbox(&mut lab.face.draws_always, "Draw all the time").on_hover_text("To time frames while nothing moves");
}

/// Another pane like the active one; of the truth where it is the second.
pub(super) fn add_pane(lab: &mut Lab) {
    let mut pane = lab.state.panes[lab.face.active].clone();
    if lab.state.panes.len() == 1 && pane.technique != RAY_TRACED {
        pane.technique = RAY_TRACED.into();
        if !PICTURES.iter().any(|(name, _)| *name == pane.picture) {
            pane.picture = COLOR.into();
        }
    }
    lab.state.panes.push(pane);
    lab.pace.forget();
}

/// The active technique, the truth, and the error between them.
pub(super) fn compare_with_truth(lab: &mut Lab) {
    let technique = lab.state.panes[lab.face.active].technique.clone();
    let pane = |technique: &str, picture: &str| PaneState { technique: technique.into(), picture: picture.into() };
    lab.state.panes = vec![pane(&technique, COLOR), pane(RAY_TRACED, COLOR), pane(&technique, crate::state::ERROR)];
    lab.state.layout = Layout::Grid;
    lab.face.active = 0;
    lab.pace.forget();
}

fn edit_menu(lab: &mut Lab, ui: &mut egui::Ui) {
    if ui.add_enabled(lab.undo.can_go_back(), egui::Button::new("Undo").shortcut_text("Ctrl+Z")).clicked() {
        undo(lab);
    }
    if ui.add_enabled(lab.undo.can_go_forward(), egui::Button::new("Redo").shortcut_text("Ctrl+Y")).clicked() {
        redo(lab);
    }
    if ui.button("All as the scene has it").on_hover_text("Camera, lights and time").clicked() {
        back_to_scene(lab);
    }
}

pub(super) fn undo(lab: &mut Lab) {
    if let Some(state) = lab.undo.back() {
        lab.state = state;
    }
}

pub(super) fn redo(lab: &mut Lab) {
    if let Some(state) = lab.undo.forward() {
        lab.state = state;
    }
}

fn back_to_scene(lab: &mut Lab) {
    if let Some(stage) = &lab.stage {
        let scene = &stage.source.scene;
        lab.state.camera = scene.camera.clone();
        lab.state.lights.clone_from(&scene.lights);
        lab.state.observer = None;
        (lab.state.time_s, lab.state.frame) = (0.0, 0);
    }
}

fn keep_menu(lab: &mut Lab, ui: &mut egui::Ui) {
    let mut copied = None;
    let Some(stage) = &lab.stage else {
        ui.weak("No scene is open");
        return;
    };
    let (state, scene) = (&lab.state, &stage.source.scene);
    let pane = &state.panes[lab.face.active];
    if ui.button("Copy permalink").on_hover_text("All that is seen, for `umbrage view --state`").clicked() {
        copied = Some(link::write(state, scene));
    }
    if ui.button("Copy as command").on_hover_text("`umbrage render` with the same picture, to the byte").clicked() {
        copied = lab.command(lab.face.active);
    }
    if let Some(line) = link::rust(pane)
        && ui.button("Copy as Rust").on_hover_text("The line of a program that makes this technique").clicked()
    {
        copied = Some(line);
    }
    ui.separator();
    #[cfg(not(target_family = "wasm"))]
    for (kind, name, about) in [
        (crate::keep::Kind::Png, "Snapshot as PNG", "The file that the copied command writes"),
        (crate::keep::Kind::Exr, "Snapshot as EXR", "The numbers as they are"),
        (crate::keep::Kind::Bundle, "Bundle for a bug report", "Permalink, commands, adapter, scene file and pictures"),
    ] {
        if ui.button(name).on_hover_text(about).clicked() {
            lab.face.keep = Some(kind);
            ui.close();
        }
    }
    if let Some(text) = copied {
        ui.ctx().copy_text(text.clone());
        lab.face.copied = Some(text);
        lab.face.say("Copied".into());
        ui.close();
    }
}

/// One thing that the search finds.
enum Found {
    Technique(&'static str),
    Scene(&'static str),
    Picture(&'static str),
    Setting(&'static str),
    /// A permalink that was pasted.
    Link,
}

/// The window of the search, where it is open.
pub(super) fn search(lab: &mut Lab, context: &egui::Context) {
    let Some(mut text) = lab.face.search.clone() else { return };
    let (mut is_open, mut chosen) = (true, None);
    egui::Window::new("Find").open(&mut is_open).collapsible(false).show(context, |ui| {
        let hint = "technique, scene, picture, setting, or a permalink";
        let field = ui.add(egui::TextEdit::singleline(&mut text).hint_text(hint));
        // The first that is found is what Return chooses.
        let mut is_chosen = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        field.request_focus();
        for (found, name, about) in finds(lab, &text).into_iter().take(12) {
            let is_clicked = ui.selectable_label(false, name).on_hover_text(about).clicked();
            if is_clicked || std::mem::take(&mut is_chosen) {
                chosen = Some(found);
            }
        }
    });
    let link = text.clone();
    lab.face.search = (is_open && chosen.is_none()).then_some(text);
    match chosen {
        Some(Found::Technique(id)) => choose_technique(lab, id),
        Some(Found::Scene(id)) => lab.open(id),
        Some(Found::Picture(name)) => lab.state.panes[lab.face.active].picture = name.into(),
        Some(Found::Link) => {
            if let Err(error) = lab.follow(&link) {
                lab.face.say(error);
            }
        }
        Some(Found::Setting(name)) => lab.face.say(format!("`{name}` is at the left")),
        None => {}
    }
}

fn finds(lab: &Lab, text: &str) -> Vec<(Found, String, String)> {
    if link::read(text).is_ok() {
        return vec![(Found::Link, "Open this permalink".into(), "Scene, camera, lights, panes".into())];
    }
    let text = text.trim().to_lowercase();
    let mut found = Vec::new();
    let mut add = |what, name: &str, kind: &str, about: &str| {
        if format!("{name} {about}").to_lowercase().contains(&text) {
            found.push((what, format!("{name}  ({kind})"), about.to_string()));
        }
    };
    lab.registry.techniques().iter().for_each(|t| add(Found::Technique(t.id), t.id, "technique", t.summary));
    scenes::SCENES.iter().for_each(|s| add(Found::Scene(s.id), s.id, "scene", s.about));
    PICTURES.iter().for_each(|(name, about)| add(Found::Picture(name), name, "picture", about));
    if let Ok(info) = lab.registry.find(lab.state.panes[lab.face.active].id()) {
        info.views.iter().for_each(|view| add(Found::Picture(view), view, "picture", info.title));
        info.params().iter().for_each(|p| add(Found::Setting(p.name), p.name, "setting", p.help));
    }
    // What is called so comes before what is only told of with the word.
    found.sort_by_key(|(_, name, _)| !name.to_lowercase().contains(&text));
    found
}

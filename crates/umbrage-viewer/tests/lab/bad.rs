//! What goes wrong is said in the window, which stays in use.

use crate::common::{open, until};
use eframe::egui::{DroppedFile, Key, Modifiers, Vec2};
use egui_kittest::Harness;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use umbrage_viewer::{Lab, Options};

fn lab() -> Harness<'static, Lab> {
    let mut lab = open([820.0, 420.0], Options { scene: Some("contact:0.05".into()), ..Options::default() });
    lab.state_mut().set_divisor(Some(4));
    lab.run_steps(2);
    lab
}

/// Waits for a message with these words, and that there are pictures all the same.
fn says(lab: &mut Harness<'static, Lab>, words: &str) {
    until(lab, words, |lab| lab.messages().iter().any(|message| message.contains(words)));
    until(lab, "the pictures", Lab::is_shown);
    assert_eq!(lab.state().error(0), None);
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|e| e.to_string())
    }
}

fn drop_file(lab: &mut Harness<'static, Lab>, path: &Path) {
    lab.input_mut().dropped_files.push(Arc::new(Dropped(path.into())));
    lab.step();
}

#[test]
fn files_that_are_no_scenes_are_named_and_the_scene_stays() {
    let mut lab = lab();
    lab.state_mut().open("missing/nowhere.glb");
    says(&mut lab, "nowhere.glb");
    drop_file(&mut lab, Path::new("holiday.mp4"));
    says(&mut lab, "holiday.mp4: not a scene");
    let folder = tempfile::tempdir().unwrap();
    let broken = folder.path().join("broken.obj");
    std::fs::write(&broken, "v 1 2\nf 1 2 3\n").unwrap();
    drop_file(&mut lab, &broken);
    says(&mut lab, "broken.obj");
    assert_eq!(lab.state().state().scene, "contact:0.05");
}

#[test]
fn a_dropped_model_is_opened() {
    let mut lab = lab();
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("triangle.obj");
    std::fs::write(&model, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    drop_file(&mut lab, &model);
    until(&mut lab, "the model", |lab| lab.state().scene.ends_with("triangle.obj") && lab.is_shown());
    assert_eq!(lab.state().error(0), None);
}

#[test]
fn windows_of_one_pixel_and_none_come_back() {
    let mut lab = lab();
    for size in [[1.0, 1.0], [0.0, 0.0], [820.0, 2.0], [3.0, 420.0], [820.0, 420.0]] {
        lab.set_size(Vec2::from(size));
        lab.run_steps(4);
    }
    until(&mut lab, "the pictures", Lab::is_shown);
    assert_eq!((lab.state().error(0), lab.state().messages()), (None, Vec::new()));
}

#[test]
fn permalinks_that_lead_nowhere_say_why() {
    let mut lab = lab();
    for (link, says) in [("1.", "no permalink"), ("7.abc", "version 7"), ("hello", "no permalink")] {
        let error = lab.state_mut().follow(link).unwrap_err();
        assert!(error.contains(says), "{link}: {error}");
    }
    let link = lab.state().permalink().unwrap();
    lab.key_press(Key::V);
    lab.run_steps(2);
    lab.key_press_modifiers(Modifiers::COMMAND, Key::F);
    lab.run_steps(2);
    lab.event(eframe::egui::Event::Text(link.clone()));
    lab.run_steps(2);
    lab.key_press(Key::Enter);
    lab.run_steps(3);
    assert_eq!(lab.state().permalink(), Some(link));
}

#[test]
fn a_technique_that_is_not_there_is_named_on_its_pane() {
    let mut lab = lab();
    lab.state_mut().set_technique(0, "shadow-mup");
    lab.run_steps(3);
    let error = lab.state().error(0).unwrap_or_default().to_string();
    assert!(error.contains("did you mean `shadow-map`"), "{error}");
    lab.state_mut().set_technique(0, "shadow-map:size=7000000");
    lab.run_steps(3);
    assert!(lab.state().error(0).unwrap_or_default().contains("size"));
    lab.state_mut().set_technique(0, "shadow-map");
    until(&mut lab, "the pictures", Lab::is_shown);
    assert_eq!(lab.state().error(0), None);
}

#[test]
fn a_lost_device_is_noticed_and_what_was_seen_is_kept() {
    let mut lab = lab();
    let link = lab.state().permalink();
    lab.state().gpu().device.destroy();
    for _ in 0..20 {
        lab.key_press(Key::Space);
        lab.step();
    }
    assert!(lab.state().is_lost());
    assert!(link.is_some() && lab.state().permalink().is_some());
}

#[test]
fn pictures_are_coarse_while_hands_move_where_the_adapter_is_slow() {
    let mut lab = open([1500.0, 900.0], Options { techniques: vec!["pcss".into()], ..Options::default() });
    let fine = lab.state().picture_size();
    lab.key_press(Key::Enter);
    for _ in 0..60 {
        lab.step();
    }
    let moving = lab.state().picture_size();
    lab.key_press(Key::Enter);
    lab.step();
    let time: f64 = lab.state().frame_ms();
    // An adapter that is fast enough stays fine.
    assert!(moving.0 <= fine.0 && (moving.0 < fine.0 || time < 45.0), "{fine:?} {moving:?} {time}");
    until(&mut lab, "a fine picture", |lab| lab.picture_size().0 > moving.0 || moving == fine);
}

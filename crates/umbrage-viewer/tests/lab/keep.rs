//! What is kept: snapshots, permalinks, commands, bundles.

use crate::common::{open, until};
use eframe::egui::{Key, Modifiers, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::{Path, PathBuf};
use umbrage_viewer::{Lab, Options};

fn lab(folder: &Path, techniques: &[&str]) -> Harness<'static, Lab> {
    let techniques = techniques.iter().map(|t| t.to_string()).collect();
    let (scene, folder) = (Some("contact:0.1".into()), Some(folder.to_path_buf()));
    let mut lab = open([820.0, 420.0], Options { scene, techniques, folder, ..Options::default() });
    lab.state_mut().set_divisor(Some(4));
    lab.run_steps(3);
    lab
}

/// The file that a snapshot writes.
fn snapshot(lab: &mut Harness<'static, Lab>) -> PathBuf {
    lab.key_press_modifiers(Modifiers::COMMAND, Key::S);
    lab.step();
    until(lab, "the snapshot", |lab| !lab.messages().is_empty());
    let message = lab.state().messages().remove(0);
    PathBuf::from(message.strip_prefix("written: ").unwrap_or_else(|| panic!("{message}")))
}

#[test]
fn a_snapshot_is_what_is_seen_and_what_the_copied_command_writes() {
    let folder = tempfile::tempdir().unwrap();
    let registry = umbrage::Registry::default();
    for info in registry.techniques() {
        let mut lab = lab(folder.path(), &[info.id]);
        // Not as the scene has it.
        let middle = lab.get_by_label("pane 0").rect().center();
        lab.drag_at(middle);
        lab.hover_at(middle + eframe::egui::vec2(30.0, 10.0));
        lab.step();
        lab.drop_at(middle + eframe::egui::vec2(30.0, 10.0));
        lab.run_steps(4);
        if let Some(error) = lab.state().error(0) {
            assert!(error.contains("lights"), "{}: {error}", info.id);
            continue;
        }
        let file = snapshot(&mut lab);
        let seen = lab.state().picture(0).unwrap();
        let kept = image::open(&file).unwrap().into_rgba8();
        assert_eq!((kept.width(), kept.height()), seen.size());
        let differ = kept.pixels().zip(&seen.data).filter(|(a, b)| a.0 != **b).count();
        assert_eq!(differ, 0, "{}: pixels that differ from what is seen", info.id);
        let command = lab.state().command(0).unwrap();
        let again = folder.path().join("again.png");
        run(&command, &again);
        assert_eq!(std::fs::read(&file).unwrap(), std::fs::read(&again).unwrap(), "{command}");
    }
}

/// Runs a copied command, but for the name of its file.
fn run(command: &str, output: &Path) {
    let words = shell_words(command);
    let place = words.iter().position(|word| word == "-o").unwrap();
    let line: Vec<_> = words[..place].iter().map(Into::into).chain(["-o".into(), output.into()]).collect();
    let code = umbrage_cli::run(&umbrage::Registry::default(), line);
    assert_eq!(format!("{code:?}"), format!("{:?}", std::process::ExitCode::SUCCESS), "{command}");
}

/// Words as a shell reads them, with single quotes alone.
fn shell_words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut is_quoted) = (Vec::new(), String::new(), false);
    for c in line.chars() {
        match c {
            '\'' => is_quoted = !is_quoted,
            ' ' if !is_quoted => words.push(std::mem::take(&mut word)),
            _ => word.push(c),
        }
    }
    words.push(word);
    words
}

#[test]
fn a_permalink_leads_back_to_what_was_seen() {
    let folder = tempfile::tempdir().unwrap();
    let mut lab = lab(folder.path(), &["pcf:kernel=7", "ray-traced"]);
    lab.key_press(Key::L);
    lab.key_press(Key::B);
    lab.run_steps(3);
    let link = lab.state().permalink().unwrap();
    let state = lab.state().state().clone();
    assert!(state.light == Some(1) && state.layout == umbrage_viewer::Layout::Blink);
    let again = open([820.0, 420.0], Options { state: Some(link), ..Options::default() });
    assert_eq!(*again.state().state(), state);
}

#[test]
fn undo_leads_back_through_what_hands_did() {
    let folder = tempfile::tempdir().unwrap();
    let mut lab = lab(folder.path(), &["pcf"]);
    let before = lab.state().state().clone();
    lab.key_press(Key::V);
    lab.run_steps(2);
    assert_ne!(*lab.state().state(), before);
    lab.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    lab.run_steps(2);
    assert_eq!(*lab.state().state(), before);
    lab.key_press_modifiers(Modifiers::COMMAND, Key::Y);
    lab.run_steps(2);
    assert_eq!(lab.state().state().panes[0].picture, "visibility");
}

#[test]
fn a_bundle_holds_all_that_somebody_else_needs() {
    let folder = tempfile::tempdir().unwrap();
    let mut lab = lab(folder.path(), &["pcf", "ray-traced"]);
    lab.get_by_role_and_label(Role::Button, "Keep").click();
    lab.run_steps(2);
    lab.get_by_role_and_label(Role::Button, "Bundle for a bug report").click();
    lab.step();
    until(&mut lab, "the bundle", |lab| !lab.messages().is_empty());
    let file = std::fs::File::open(folder.path().join("umbrage-bundle.zip")).unwrap();
    let mut bundle = zip::ZipArchive::new(file).unwrap();
    let names: Vec<String> = bundle.file_names().map(|name| name.unwrap().into_owned()).collect();
    for name in ["permalink.txt", "commands.txt", "about.txt", "0-pcf-color.png", "1-ray-traced-color.png"] {
        assert!(names.iter().any(|known| known == name), "{name} is not in {names:?}");
    }
    let link = std::io::read_to_string(bundle.by_name("permalink.txt").unwrap()).unwrap();
    assert_eq!(Some(link), lab.state().permalink());
}

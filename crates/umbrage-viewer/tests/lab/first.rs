//! The first picture.

use crate::common::{open, until};
use eframe::egui::Key;
use umbrage_viewer::Options;

#[test]
fn the_laboratory_opens_with_a_picture_and_its_truth() {
    let mut lab = open([1200.0, 760.0], Options { scene: Some("contact:0.2".into()), ..Options::default() });
    until(&mut lab, "the truth", |lab| lab.truth_samples() > 0);
    until(&mut lab, "a score", |lab| lab.mae(0).is_some());
    assert!(lab.state().mae(0).unwrap() < 0.1);
}

/// The picture in the documentation; `cargo xtask docs --pictures` has it written.
#[test]
fn technique_truth_and_error_are_seen_side_by_side() {
    let size = if std::env::var_os("UMBRAGE_WRITE_DOCS").is_some() { [1280.0, 800.0] } else { [760.0, 480.0] };
    let mut lab = open(size, Options { techniques: vec!["pcss".into()], ..Options::default() });
    lab.key_press(Key::L);
    lab.key_press(Key::T);
    until(&mut lab, "three pictures", |lab| lab.state().panes.len() == 3 && lab.is_shown());
    until(&mut lab, "a sharp truth", |lab| lab.truth_samples() >= 32);
    until(&mut lab, "a score of it", |lab| lab.mae(0).is_some_and(|mae| mae < 0.02));
    if std::env::var_os("UMBRAGE_WRITE_DOCS").is_some() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/pictures/laboratory.png");
        lab.render().unwrap().save(file).unwrap();
    }
}

//! The loupe, the observer, and what is drawn over pictures.

use crate::common::{open, until};
use eframe::egui::{Event, Key, Pos2, pos2};
use egui_kittest::Harness;
use umbrage_viewer::{Lab, Options};

/// Points of the window.
const SIZE: [f32; 2] = [1200.0, 700.0];

fn of(scene: &str, technique: &str) -> Harness<'static, Lab> {
    open(SIZE, Options { scene: Some(scene.into()), techniques: vec![technique.into()], ..Options::default() })
}

fn point_at(lab: &mut Harness<'static, Lab>, at: Pos2) {
    lab.event(Event::PointerMoved(at));
    lab.step();
}

/// Saves the window where somebody wants to look at it.
fn keep(lab: &mut Harness<'static, Lab>, name: &str) {
    if let Ok(folder) = std::env::var("UMBRAGE_LAB_PICTURES") {
        lab.render().unwrap().save(std::path::Path::new(&folder).join(format!("{name}.png"))).unwrap();
    }
}

#[test]
fn the_loupe_knows_what_is_under_the_cursor() {
    let mut lab = of("contact:0.2", "pcf");
    assert_eq!(lab.state().loupe(), None);
    lab.key_press(Key::P);
    lab.key_press(Key::L);
    until(&mut lab, "the second light", |lab| lab.state().light == Some(1) && lab.truth_samples() > 0);
    let mut partly = 0;
    for (x, y) in [(345.0, 330.0), (500.0, 400.0), (560.0, 500.0), (600.0, 505.0), (640.0, 540.0)] {
        let before = lab.state().loupe();
        point_at(&mut lab, pos2(x, y));
        until(&mut lab, "the loupe", |lab| lab.loupe().is_some() && lab.loupe() != before);
        let reading = lab.state().loupe().unwrap();
        assert!((reading.lit - reading.visibility).abs() < 0.05, "{reading:?}");
        assert!(reading.bias_mm.is_some_and(|bias| bias > 0.0 && bias < 1e3), "{reading:?}");
        partly += u32::from(reading.visibility > 0.0 && reading.visibility < 1.0);
        keep(&mut lab, &format!("loupe-{x}"));
    }
    assert!(partly > 0);
}

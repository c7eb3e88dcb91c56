//! The loupe, the observer, and what is drawn over pictures.

use crate::common::{open, until};
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Role, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
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

fn press(lab: &mut Harness<'static, Lab>, key: Key) {
    lab.key_press(key);
    lab.step();
}

fn click(lab: &mut Harness<'static, Lab>, at: Pos2) {
    point_at(lab, at);
    button(lab, at, true);
    button(lab, at, false);
    lab.run_steps(2);
}

fn button(lab: &mut Harness<'static, Lab>, pos: Pos2, pressed: bool) {
    lab.event(Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE });
    lab.step();
}

#[test]
fn an_observer_sees_the_frozen_camera_and_what_was_found_for_it() {
    let mut lab = of("contact:0.2", "pcf");
    press(&mut lab, Key::O);
    // From the side.
    let at = pos2(700.0, 150.0);
    point_at(&mut lab, at);
    button(&mut lab, at, true);
    for i in 1..=5 {
        point_at(&mut lab, at + vec2(40.0, 10.0) * i as f32);
    }
    button(&mut lab, at + vec2(200.0, 50.0), false);
    until(&mut lab, "lines", |lab| lab.line_count(0) > 12);
    lab.run_steps(3);
    keep(&mut lab, "observer");
    let state = lab.state().state();
    let (observer, camera) = (state.observer.clone().unwrap(), state.camera.clone());
    assert!(observer.eye.distance(camera.eye) > 1.0, "{observer:?}");
    assert_eq!(lab.state().error(0), None);
    keep(&mut lab, "observer");
    // Each kind of line can be had.
    for name in ["silhouettes", "shadow volumes"] {
        let before = lab.state().line_count(0);
        lab.get_by_label(name).click();
        until(&mut lab, name, |lab| lab.line_count(0) > before);
    }
    keep(&mut lab, "observer-volumes");
    press(&mut lab, Key::V);
    assert_eq!(lab.state().error(0), None);
    keep(&mut lab, "observer-visibility");
    press(&mut lab, Key::O);
    until(&mut lab, "the camera's picture", |lab| lab.state().observer.is_none() && lab.mae(0).is_some());
}

#[test]
fn a_click_marks_a_point_in_the_scene_and_in_the_map() {
    let techniques = vec!["pcf".into(), "pcf".into()];
    let mut lab = open(SIZE, Options { scene: Some("contact:0.2".into()), techniques, ..Options::default() });
    until(&mut lab, "rays", |lab| lab.truth_samples() > 0);
    // The right one shows the map.
    click(&mut lab, pos2(800.0, 400.0));
    for name in ["Picture", "map-0"] {
        lab.get_by_role_and_label(Role::Button, name).click();
        lab.run_steps(2);
    }
    let before = lab.state().mark();
    click(&mut lab, pos2(430.0, 500.0));
    assert_ne!(lab.state().mark(), before);
    let mark = lab.state().mark().expect("the floor");
    assert!(mark.y.abs() < 1e-6, "{mark}");
    until(&mut lab, "the stretched map", |lab| lab.extremes(1).is_some());
    lab.run_steps(3);
    let window = lab.render().unwrap();
    let in_map = (660..980).flat_map(|x| (190..510).map(move |y| (x, y)));
    let bright = in_map.filter(|(x, y)| window.get_pixel(*x, *y).0[0] > 60).count();
    assert!(bright > 5000, "{bright} bright pixels in the map");
    keep(&mut lab, "mark");
    // The cross in the map is where the point's texel is: a click there finds the point again.
    let at = lab.state().mark_on(1).expect("in the map");
    click(&mut lab, pos2(at[0], at[1]));
    let again = lab.state().mark().expect("what the texel sees");
    assert!(again.distance(mark) < 0.2, "{again} instead of {mark}");
    keep(&mut lab, "mark-again");
    press(&mut lab, Key::Escape);
    assert_eq!(lab.state().mark(), None);
}

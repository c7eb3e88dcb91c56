//! What hands do: the light's handles, what moves, what is broken on purpose, what is read.

use crate::common::{open, until};
use eframe::egui::{Key, Modifiers, Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use umbrage_core::{Image, Light, LightShape};
use umbrage_report::{Aov, CameraPath, Choice, Method, Moving, PERIOD, Picture, Shot, Silent, Source};
use umbrage_viewer::{Lab, Options};

const SIZE: [f32; 2] = [1000.0, 640.0];

fn of(scene: &str) -> Options {
    Options { scene: Some(scene.into()), ..Options::default() }
}

/// Drags from one place of the screen to another.
fn drag(lab: &mut Harness<'static, Lab>, from: Pos2, by: Vec2) {
    lab.hover_at(from);
    lab.step();
    lab.drag_at(from);
    lab.step();
    for part in [0.5, 1.0] {
        lab.hover_at(from + by * part);
        lab.step();
    }
    lab.drop_at(from + by);
    lab.step();
}

fn light(lab: &Harness<'static, Lab>) -> Light {
    let state = lab.state().state();
    state.lights[state.light.unwrap_or_default()].clone()
}

fn place(lab: &Harness<'static, Lab>, handle: &str) -> Pos2 {
    lab.get_by_label(handle).rect().center()
}

#[test]
fn handles_move_and_size_the_light_and_undo_takes_one_step_back() {
    let mut lab = open(SIZE, of("lantern:0.3"));
    lab.key_press(Key::L);
    lab.step();
    let before = light(&lab);
    assert!(lab.query_by_label("light: move y").is_none());
    lab.key_press(Key::G);
    lab.run_steps(2);
    if let Ok(file) = std::env::var("UMBRAGE_LAB_PICTURE") {
        lab.key_press_modifiers(Modifiers::SHIFT, Key::G);
        lab.run_steps(3);
        lab.render().unwrap().save(file).unwrap();
    }
    let at = place(&lab, "light: move y");
    drag(&mut lab, at, Vec2::new(0.0, -40.0));
    let LightShape::Sphere { position, radius } = light(&lab).shape else { panic!("another kind") };
    let LightShape::Sphere { position: old, radius: old_radius } = before.shape else { panic!("another kind") };
    assert!(position.y > old.y + 0.05, "{position} from {old}");
    assert_eq!((position.x, position.z, radius), (old.x, old.z, old_radius));
    let now = place(&lab, "light: move y");
    assert!((now - at - Vec2::new(0.0, -40.0)).length() < 4.0, "{now:?} from {at:?}");

    let at = place(&lab, "light: size 0");
    drag(&mut lab, at, Vec2::new(30.0, 0.0));
    let LightShape::Sphere { radius, .. } = light(&lab).shape else { panic!("another kind") };
    assert!(radius > old_radius * 1.05, "{radius} from {old_radius}");
    lab.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    lab.step();
    lab.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    lab.step();
    assert_eq!(light(&lab), before);
}

/// Sun and time of day: the same handles turn parallel light.
#[test]
fn the_sun_is_turned_by_its_handle() {
    let mut lab = open(SIZE, of("duelling-frusta:0.2"));
    let before = light(&lab);
    lab.key_press(Key::G);
    lab.run_steps(2);
    let at = place(&lab, "light: aim");
    drag(&mut lab, at, Vec2::new(25.0, 10.0));
    let (LightShape::Directional { direction: old, .. }, LightShape::Directional { direction, .. }) =
        (before.shape, light(&lab).shape)
    else {
        panic!("another kind")
    };
    assert!(direction.is_normalized() && direction.angle_between(old) > 0.05, "{direction} from {old}");
    let now = place(&lab, "light: aim");
    // The arm keeps its length, so the handle goes beside the pointer where that leaves the way.
    assert!((now - at).dot(Vec2::new(25.0, 10.0)) > 100.0, "{now:?} from {at:?}");
}

/// What is played changes the picture, and its frame is kept in the state.
#[test]
fn lights_and_casters_play_and_the_truth_follows_when_they_stand() {
    let mut lab = open(SIZE, of("contact:0.2"));
    lab.state_mut().set_divisor(Some(4));
    until(&mut lab, "the truth", |lab| lab.truth_samples() > 0);
    lab.key_press(Key::K);
    until(&mut lab, "a frame", |lab| lab.state().frame > 0);
    assert_eq!(lab.state().state().moving, Moving::Lights);
    lab.key_press(Key::K);
    lab.run_steps(2);
    let frame = lab.state().state().frame;
    lab.key_press(Key::Period);
    lab.run_steps(2);
    assert_eq!(lab.state().state().frame, (frame + 1) % PERIOD);
    lab.key_press(Key::Comma);
    lab.run_steps(2);
    assert_eq!(lab.state().state().frame, frame);
    assert!(light(&lab) == light(&open(SIZE, of("contact:0.2"))), "the light that is edited stays");

    lab.state_mut().set_motion(Moving::Casters, None, 30);
    lab.key_press(Key::K);
    lab.run_steps(3);
    assert_eq!(lab.state().truth_samples(), 0, "no truth of casters that move");
    lab.get_by_label_contains("the truth waits");
    lab.key_press(Key::K);
    until(&mut lab, "the truth about the casters as they stand", |lab| lab.truth_samples() > 0);
    until(&mut lab, "its score", |lab| lab.mae(0).is_some());
    assert!(lab.state().mae(0).unwrap() < 0.1);
}

/// An animation plays by time, and only where there is one.
#[test]
fn animations_play_by_time() {
    let mut lab = open(SIZE, of("tentacles:0.1"));
    lab.state_mut().set_divisor(Some(8));
    lab.key_press(Key::K);
    until(&mut lab, "time", |lab| lab.state().time_s > 0.05);
    assert_eq!((lab.state().state().moving, lab.state().state().frame), (Moving::None, 0));
    lab.key_press(Key::K);
    until(&mut lab, "the truth about it", |lab| lab.truth_samples() > 0);
    let stands = lab.state().state().time_s;
    lab.run_steps(3);
    assert_eq!(lab.state().state().time_s, stands);
}

#[test]
fn a_technique_is_broken_read_about_and_measured() {
    let options = Options { techniques: vec!["pcss-jitter".into()], ..of("contact:0.2") };
    let mut lab = open([1100.0, 1100.0], options);
    lab.state_mut().set_divisor(Some(8));
    lab.get_by_label("Presets").click();
    lab.run_steps(12);
    lab.get_by_label("bias 0").click();
    lab.run_steps(2);
    assert_eq!(lab.state().state().panes[0].technique, "pcss-jitter:bias=0");
    lab.get_by_label("All defaults").click();
    lab.run_steps(2);
    lab.get_by_label("Measure × floor").click();
    until(&mut lab, "the ratios", |lab| lab.times_floor().is_some());
    assert!(lab.state().times_floor().unwrap() > 1.0);
    assert_eq!(lab.get_all_by_label_contains("× floor").count(), 2, "the button and the number");
    lab.get_all_by_label_contains("search=64").next().unwrap().click();
    lab.run_steps(2);
    assert!(lab.state().state().panes[0].technique.contains("search=64"));
    lab.get_by_label("Read").click();
    lab.run_steps(3);
    if let Ok(file) = std::env::var("UMBRAGE_LAB_PICTURE") {
        lab.render().unwrap().save(file.replace(".png", "-read.png")).unwrap();
    }
    lab.get_by_label("3 inside").click();
    lab.run_steps(2);
    let pane = &lab.state().state().panes[0];
    assert_eq!((pane.technique.as_str(), pane.picture.as_str()), ("pcss-jitter", "map-0"));
    lab.key_press(Key::H);
    lab.run_steps(2);
    assert!(lab.query_by_label("3 inside").is_none());
}

/// The picture that `umbrage render` takes of a frame.
fn rendered(moving: Moving, path: Option<CameraPath>, frame: u32, size: (u32, u32)) -> Image<[u8; 4]> {
    let gpu = umbrage::Gpu::request(None).unwrap();
    let shot = Shot {
        source: Source::open("contact:0.2").unwrap().moved(moving, path, frame, size.1),
        lights: vec![0],
        method: Method::Technique(Choice::parse(&umbrage::Registry::default(), "pcf", &[]).unwrap()),
        size,
        aov: Aov::Color,
        overlay: None,
        bake_cache: None,
    };
    let Picture::Color(picture) = shot.take(Some(&gpu), &Silent).unwrap() else { panic!("no colours") };
    picture
}

/// The window dithers its colours, so that they are off by one level at most.
#[test]
fn a_frame_looks_as_the_command_renders_it() {
    let mut lab = open(SIZE, of("contact:0.2"));
    let (moving, path, frame) = (Moving::All, Some(CameraPath::Fly), 21);
    lab.state_mut().set_divisor(Some(1));
    lab.state_mut().set_motion(moving, path, frame);
    lab.run_steps(4);
    let rect = lab.get_by_label("pane 0").rect();
    let size = (rect.width() as u32, rect.height() as u32);
    let seen = lab.render().unwrap();
    let difference = |picture: &Image<[u8; 4]>| {
        // The name of the technique is in the upper corner.
        let pixels = (2..size.0 - 2).flat_map(|x| (60..size.1 - 2).map(move |y| (x, y)));
        let off = pixels.map(|(x, y)| {
            let seen = seen.get_pixel(x + rect.left().round() as u32, y + rect.top().round() as u32);
            seen.0.iter().zip(picture[(x, y)]).map(|(a, b)| u64::from(a.abs_diff(b))).max().unwrap_or_default()
        });
        off.filter(|off| *off > 2).count() as f64 / f64::from(size.0 * size.1)
    };
    let (same, start) =
        (difference(&rendered(moving, path, frame, size)), difference(&rendered(moving, path, 0, size)));
    // Pictures are stretched where a pane's width is no whole number of points, so that edges
    // are off by a pixel.
    assert!(same < 0.03 && start > 10.0 * same.max(0.001), "{same} of the frame, {start} of another are off");
}

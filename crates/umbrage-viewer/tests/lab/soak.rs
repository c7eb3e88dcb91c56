//! Whatever is switched how often, memory stays level. `cargo xtask soak` has it run for longer.

use crate::common::{open, until};
use eframe::egui::{Key, Vec2};
use egui_kittest::Harness;
use std::time::{Duration, Instant};
use umbrage_viewer::{Lab, Options};

/// GPU objects that are alive: buffers, textures, their views, bind groups.
fn objects(lab: &Harness<'static, Lab>) -> [isize; 4] {
    let gpu = lab.state().gpu();
    gpu.wait().unwrap();
    let hal = gpu.device.get_internal_counters().hal;
    [hal.buffers.read(), hal.textures.read(), hal.texture_views.read(), hal.bind_groups.read()]
}

/// Every technique in turn, with pictures, sizes, panes and lights that change.
fn round(lab: &mut Harness<'static, Lab>, techniques: usize) {
    for step in 0..techniques {
        lab.key_press(if step % 3 == 0 { Key::V } else { Key::L });
        lab.key_press(Key::Space);
        lab.set_size(Vec2::new(700.0 + 40.0 * (step % 2) as f32, 420.0));
        lab.run_steps(2);
    }
    // All as in the beginning.
    lab.set_size(Vec2::new(700.0, 420.0));
    lab.state_mut().set_technique(0, "none");
    lab.state_mut().set_picture(0, "color");
    until(lab, "the pictures", Lab::is_shown);
    lab.run_steps(4);
}

#[test]
fn memory_stays_level_whatever_is_switched() {
    let minutes: f64 = std::env::var("UMBRAGE_SOAK_MINUTES").ok().and_then(|text| text.parse().ok()).unwrap_or(0.0);
    let techniques = umbrage::techniques().len();
    let mut lab = open([700.0, 420.0], Options { scene: Some("contact:0.05".into()), ..Options::default() });
    lab.state_mut().set_divisor(Some(4));
    // What is shared for good is made in the first round.
    round(&mut lab, techniques);
    let (first, start, mut rounds) = (objects(&lab), Instant::now(), 0);
    while rounds < 2 || start.elapsed() < Duration::from_secs_f64(minutes * 60.0) {
        round(&mut lab, techniques);
        rounds += 1;
    }
    let last = objects(&lab);
    println!("{rounds} rounds of {techniques} techniques: {first:?} objects, then {last:?}");
    let most = first.map(|count| count + 4);
    assert!(last.iter().zip(&most).all(|(last, most)| last <= most), "{first:?} objects became {last:?}");
}

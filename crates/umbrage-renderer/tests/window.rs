//! The example with a window, as it draws where there is none.

#[path = "../examples/window/show.rs"]
mod show;

use show::{TECHNIQUES, without_window};

#[test]
fn every_key_draws_a_picture_and_shadows_make_it_darker() {
    let drawn = without_window(TECHNIQUES.len() as u32, (96, 72)).unwrap();
    assert_eq!(drawn.iter().map(|(technique, _)| *technique).collect::<Vec<_>>(), TECHNIQUES);
    let (_, without) = drawn[TECHNIQUES.len() - 1];
    for (technique, brightness) in &drawn[..TECHNIQUES.len() - 1] {
        assert!(*brightness > 0.05 && *brightness < without - 0.005, "{technique}: {brightness:.3} of {without:.3}");
    }
}

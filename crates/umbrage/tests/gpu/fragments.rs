//! What is counted of the passes of a frame.

use crate::common::{gpu, renderer, scene};
use umbrage::{Error, Gpu, Owner, PassFragments, Recorder};

/// Passes of the technique of the light in one frame.
fn passes_of(gpu: &Gpu, id: &str, set: &str, counting: &mut Recorder) -> Vec<PassFragments> {
    let scene = scene("primitives", 1.0);
    let mut renderer = renderer(gpu, &scene, 0, id, set, (64, 48));
    renderer.swap_recorder(counting);
    renderer.frame(&scene.camera).unwrap();
    renderer.wait().unwrap();
    renderer.swap_recorder(counting);
    let passes = counting.fragments();
    passes.into_iter().filter(|pass| pass.owner == Owner::Light(0)).collect()
}

#[test]
fn fragments_and_their_bytes_are_counted() {
    let gpu = gpu();
    let mut counting = match Recorder::counting(&gpu) {
        Ok(recorder) => recorder,
        // The standard asks for no more than whether there are any; then that has to be the error.
        Err(error) => return assert_eq!(error, Error::NotCounted),
    };
    let look_up = PassFragments {
        owner: Owner::Light(0),
        pass: "visibility".into(),
        fragments: 64 * 48,
        // A half float each.
        attachment_bytes: 2 * 64 * 48,
    };
    let small = passes_of(&gpu, "shadow-map", "size=256", &mut counting);
    let large = passes_of(&gpu, "shadow-map", "size=1024", &mut counting);
    assert_eq!(small[1], look_up, "{small:?}");
    assert_eq!(large[1], look_up, "{large:?}");
    let maps = [&small[0], &large[0]];
    assert!(maps.iter().all(|map| map.pass == "map" && map.attachment_bytes == 8 * map.fragments), "{maps:?}");
    let growth = maps[1].fragments as f64 / maps[0].fragments as f64;
    assert!((growth - 16.0).abs() < 0.5, "16 times the texels, {growth:.2} times the fragments");
    let none = passes_of(&gpu, "none", "", &mut counting);
    assert_eq!(none[0].fragments, 0, "a clear draws nothing: {none:?}");
}

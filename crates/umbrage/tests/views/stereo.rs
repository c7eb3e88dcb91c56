//! Two eyes: layers of one depth array and of one array of visibility, one technique for both.

use crate::host::{LAMP, SIZE, Target, Truth, depth_texture, frame, gpu, layer, point, scene, texture};
use umbrage::core::{Camera, LightShape, Scene, glam::DVec3};
use umbrage::{Casters, Gpu, Receivers, View, VisibilityTarget, find};

/// 6.5 cm apart.
fn eyes(scene: &Scene) -> [Camera; 2] {
    let right = scene.camera.axes()[0] * 0.0325;
    [-1.0, 1.0].map(|side| {
        let by: DVec3 = right * side;
        Camera { eye: scene.camera.eye + by, target: scene.camera.target + by, ..scene.camera.clone() }
    })
}

/// The error of each eye, and the draws of each.
fn both(gpu: &Gpu, scene: &Scene, id: &str, set: &[(&str, &str)]) -> [(f64, u32); 2] {
    let set: Vec<_> = set.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
    let mut technique = find(id).unwrap().settings(&set).unwrap().make(gpu).unwrap();
    let mut casters = Casters::new(gpu, scene).unwrap();
    frame(gpu, |passes| casters.record(passes)).unwrap();
    let depths = depth_texture(gpu, SIZE, 1, 2);
    let answers = texture(gpu, VisibilityTarget::FORMAT, SIZE, 1, 2);
    let eyes = eyes(scene);
    let mut eye = |passes: &mut umbrage::Passes<'_>, number: u32| {
        let camera = eyes[number as usize].view(SIZE.0, SIZE.1);
        let depth = layer(&depths, number);
        let receivers = Receivers::new(gpu, &depth, None, SIZE).unwrap();
        let target = VisibilityTarget::of_texture(&answers, number).unwrap();
        Target::of(&depth).draw(gpu, passes.encoder(), scene, &camera);
        let view = View { camera, receivers: &receivers, casters: &casters, light: &scene.lights[0], textures: &[] };
        technique.prepare(gpu, &view).unwrap().record(passes, &target).unwrap();
        (target, technique.inside().stats().draws)
    };
    let seen = frame(gpu, |passes| [eye(passes, 0), eye(passes, 1)]);
    let error = |number: usize| {
        let (target, draws) = &seen[number];
        (Truth::of(scene, &eyes[number], SIZE).error(&target.read(gpu).unwrap()), *draws)
    };
    [error(0), error(1)]
}

#[test]
fn each_eye_has_its_own_shadow() {
    let gpu = gpu();
    let soft = LightShape::Sphere { position: LAMP, radius: 0.4 };
    for (id, shape, most) in [
        ("pcf", point(), 0.003),
        ("cascaded", point(), 0.002),
        ("evsm", point(), 0.005),
        ("pcss", soft.clone(), 0.004),
        ("volume", point(), 0.0005),
        ("wedges", soft.clone(), 0.001),
        ("light-mask", soft, 0.001),
        ("projective", point(), 0.001),
    ] {
        let [left, right] = both(&gpu, &scene(shape), id, &[]);
        println!("{id}: {left:?} {right:?}");
        assert!(left.0 < most && right.0 < most, "{id}: {left:?} {right:?}");
    }
}

/// A map that covers all that the light reaches does not depend on the eye.
#[test]
fn both_eyes_share_the_maps_of_what_the_light_reaches() {
    let gpu = gpu();
    let scene = scene(point());
    let [left, right] = both(&gpu, &scene, "shadow-map", &[("focus", "light"), ("cache", "on"), ("size", "1024")]);
    println!("{left:?} {right:?}");
    assert!(left.0 < 0.003 && right.0 < 0.003, "{left:?} {right:?}");
    assert!(left.1 > 1, "the first eye draws maps: {left:?}");
    assert_eq!(right.1, 1, "the second eye only looks up");
}

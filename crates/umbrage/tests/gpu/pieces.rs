//! Large lights cut into pieces, for what one map of a light can't hold.

use crate::common::{against_truth, gpu, pairs, score_frame};
use umbrage::core::glam::{DAffine3, DQuat, DVec3};
use umbrage::core::{Camera, Light, LightShape, Material, Scene, primitive};
use umbrage::{Error, find, light_pieces};
use umbrage_metrics::Scores;
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (120, 90);

/// Plates over one another under a large lamp: from its centre the upper ones hide parts of those
/// below, which a map does not hold then.
fn plates() -> Scene {
    let mut scene = Scene::default();
    let (plane, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let material = scene.add_material(Material::default());
    scene.place(plane, material, DAffine3::from_scale(DVec3::splat(12.0)));
    for i in 0..4 {
        let step = f64::from(i);
        let size = DVec3::new(1.2 - 0.2 * step, 0.03, 1.2 - 0.2 * step);
        let turn = DQuat::from_rotation_y(0.35 * step);
        let at = DVec3::new(0.12 * step, 0.25 + 0.28 * step, -0.1 * step);
        scene.place(cube, material, DAffine3::from_scale_rotation_translation(size, turn, at));
    }
    let (position, direction) = (DVec3::new(0.3, 2.6, 0.2), DVec3::NEG_Y);
    scene.lights.push(Light::new(LightShape::Disc { position, direction, radius: 1.0 }));
    scene.camera = Camera { eye: DVec3::new(2.2, 1.3, 2.4), target: DVec3::new(0.0, 0.35, 0.0), ..Camera::default() };
    scene
}

fn scores(scene: &Scene, id: &str, pieces: u32) -> Scores {
    let gpu = gpu();
    let settings = find(id).unwrap().settings(&pairs("size=512")).unwrap();
    let technique = light_pieces(&gpu, &settings, pieces).unwrap();
    let mut renderer = Renderer::new(&gpu, scene, SIZE.0, SIZE.1, vec![LightPass { light: 0, technique }]).unwrap();
    score_frame(&mut renderer, scene, 0, SIZE, 256)
}

#[test]
fn casters_that_hide_others_from_the_whole_light_hide_them_from_fewer_pieces() {
    let scene = plates();
    for id in ["pcss", "pcss-jitter"] {
        let [whole, four, nine] = [1, 4, 9].map(|pieces| scores(&scene, id, pieces));
        println!("{id}: mae {:.4}, {:.4}, {:.4}", whole.mae, four.mae, nine.mae);
        println!("leaks {:.4}, {:.4}, {:.4}", whole.leak, four.leak, nine.leak);
        assert!(four.mae < 0.5 * whole.mae && nine.mae < four.mae, "{id}: {}, {}, {}", whole.mae, four.mae, nine.mae);
        assert!(nine.leak < 0.5 * whole.leak, "{id}: {} → {}", whole.leak, nine.leak);
    }
}

#[test]
fn one_piece_is_the_light_and_too_many_are_refused() {
    let scene = plates();
    let one = scores(&scene, "pcss", 1);
    let plain = against_truth(&gpu(), &scene, 0, "pcss", "size=512", SIZE, 256);
    assert_eq!(one.mae, plain.mae);
    let gpu = gpu();
    let soft = find("pcss").unwrap().default_settings();
    for pieces in [0, 17] {
        assert!(matches!(light_pieces(&gpu, &soft, pieces), Err(Error::Size { .. })));
    }
    let hard = find("shadow-map").unwrap().default_settings();
    assert!(matches!(light_pieces(&gpu, &hard, 4), Err(Error::Unsupported { .. })));
}

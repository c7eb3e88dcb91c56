//! Large lights cut into pieces, for what one map of a light can't hold.

use crate::common::{against_truth, gpu, pairs, score_frame};
use umbrage::core::glam::{DAffine3, DMat3, DVec3};
use umbrage::core::{Camera, Light, LightShape, Material, Scene, primitive};
use umbrage::{Error, find, light_pieces};
use umbrage_metrics::Scores;
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (120, 90);

/// A grid of thin bars between a large lamp and a board that lies over a floor: from the lamp's
/// centre bars hide parts of the board.
fn grid_over_a_board() -> Scene {
    let mut scene = Scene::default();
    let (plane, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let material = scene.add_material(Material::default());
    let place = |size: DVec3, at: DVec3| DAffine3 { matrix3: DMat3::from_diagonal(size), translation: at };
    scene.place(plane, material, place(DVec3::splat(12.0), DVec3::ZERO));
    scene.place(cube, material, place(DVec3::new(1.8, 0.1, 1.8), DVec3::new(0.0, 0.5, 0.0)));
    for i in -4..=4 {
        let at = f64::from(i) * 0.3;
        scene.place(cube, material, place(DVec3::new(0.05, 0.05, 2.6), DVec3::new(at, 1.6, 0.0)));
        scene.place(cube, material, place(DVec3::new(2.6, 0.05, 0.05), DVec3::new(0.0, 1.6, at)));
    }
    scene.lights.push(Light::new(LightShape::Sphere { position: DVec3::new(0.2, 2.8, 0.1), radius: 0.6 }));
    scene.camera = Camera { eye: DVec3::new(2.2, 1.3, 2.2), target: DVec3::new(0.1, 0.2, 0.1), ..Camera::default() };
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
    let scene = grid_over_a_board();
    for id in ["pcss", "pcss-jitter"] {
        let [whole, four, nine] = [1, 4, 9].map(|pieces| scores(&scene, id, pieces));
        println!("{id}: mae {:.4}, {:.4}, {:.4}", whole.mae, four.mae, nine.mae);
        println!("leaks {:.4}, {:.4}, {:.4}", whole.leak, four.leak, nine.leak);
        assert!(four.mae < whole.mae && nine.mae < four.mae, "{id}");
    }
}

#[test]
fn one_piece_is_the_light_and_too_many_are_refused() {
    let scene = grid_over_a_board();
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

//! Hundreds of shadows on one point.

use super::{Bench, floor};
use crate::common::gpu;
use umbrage::core::glam::{DAffine3, DVec2, DVec3};
use umbrage::core::{Camera, Image, LightShape, Mesh, Scene, primitive};

const PLATES: usize = 300;
const SIZE: (u32, u32) = (640, 40);

/// Plates above each other, each 1 cm shorter than the one above, beside the view; their shadows
/// fall at 45 degrees on a floor of as many strips, so that the strip of x = k … k + 1 cm is in k
/// shadows.
fn stairs(plate: &Mesh, is_one_mesh: bool) -> Scene {
    let direction = DVec3::new(1.0, -1.0, 0.0).normalize();
    let mut scene = floor(LightShape::Directional { direction, angle_deg: 0.0 });
    scene.instances[0].casts = false;
    let placed = (1..=PLATES).map(|k| {
        let y = 3.0 + 0.01 * k as f64;
        let (first, last) = (0.01 * k as f64 - y, 3.4 - y);
        let center = DVec3::new((first + last) / 2.0, y, 0.0);
        DAffine3::from_translation(center) * DAffine3::from_scale(DVec3::new(last - first, 0.001, 2.0))
    });
    if is_one_mesh {
        let mut all = Mesh::default();
        placed.for_each(|place| all.append(&plate.transformed(&place)));
        super::put(&mut scene, all, DAffine3::IDENTITY);
    } else {
        let mesh = scene.add_mesh(plate.clone());
        for place in placed {
            scene.place(mesh, 0, place);
        }
    }
    // Straight down on the strips.
    let eye = DVec3::new(1.6, 2.5, 0.0);
    scene.camera =
        Camera { eye, target: eye - DVec3::Y, up: DVec3::NEG_Z, fov_y_deg: 5.0, near: 0.05, ..Camera::default() };
    scene
}

/// In how many shadows each pixel is.
fn shadows(scene: &Scene) -> Image<usize> {
    Image::from_fn(SIZE.0, SIZE.1, |x, y| {
        let ray = scene.camera.ray(DVec2::new(f64::from(x), f64::from(y)) + 0.5, SIZE.0, SIZE.1);
        let x = scene.camera.eye.x + ray.x * scene.camera.eye.y / -ray.y;
        ((x / 0.01).floor().max(0.0) as usize).min(PLATES)
    })
}

#[test]
fn three_hundred_shadows_are_counted() {
    let gpu = gpu();
    for (name, plate) in [("open", primitive::plane()), ("closed", primitive::cube())] {
        for is_one_mesh in [false, true] {
            let scene = stairs(&plate, is_one_mesh);
            let shadows = shadows(&scene);
            let most = shadows.data.iter().max().unwrap();
            assert!(shadows.data.contains(&255) && shadows.data.contains(&256) && *most >= 280, "{most}");
            let sets =
                ["counter=auto", "counter=float", "count=z-fail", "count=z-fail,counter=stencil", "counter=stencil"];
            let mut bench = Bench::new(&gpu, scene, SIZE, &sets);
            let (camera, light) = (bench.scene.camera.clone(), bench.scene.lights[0].clone());
            let target = bench.target(&camera, &light);
            assert!(target.pixels().1 > 15_000, "{:?}", target.pixels());
            for (set, seen) in bench.visibility(&camera, &light) {
                let wrong = target.wrong(&seen);
                let is_stencil = set.contains("stencil");
                println!("{name}, one mesh: {is_one_mesh}, {set}: {} wrong", wrong.len());
                assert!(is_stencil || wrong.is_empty(), "{name}, {set}: {} wrong, {:?}", wrong.len(), wrong.first());
                // 8 bits take 256 for 0, and that alone.
                for (p, count) in (0..).zip(&shadows.data).map(|(i, c)| ((i % SIZE.0, i / SIZE.0), *c)) {
                    let expected = is_stencil && count == 256;
                    assert_eq!(wrong.contains(&p), expected, "{name}, {set}: {count} shadows at {p:?}");
                }
            }
        }
    }
}

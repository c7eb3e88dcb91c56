//! What casts, what receives, and how much memory that takes.

use super::{Bench, EXACT, assert_none, floor, put};
use crate::common::{gpu, renderer};
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Image, LightShape, Scene, primitive};

fn scene() -> Scene {
    let mut scene = floor(LightShape::Point { position: DVec3::new(0.5, 6.0, 0.5) });
    put(&mut scene, primitive::cube(), DAffine3::from_translation(DVec3::new(0.0, 2.0, 0.0)));
    put(&mut scene, primitive::cube(), DAffine3::from_translation(DVec3::new(-0.5, 0.5, -0.5)));
    scene
}

#[test]
fn only_what_casts_throws_shadows_and_only_what_receives_has_them() {
    let gpu = gpu();
    let (mut wrong, mut compared) = (Vec::new(), 0);
    // Of the floor, the box above and the box below: who casts, and who receives.
    for i in 0..64 {
        let mut scene = scene();
        for (k, instance) in scene.instances.iter_mut().enumerate() {
            (instance.casts, instance.receives) = (i >> k & 1 == 1, i >> (k + 3) & 1 == 1);
        }
        let mut bench = Bench::new(&gpu, scene, (80, 60), &["count=z-fail", ""]);
        if bench.target(&bench.scene.camera, &bench.scene.lights[0]).pixels().0 > 0 {
            wrong.extend(bench.own_complaints(&format!("flags {i:06b}")));
            compared += 1;
        }
    }
    assert!(compared > 40, "{compared}");
    assert_none(&wrong);
}

#[test]
fn pictures_show_no_shadow_on_what_does_not_receive() {
    let gpu = gpu();
    let color = |scene: &Scene| -> Image<[u8; 4]> {
        let mut renderer = renderer(&gpu, scene, 0, "volume", "", (160, 120));
        renderer.frame(&scene.camera).unwrap();
        renderer.color().unwrap()
    };
    let mut lit = scene();
    lit.lights[0].casts = false;
    let mut blind = scene();
    blind.instances.iter_mut().for_each(|i| i.receives = false);
    assert_eq!(color(&lit), color(&blind));
    assert_ne!(color(&lit), color(&scene()));
}

#[test]
fn a_light_without_shadows_and_a_scene_without_casters_are_all_lit() {
    let gpu = gpu();
    let mut unlit = scene();
    unlit.lights[0].casts = false;
    let mut none = scene();
    none.instances.iter_mut().for_each(|i| i.casts = false);
    for scene in [unlit, none] {
        let mut bench = Bench::new(&gpu, scene, (80, 60), &EXACT);
        let (camera, light) = (bench.scene.camera.clone(), bench.scene.lights[0].clone());
        for (set, seen) in bench.visibility(&camera, &light) {
            assert!(seen.data.iter().all(|v| *v == 1.0), "{set}");
        }
    }
}

#[test]
fn a_smooth_mesh_takes_no_more_than_thrice_its_own_memory() {
    let gpu = gpu();
    let sphere = primitive::sphere(256, 128);
    let own = 12 * sphere.positions.len() + 4 * sphere.indices.len();
    let mut scene = floor(LightShape::Point { position: DVec3::new(0.5, 6.0, 0.5) });
    put(&mut scene, sphere, DAffine3::from_translation(DVec3::new(0.0, 1.5, 0.0)));
    // What is of the size of the screen is next to nothing here.
    let (width, height) = (16, 12);
    let mut renderer = renderer(&gpu, &scene, 0, "volume", "", (width, height));
    let before = renderer.casters_mut().bytes();
    renderer.frame(&scene.camera).unwrap();
    // Edges count with the casters, once they are made.
    let edges = renderer.casters_mut().bytes() - before;
    assert!(edges > 0, "the edges are not among the casters' bytes");
    let held = renderer.stats(0).bytes + edges;
    let times = held as f64 / own as f64;
    println!("{held} bytes for a mesh of {own}: {times:.2} times");
    assert!(times <= 3.0, "{held} bytes for a mesh of {own}: {times:.2} times");
}

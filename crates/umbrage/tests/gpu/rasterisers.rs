//! What rasterisers may do differently: corners that are infinitely far away in a map, and
//! precision that large grounds take.

use crate::common::{against_truth, gpu};
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, Light, LightShape, Material, Scene, primitive};

/// Boxes of some size, standing at places of a ground that reaches so far to all sides.
fn boxes(ground: f64, size: DVec3, places: &[(f64, f64)], camera: Camera, lights: Vec<LightShape>) -> Scene {
    let lights = lights.into_iter().map(Light::new).collect();
    let mut scene = Scene { lights, camera, ..Scene::default() };
    let (floor, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let material = scene.add_material(Material::default());
    scene.place(floor, material, DAffine3::from_scale(DVec3::splat(ground)));
    for (x, z) in places {
        let middle = DVec3::new(*x, 0.5 * size.y, *z);
        scene.place(cube, material, DAffine3::from_translation(middle) * DAffine3::from_scale(0.5 * size));
    }
    scene
}

#[test]
fn pillars_level_with_the_lamp_shadow_as_they_should() {
    let gpu = gpu();
    // The tops of the pillars are in the planes between two faces of a cube, where w is 0.
    let lamp = |x: f64, z: f64| LightShape::Point { position: DVec3::new(x, 3.0, z) };
    let lights = vec![lamp(0.31, 0.17), lamp(-1.44, 0.57), lamp(1.06, -0.93)];
    let pillars = [(-2.0, -1.5), (-1.0, 1.25), (0.75, 0.5), (1.5, -2.0), (2.25, 1.75), (-0.25, -0.75)];
    let camera = Camera { eye: DVec3::new(4.3, 5.2, 7.3), ..Camera::default() };
    let scene = boxes(10.0, DVec3::new(0.25, 3.0, 0.25), &pillars, camera, lights);
    for light in 0..3 {
        for set in ["", "omni=tetrahedral"] {
            let s = against_truth(&gpu, &scene, light, "shadow-map", set, (320, 240), 1);
            println!("light {light}, {set}: mae {:.5}, leak {:.5}", s.mae, s.leak);
            assert_eq!(s.interior_pct, Some(100.0), "light {light}, {set}");
            assert!(s.leak < 0.004, "light {light}, {set}: leak {:.5}", s.leak);
        }
    }
}

#[test]
fn warped_maps_of_a_large_ground_show_what_stands_on_it() {
    let gpu = gpu();
    let row: Vec<(f64, f64)> = (0..8).map(|i| (1.2 * f64::from(i) - 4.0, -8.0 - f64::from(i))).collect();
    let eye = DVec3::new(0.0, 1.7, 0.0);
    let camera = Camera { eye, target: DVec3::new(0.0, 1.2, -10.0), fov_y_deg: 55.0, ..Camera::default() };
    let direction = DVec3::new(0.2, -0.8, -1.0).normalize();
    let sun = LightShape::Directional { direction, angle_deg: 0.0 };
    let mut scene = boxes(1.0, DVec3::new(0.6, 1.5, 0.6), &row, camera, vec![sun]);
    // In pieces where corners are snapped coarsely: there a triangle of kilometres under the camera
    // may have another depth.
    let pieces = if gpu.snapping() > 1.0 / 256.0 { 8_u32 } else { 1 };
    let side = 2000.0 / f64::from(pieces);
    let floor = scene.instances.remove(0);
    for i in 0..pieces * pieces {
        let at = |number: u32| side * (f64::from(number) + 0.5) - 1000.0;
        let middle = DVec3::new(at(i % pieces), 0.0, at(i / pieces));
        scene.place(
            floor.mesh,
            floor.material,
            DAffine3::from_translation(middle) * DAffine3::from_scale(DVec3::splat(side)),
        );
    }
    let mae = |id: &str, set: &str| against_truth(&gpu, &scene, 0, id, set, (320, 240), 1).mae;
    let without = mae("none", "");
    for (id, set) in [("psm", ""), ("lispsm", ""), ("plane-optimal", ""), ("psm", "filter=vsm")] {
        let with = mae(id, set);
        println!("{id} {set}: mae {with:.5}, without shadows {without:.5}");
        assert!(with < 0.5 * without, "{id} {set}: mae {with:.5}, without any shadow {without:.5}");
    }
}

/// A rasteriser that finds depth from corners far behind the eye shifts the ground by a pixel and
/// more; it still is the plane that its pixels belong to.
#[test]
fn ground_that_reaches_far_behind_the_eye_has_its_shadows() {
    let gpu = gpu();
    let camera = Camera { eye: DVec3::new(3.0, 2.0, 20.0), fov_y_deg: 45.0, ..Camera::default() };
    let direction = DVec3::new(0.9, -1.0, 0.15).normalize();
    let sun = LightShape::Directional { direction, angle_deg: 0.0 };
    let scene = boxes(320.0, DVec3::new(1.0, 1.0, 640.0), &[(0.0, 0.0)], camera, vec![sun]);
    let mae = |id: &str| against_truth(&gpu, &scene, 0, id, "", (240, 180), 1).mae;
    let (without, with) = (mae("none"), mae("projective"));
    println!("mae {with:.5}, without shadows {without:.5}");
    assert!(without > 0.05, "there is next to no shadow");
    assert!(with < 0.01, "mae {with:.5}");
}

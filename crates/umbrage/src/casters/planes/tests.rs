//! Needs a graphics adapter.

use super::ScenePlane;
use crate::{Casters, Gpu, Recorder};
use umbrage_core::glam::{DAffine3, DVec3};
use umbrage_core::{Material, Scene, primitive};

/// Two tiles of a floor, and a box on it.
fn scene() -> Scene {
    let mut scene = Scene::default();
    let (tile, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let material = scene.add_material(Material::default());
    let far = DVec3::new(1e7, 0.0, 3e6);
    for x in [0.0, 1.0] {
        scene.place(tile, material, DAffine3::from_translation(far + DVec3::X * x));
    }
    scene.place(cube, material, DAffine3::from_translation(far + DVec3::new(0.2, 0.5, 0.0)));
    scene
}

fn move_to(gpu: &Gpu, casters: &mut Casters, instance: usize, to: &DAffine3) {
    let instance = casters.instance(instance).expect("an instance of the scene");
    casters.move_instance(instance, to).expect("moved");
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut recorder = Recorder::new(gpu);
    let mut passes = recorder.begin(&mut encoder);
    casters.record(&mut passes).expect("recorded");
    passes.finish();
    gpu.queue.submit([encoder.finish()]);
}

#[test]
fn planes_are_used_again_by_one_alone() {
    let gpu = Gpu::request(None).expect("this test needs a graphics adapter");
    let mut scene = scene();
    // Both of its sides are in one plane.
    scene.place(
        1,
        0,
        DAffine3::from_scale_rotation_translation(
            DVec3::new(1.0, 1e-9, 1.0),
            Default::default(),
            DVec3::new(1e7, 2.0, 3e6),
        ),
    );
    let mut casters = Casters::new(&gpu, &scene).expect("casters");
    casters.receiver_planes();
    for i in 0..50 {
        for instance in [3, 0] {
            let up = DAffine3::from_translation(DVec3::Y * 0.01 * f64::from(i));
            move_to(&gpu, &mut casters, instance, &(up * scene.instances[instance].world_from_mesh));
        }
    }
    let planes = casters.receiver_planes();
    let mut spare = planes.spare.clone();
    spare.sort_unstable();
    spare.dedup();
    assert_eq!(spare.len(), planes.spare.len(), "a plane is spare twice");
    assert!(spare.iter().all(|&number| planes.all()[number as usize].is_empty()), "a spare plane is in use");
    assert!(planes.all().len() < 20, "{} planes", planes.all().len());
}

#[test]
fn coplanar_receivers_share_a_plane_and_movers_change_theirs() {
    let gpu = Gpu::request(None).expect("this test needs a graphics adapter");
    let scene = scene();
    let mut casters = Casters::new(&gpu, &scene).expect("casters");
    let count = |casters: &Casters| casters.receiver_planes().all().iter().filter(|p| !p.is_empty()).count();
    // The floor has the bottom of the box, too.
    assert_eq!(count(&casters), 6);
    let area = |p: &ScenePlane| if p.is_empty() { 0.0 } else { (p.high - p.low).element_product() };
    let largest = casters.receiver_planes().all().iter().map(area).fold(0.0, f64::max);
    assert!((largest - 2.0).abs() < 1e-6, "{largest}");
    let version = casters.receiver_planes().version();
    let up = DAffine3::from_translation(DVec3::Y * 0.3) * scene.instances[2].world_from_mesh;
    move_to(&gpu, &mut casters, 2, &up);
    assert_eq!(count(&casters), 7);
    assert_ne!(casters.receiver_planes().version(), version);
    move_to(&gpu, &mut casters, 2, &scene.instances[2].world_from_mesh);
    assert_eq!(count(&casters), 6);
    for i in 1..50 {
        let up = DAffine3::from_translation(DVec3::Y * 0.01 * f64::from(i)) * scene.instances[2].world_from_mesh;
        move_to(&gpu, &mut casters, 2, &up);
    }
    assert_eq!((count(&casters), casters.receiver_planes().all().len()), (7, 7), "planes are used again");
}

//! Needs a graphics adapter.

use crate::casters::read_back::read;
use crate::{Casters, Gpu, Recorder};
use umbrage_core::glam::{DAffine3, Vec3};
use umbrage_core::{Scene, scenes};

fn pose_all(gpu: &Gpu, casters: &mut Casters, scene: &Scene) {
    for (number, instance) in scene.instances.iter().enumerate() {
        if let Some(joints) = scene.joints(instance) {
            casters.set_pose(casters.instance(number).unwrap(), &joints).unwrap();
        }
    }
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut recorder = Recorder::new(gpu);
    let mut passes = recorder.begin(&mut encoder);
    casters.record(&mut passes).unwrap();
    passes.finish();
    gpu.queue.submit([encoder.finish()]);
}

/// Positions and normals of every posed instance on the GPU are those of the CPU, in a box that
/// holds them; returns how many vertices were compared.
fn check(gpu: &Gpu, casters: &Casters, scene: &Scene) -> usize {
    let (positions, attributes) = (read(gpu, casters.positions()), read(gpu, casters.geometry.attributes.buffer()));
    let mut compared = 0;
    for (number, placed) in casters.placed.iter().enumerate().filter(|(_, p)| p.posed) {
        let instance = &scene.instances[number];
        let want = scene.posed_mesh(instance);
        let part = &casters.meshes()[placed.mesh as usize];
        let (first, bounds) = (part.base_vertex as usize, part.bounds);
        for (i, (p, n)) in want.positions.iter().zip(&want.normals).enumerate() {
            let at = first + i;
            let got = Vec3::from_slice(&positions[3 * at..]);
            let normal = Vec3::from_slice(&attributes[6 * at..]);
            assert!(got.distance(*p) < 1e-5, "vertex {i} of instance {number}: {got} for {p}");
            assert!(normal.distance(*n) < 1e-4, "normal {i} of instance {number}: {normal} for {n}");
            let inside = got.as_dvec3().clamp(bounds.min, bounds.max) == got.as_dvec3();
            assert!(inside, "vertex {i} of instance {number}: {got} is not in {bounds:?}");
            let uv = want.uvs.get(i).copied().unwrap_or_default();
            assert_eq!(attributes[6 * at + 3..6 * at + 6], [uv.x, uv.y, 1.0]);
            compared += 1;
        }
    }
    compared
}

#[test]
fn vertices_on_the_gpu_are_those_of_the_cpu() {
    let gpu = Gpu::request(None).unwrap();
    let mut scene = (scenes::find("tentacles").unwrap().build)(0.3);
    let mut casters = Casters::new(&gpu, &scene).unwrap();
    let at_rest = read(&gpu, casters.positions());
    assert!(check(&gpu, &casters, &scene) > 500, "as they were made");
    for seconds in [0.7, 1.9] {
        scene.advance(seconds);
        pose_all(&gpu, &mut casters, &scene);
        check(&gpu, &casters, &scene);
    }
    let own = 3 * casters.meshes()[scene.meshes.len()].base_vertex as usize;
    let now = read(&gpu, casters.positions());
    assert!(now[..own] == at_rest[..own], "meshes as they were bound have changed");
    assert!(now[own..] != at_rest[own..], "nothing was bent");
}

#[test]
fn what_is_no_pose_changes_nothing() {
    let gpu = Gpu::request(None).unwrap();
    let scene = (scenes::find("tentacles").unwrap().build)(0.05);
    let mut casters = Casters::new(&gpu, &scene).unwrap();
    let bent = scene.instances.iter().position(|i| i.pose.is_some()).unwrap();
    let before = casters.all_bounds();
    let nan = vec![DAffine3::NAN; 12];
    let bent = casters.instance(bent).unwrap();
    assert!(casters.instance(999).is_none());
    let stiff = casters.instance(0).unwrap();
    for (instance, joints, fits) in [(bent, &nan[..], false), (stiff, &[], true)] {
        assert_eq!(casters.set_pose(instance, joints).is_ok(), fits);
        assert_eq!(casters.all_bounds(), before, "instance {instance:?}");
    }
    check(&gpu, &casters, &scene);
    // Joints that are missing do nothing: the tentacle stands as it was bound.
    casters.set_pose(bent, &[]).unwrap();
    let upright = casters.placed.iter().find(|p| p.posed).map(|p| casters.meshes()[p.mesh as usize].bounds).unwrap();
    assert!((upright.max.y - 2.4).abs() < 1e-4 && upright.max.x < 0.2, "{upright:?}");
}

#[test]
fn poses_without_joints_are_refused() {
    let gpu = Gpu::request(None).unwrap();
    let scene = (scenes::find("tentacles").unwrap().build)(0.05);
    let refused = |scene: &Scene| Casters::new(&gpu, scene).err().map(|e| e.to_string()).unwrap_or_default();
    let no_rig = Scene { rigs: Vec::new(), ..scene.clone() };
    let mut short = scene;
    short.rigs[0].skins[0].joints.truncate(3);
    for text in [refused(&no_rig), refused(&short)] {
        assert!(text.contains("without the joints that its mesh needs"), "{text}");
    }
}

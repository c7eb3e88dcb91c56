//! Meshes placed in strange ways and at strange places.

use super::{Bench, COUNTS, EXACT, assert_none, floor, put};
use crate::common::{gpu, renderer, visibility};
use umbrage::core::glam::{DAffine3, DMat3, DVec3};
use umbrage::core::{LightShape, Scene, primitive};

fn lights() -> [LightShape; 2] {
    let direction = DVec3::new(-0.4, -1.0, -0.3).normalize();
    [LightShape::Point { position: DVec3::new(1.5, 4.0, 1.0) }, LightShape::Directional { direction, angle_deg: 0.0 }]
}

/// A closed and an open mesh placed with `m`.
fn placed(light: LightShape, m: DMat3) -> Scene {
    let mut scene = floor(light);
    put(&mut scene, primitive::sphere(24, 12), DAffine3::from_mat3_translation(m, DVec3::new(-1.2, 1.2, 0.0)));
    let mut open = primitive::torus(0.7, 0.3, 24, 12);
    open.indices.truncate(open.indices.len() / 6 * 5);
    put(&mut scene, open, DAffine3::from_mat3_translation(m, DVec3::new(1.2, 1.2, 0.0)));
    scene
}

#[test]
fn mirrored_stretched_and_sheared_meshes_are_right() {
    let gpu = gpu();
    let turn = DMat3::from_rotation_x(0.6) * DMat3::from_rotation_y(1.1);
    let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.8, 1.0, -0.3), DVec3::new(0.0, 0.4, 1.0));
    let stretch = DMat3::from_diagonal(DVec3::new(1.3, 0.2, 0.8));
    let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
    let mut wrong = Vec::new();
    for (name, m) in [
        ("turned", turn),
        ("mirrored", mirror * turn),
        ("stretched", turn * stretch),
        ("sheared", shear),
        ("all of it", turn * mirror * shear * stretch),
        ("mirrored three times", DMat3::from_diagonal(-DVec3::ONE) * turn),
        ("thin as paper", turn * DMat3::from_diagonal(DVec3::new(1.0, 1e-5, 1.0))),
    ] {
        for light in lights() {
            for extrude in ["compute", "vertex", "cpu"] {
                let sets = COUNTS.map(|count| format!("{count},extrude={extrude}"));
                let sets = sets.each_ref().map(String::as_str);
                wrong.extend(Bench::new(&gpu, placed(light.clone(), m), (160, 120), &sets).own_complaints(name));
            }
        }
    }
    assert_none(&wrong);
}

#[test]
fn meshes_squeezed_flat_are_right() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let flat = DMat3::from_rotation_x(0.3) * DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0));
    for light in lights() {
        wrong.extend(Bench::new(&gpu, placed(light, flat), (160, 120), &EXACT).own_complaints("squeezed flat"));
    }
    assert_none(&wrong);
}

/// The scene with everything moved, after it was made larger about the origin.
fn moved(mut scene: Scene, size: f64, offset: DVec3) -> Scene {
    let place = |p: DVec3| p * size + offset;
    for i in &mut scene.instances {
        let matrix3 = i.world_from_mesh.matrix3 * size;
        i.world_from_mesh = DAffine3 { matrix3, translation: place(i.world_from_mesh.translation) };
    }
    if let LightShape::Point { position } = &mut scene.lights[0].shape {
        *position = place(*position);
    }
    let camera = &mut scene.camera;
    (camera.eye, camera.target, camera.near) = (place(camera.eye), place(camera.target), camera.near * size);
    scene
}

#[test]
fn the_size_of_the_world_and_the_way_to_its_origin_do_not_matter() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let far = DVec3::new(1e7, -3e6, -1e7);
    let m = DMat3::from_rotation_x(0.6);
    for (size, offset) in [(1.0, far), (1e-4, DVec3::ZERO), (1e-3, far * 1e-3), (1e5, DVec3::ZERO), (1e5, far)] {
        for light in lights() {
            let scene = moved(placed(light, m), size, offset);
            // Comparing ends 60 m away: all pixels of large worlds are compared here.
            let mut bench = Bench::new(&gpu, scene.clone(), (160, 120), &EXACT);
            let target = bench.whole_target(&scene.camera, &scene.lights[0]);
            assert!(target.pixels().1 > 500, "{:?}", target.pixels());
            let what = format!("{size} times as large, {offset} away");
            wrong.extend(bench.compare(&what, &scene.camera, &scene.lights[0], &target));
        }
    }
    assert_none(&wrong);
}

#[test]
fn vertices_far_from_the_origin_of_their_mesh_are_right() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let offset = DVec3::new(300.0, -200.0, 100.0);
    for light in lights() {
        let mut scene = placed(light, DMat3::from_rotation_x(0.6));
        for i in &mut scene.instances[1..] {
            let mesh = scene.meshes[i.mesh].transformed(&DAffine3::from_translation(offset));
            scene.meshes[i.mesh] = mesh;
            i.world_from_mesh *= DAffine3::from_translation(-offset);
        }
        wrong.extend(Bench::new(&gpu, scene, (160, 120), &EXACT).own_complaints("far from the mesh's origin"));
    }
    assert_none(&wrong);
}

#[test]
fn a_target_of_one_pixel_and_a_line_of_pixels_are_drawn() {
    let gpu = gpu();
    let scene = placed(lights()[0].clone(), DMat3::IDENTITY);
    for size in [(1, 1), (1, 200), (300, 1), (3, 2)] {
        for set in ["count=z-fail", "count=auto,counter=float", "reach=finite,depth-bounds=on"] {
            let seen = visibility(&mut renderer(&gpu, &scene, 0, "volume", set, size), &scene);
            assert!(seen.size() == size && seen.data.iter().all(|v| *v == 0.0 || *v == 1.0), "{set} at {size:?}");
        }
    }
}

//! Shadows projected on planes, where casters, lights and planes are not as in textbooks.

use crate::common::{against_truth, coarseness, gpu, renderer, visibility};
use umbrage::core::glam::{DAffine3, DQuat, DVec3};
use umbrage::core::{Camera, Light, LightShape, Material, Scene, primitive};

const SIZE: (u32, u32) = (160, 120);

/// A floor under a lamp, without casters.
fn floor(lamp: DVec3) -> Scene {
    let mut scene = Scene { lights: vec![Light::new(LightShape::Point { position: lamp })], ..Scene::default() };
    let (plane, material) = (scene.add_mesh(primitive::plane()), scene.add_material(Material::default()));
    scene.place(plane, material, DAffine3::from_scale(DVec3::splat(10.0)));
    scene.camera = Camera { eye: DVec3::new(0.5, 5.0, 7.0), target: DVec3::ZERO, ..Camera::default() };
    scene
}

/// The floor's picture has to be exact but for a few pixels at edges; casters do not receive.
fn assert_exact(what: &str, mut scene: Scene) {
    scene.instances[1..].iter_mut().for_each(|caster| caster.receives = false);
    let gpu = gpu();
    let none = against_truth(&gpu, &scene, 0, "none", "", SIZE, 1);
    assert!(none.mae > 0.005, "{what}: there is next to no shadow");
    let s = against_truth(&gpu, &scene, 0, "projective", "", SIZE, 1);
    println!("{what}: mae {:.5}, interior {:?}, without shadows {:.5}", s.mae, s.interior_pct, none.mae);
    assert_eq!(s.interior_pct, Some(100.0), "{what}");
    assert!(s.mae < 0.001, "{what}: mae {:.5}", s.mae);
}

#[test]
fn mirrored_open_and_cutting_casters_have_their_whole_shadow() {
    let lamp = DVec3::new(1.0, 4.0, 1.0);
    let turned = DQuat::from_rotation_z(0.6) * DQuat::from_rotation_x(0.4);
    for (what, mesh, scale, at) in [
        ("mirrored", primitive::cube(), DVec3::new(-1.5, 1.0, 0.7), DVec3::new(0.0, 1.5, 0.0)),
        ("open", primitive::plane(), DVec3::splat(1.5), DVec3::new(0.0, 1.5, 0.0)),
        ("through the floor", primitive::cube(), DVec3::splat(1.5), DVec3::new(-0.5, 0.3, 0.0)),
        ("lying on the floor", primitive::cube(), DVec3::ONE, DVec3::new(-0.5, 0.5, 0.0)),
        ("behind the light, too", primitive::cube(), DVec3::new(0.5, 8.0, 0.5), DVec3::new(0.0, 4.5, 0.0)),
    ] {
        let mut scene = floor(lamp);
        let (mesh, rotation) = (scene.add_mesh(mesh), if what.starts_with("lying") { DQuat::IDENTITY } else { turned });
        scene.place(mesh, 0, DAffine3::from_scale_rotation_translation(scale, rotation, at));
        assert_exact(what, scene);
    }
}

/// Where pixels are larger than what planes are apart, and a rasteriser shifts surfaces by parts of
/// pixels, each pixel still belongs to its own plane: the wall is of overlapping boards, the ground
/// reaches behind the eye.
#[test]
fn planes_close_together_do_not_shadow_each_other() {
    let gpu = gpu();
    for id in ["picket-fence", "duelling-frusta"] {
        let s = against_truth(&gpu, &crate::common::scene(id, 1.0), 0, "projective", "", (120, 90), 1);
        assert!(s.interior_pct >= Some(99.9), "{id}: {s:?}");
    }
}

#[test]
fn lights_in_and_behind_planes_and_scenes_without_planes_leave_all_lit() {
    let gpu = gpu();
    let above = DVec3::new(1.0, 4.0, 1.0);
    let with_sphere = |lamp: DVec3| {
        let mut scene = floor(lamp);
        scene.instances[0].casts = false;
        let sphere = scene.add_mesh(primitive::sphere(64, 32));
        scene.place(sphere, 0, DAffine3::from_translation(DVec3::Y * 2.0));
        scene
    };
    let mut without_plane = with_sphere(above);
    without_plane.instances.remove(0);
    for (what, scene) in [
        ("in the plane", with_sphere(DVec3::new(2.0, 0.0, 1.0))),
        ("behind the plane", with_sphere(DVec3::new(1.0, -3.0, 1.0))),
        ("no plane", without_plane),
    ] {
        for id in ["projective", "projective-fake"] {
            let s = against_truth(&gpu, &scene, 0, id, "", SIZE, 1);
            // Where a sphere turns away from the light, a coarser rasteriser may show another
            // triangle.
            let others = if coarseness(&gpu) > 0.0 { 2.0 } else { 0.0 };
            assert!(s.mae * s.scored_pixels as f64 <= others, "{id}, {what}: {}", s.mae);
            assert_eq!(s.not_finite, 0, "{id}, {what}");
        }
    }
}

#[test]
fn planes_beyond_the_limit_are_counted() {
    let gpu = gpu();
    let lamp = DVec3::new(1.0, 4.0, 1.0);
    let mut scene = floor(lamp);
    let (plane, cube) = (scene.instances[0].mesh, scene.add_mesh(primitive::cube()));
    for step in 0..4 {
        let place = DVec3::new(-3.0, 0.2 + 0.2 * f64::from(step), 1.5 * f64::from(step) - 2.0);
        scene.place(plane, 0, DAffine3::from_translation(place));
        scene.place(cube, 0, DAffine3::from_translation(place.lerp(lamp, 0.4)));
    }
    let counts = |set: &str| {
        let mut renderer = renderer(&gpu, &scene, 0, "projective", set, SIZE);
        visibility(&mut renderer, &scene);
        renderer.counts(0)
    };
    let (all, two) = (counts("planes=32"), counts("planes=2"));
    let of = |counts: &[(&str, u64)], name: &str| counts.iter().find(|(n, _)| *n == name).unwrap().1;
    assert_eq!((of(&all, "planes left out"), of(&two, "planes drawn")), (0, 2), "{all:?}, {two:?}");
    assert!(of(&all, "planes drawn") > 4, "{all:?}");
    let others = of(&two, "planes not facing the light") + of(&two, "planes without casters");
    assert_eq!(of(&two, "planes left out") + 2 + others, of(&two, "planes in view"), "{two:?}");
}

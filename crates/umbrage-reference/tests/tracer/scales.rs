//! From a millimetre to 10 km, and far from the origin: no surface shadows itself.

use crate::scenes::{place, still_life};
use umbrage_core::glam::{DMat3, DVec3};
use umbrage_core::{Camera, Light, LightShape, Scene, primitive};
use umbrage_reference::closed_form::sphere_above_plane;
use umbrage_reference::{Options, Tracer, Truth};

/// A sphere of this radius at a place, and a camera and a light near it.
fn ball(radius: f64, at: DVec3) -> Scene {
    let mut scene = Scene {
        camera: Camera { eye: at + DVec3::Z * radius * 3.0, target: at, near: radius * 1e-3, ..Camera::default() },
        ..Scene::default()
    };
    place(&mut scene, primitive::sphere(128, 64), DVec3::splat(radius), DMat3::IDENTITY, at);
    let position = at + DVec3::new(2.0, 1.5, 2.0) * radius;
    scene.lights.push(Light::new(LightShape::Point { position }));
    scene.lights.push(Light::new(LightShape::Sphere { position, radius: radius * 0.3 }));
    scene
}

#[test]
fn a_ball_never_shadows_what_faces_the_light() {
    for (radius, at) in [
        (1e-3, DVec3::ZERO),
        (1.0, DVec3::new(3.1, -7.7, 0.2)),
        (1e4, DVec3::ZERO),
        (1e4, DVec3::new(4e5, 0.0, 1e5)),
        (1.0, DVec3::new(1e7, 2e6, -1e7)),
    ] {
        let scene = ball(radius, at);
        let tracer = Tracer::new(&scene);
        let geometry = tracer.geometry(&scene.camera, 160, 120);
        let trace = |light: usize| {
            let options = Options { samples: 256, ..Options::default() };
            tracer.visibility(&geometry, &scene.lights[light], &[], &options, &|_, _| ())
        };
        let (hard, soft) = (trace(0), trace(1));
        let scored = hard.scored.data.iter().filter(|s| **s).count();
        assert!(scored > 3000, "radius {radius} at {at}: only {scored} pixels face the light");
        let LightShape::Sphere { position, radius: light_radius } = scene.lights[1].shape else { panic!("a sphere") };
        for (x, y) in (0..120).flat_map(|y| (0..160).map(move |x| (x, y))).filter(|&p| hard.scored[p]) {
            let place = format!("radius {radius} at {at}, pixel {x}, {y}");
            assert_eq!(hard.visibility[(x, y)], 1.0, "{place}");
            // A convex body hides of a light only what its own horizon hides.
            let surface = geometry.surface(x, y).expect("a scored surface");
            let want = sphere_above_plane(surface.position, surface.normal, position, light_radius);
            let got = f64::from(soft.visibility[(x, y)]);
            assert!((got - want).abs() < 0.03, "{place}: {got} instead of {want}");
        }
    }
}

/// The still life with its places multiplied and moved.
fn moved(scale: f64, offset: DVec3) -> (Scene, Truth) {
    let mut scene = still_life();
    let place = |p: DVec3| p * scale + offset;
    for instance in &mut scene.instances {
        instance.world_from_mesh.matrix3 *= scale;
        instance.world_from_mesh.translation = place(instance.world_from_mesh.translation);
    }
    let Camera { eye, target, near, .. } = scene.camera;
    scene.camera = Camera { eye: place(eye), target: place(target), near: near * scale, ..scene.camera };
    let shape = LightShape::Sphere { position: place(DVec3::new(2.2, 3.6, 1.4)), radius: 0.4 * scale };
    let tracer = Tracer::new(&scene);
    let options = Options { samples: 64, ..Options::default() };
    let geometry = tracer.geometry(&scene.camera, 128, 96);
    let truth = tracer.visibility(&geometry, &Light::new(shape), &[], &options, &|_, _| ());
    (scene, truth)
}

#[test]
fn size_changes_nothing() {
    let (_, one) = moved(1.0, DVec3::ZERO);
    // Powers of two, so that there is no rounding: about a millimetre and 16 km.
    for scale in [1.0 / 8192.0, 4096.0] {
        let (_, other) = moved(scale, DVec3::ZERO);
        assert!(other == one, "scale {scale}");
    }
}

#[test]
fn place_changes_nothing_that_one_could_see() {
    let (_, one) = moved(1.0, DVec3::ZERO);
    for offset in [DVec3::new(1e7, 0.0, 0.0), DVec3::new(-1e6, 1e7, 1e5)] {
        let (_, other) = moved(1.0, offset);
        let differ = one.scored.data.iter().zip(&other.scored.data).filter(|(a, b)| a != b).count();
        let off =
            one.visibility.data.iter().zip(&other.visibility.data).filter(|(a, b)| (*a - *b).abs() > 0.02).count();
        assert!(differ <= 2 && off <= 4, "{offset}: {differ} pixels of the mask and {off} of the visibility differ");
    }
}

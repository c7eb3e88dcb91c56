//! Truth in slices: it converges to the same, and says how far it may be off.

use crate::scenes::{every_light, place, still_life};
use std::sync::Arc;
use umbrage_core::glam::{DMat3, DVec3};
use umbrage_core::{Camera, Image, Light, LightShape, Scene, primitive};
use umbrage_reference::closed_form::{past_half_plane, sphere_above_plane};
use umbrage_reference::{Options, Progressive, Tracer};

const SIZE: (u32, u32) = (64, 48);

fn of(scene: &Scene, light: &Light) -> Progressive {
    Progressive::new(Arc::new(Tracer::new(scene)), &scene.camera, SIZE, light, &scene.textures)
}

/// Traces until every pixel that needs them has so many samples.
fn traced(scene: &Scene, light: &Light, samples: u32) -> Progressive {
    let mut truth = of(scene, light);
    while truth.samples() < samples && truth.advance(|| false) {}
    truth
}

fn rms(a: &Image<f32>, b: &Image<f32>, scored: &Image<bool>) -> f64 {
    let pairs = a.data.iter().zip(&b.data).zip(&scored.data).filter(|(_, scored)| **scored);
    let squares: Vec<f64> = pairs.map(|((a, b), _)| f64::from(a - b).powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn it_converges_to_the_truth_under_every_light() {
    let scene = still_life();
    let tracer = Tracer::new(&scene);
    let geometry = tracer.geometry(&scene.camera, SIZE.0, SIZE.1);
    for light in every_light() {
        let name = light.shape.kind().name();
        let truth =
            tracer.visibility(&geometry, &light, &[], &Options { samples: 4096, ..Options::default() }, &|_, _| ());
        let slices = traced(&scene, &light, 512);
        assert!(slices.scored() == &truth.scored, "{name}");
        let seen = slices.geometry().unwrap();
        assert!(seen.depth == geometry.depth && seen.model == geometry.model && seen.receives == geometry.receives);
        let (error, off) = (slices.standard_error(), rms(slices.visibility(), &truth.visibility, &truth.scored));
        if light.shape.kind().is_soft() {
            let error = error.unwrap();
            assert!(off < 1.2 * error && off > 0.3 * error && error < 0.01, "{name}: {off} off, {error} expected");
        } else {
            let mut slices = slices;
            assert!(!slices.advance(|| true), "{name}: there was more to do");
            assert!(slices.visibility() == &truth.visibility && slices.samples() == 1, "{name}");
        }
    }
}

#[test]
fn a_straight_edge_is_within_three_standard_errors_of_its_formula() {
    // A floor, half of it under a sheet that ends at x = −0.2.
    let (edge, along, into) = (DVec3::new(-0.2, 1.1, 0.0), DVec3::Z, DVec3::NEG_X);
    let camera = Camera { eye: DVec3::new(0.0, 1.0, 2.0), target: DVec3::new(0.0, 0.0, -0.5), ..Camera::default() };
    let mut scene = Scene { camera, ..Scene::default() };
    place(&mut scene, primitive::plane(), DVec3::splat(9.0), DMat3::IDENTITY, DVec3::ZERO);
    place(&mut scene, primitive::plane(), DVec3::splat(40.0), DMat3::IDENTITY, edge + into * 20.0);
    let (position, radius) = (DVec3::new(0.3, 4.0, 0.2), 0.5);
    let light = Light::new(LightShape::Sphere { position, radius });
    let truth = traced(&scene, &light, 1024);
    let (geometry, errors) = (truth.geometry().unwrap(), truth.errors());
    let (mut sums, mut pixels) = ((0.0, 0.0, 0.0), 0.0);
    for y in 0..SIZE.1 {
        for x in (0..SIZE.0).filter(|&x| truth.scored()[(x, y)]) {
            let at = geometry.surface(x, y).unwrap().position;
            if at.y > 0.5 {
                continue;
            }
            let want = sphere_above_plane(at, past_half_plane(at, edge, along, into), position, radius);
            let off = f64::from(truth.visibility()[(x, y)]) - want;
            let error = f64::from(errors[(x, y)]);
            sums = (sums.0 + off, sums.1 + off * off, sums.2 + error * error);
            pixels += f64::from(u8::from(want > 0.0 && want < 1.0));
        }
    }
    let (sum, squares, expected) = sums;
    assert!(pixels > 200.0, "{pixels} pixels in the penumbra");
    assert!(sum.abs() < 3.0 * expected.sqrt(), "a bias of {sum}, {} expected", expected.sqrt());
    let ratio = (squares / expected).sqrt();
    assert!((0.6..1.2).contains(&ratio), "errors are {ratio} of what is said");
}

#[test]
fn the_length_of_slices_and_the_threads_change_no_bit() {
    let (scene, light) = (still_life(), every_light()[4].clone());
    let whole = traced(&scene, &light, 96);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut slices = of(&scene, &light);
    let mut length = 0;
    while slices.samples() < 96 {
        length = length % 5 + 1;
        let (mut left, mut batches) = (length, 0);
        pool.install(|| {
            slices.advance(|| {
                batches += 1;
                left -= 1;
                left > 0
            })
        });
        assert!(batches <= length, "a slice continued though it was told to stop");
    }
    assert_eq!(slices.samples(), whole.samples());
    assert!(slices.errors() == whole.errors());
    assert!(slices.visibility() == whole.visibility());
}

#[test]
fn a_coarse_picture_comes_first() {
    let (scene, light) = (still_life(), every_light()[4].clone());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut truth = of(&scene, &light);
    assert!(pool.install(|| truth.advance(|| false)));
    let known = truth.scored().data.iter().filter(|scored| **scored).count();
    let shown = truth.visibility().data.iter().filter(|value| **value > 0.0).count();
    assert!(known < SIZE.0 as usize * SIZE.1 as usize / 4, "{known} pixels were traced in the first slice");
    assert!(shown > 2 * known && truth.standard_error().is_none() && truth.geometry().is_none());
    let whole = traced(&scene, &light, 4);
    let off = rms(truth.visibility(), whole.visibility(), whole.scored());
    assert!(off < 0.5, "the coarse picture is {off} off");
}

#[test]
fn another_light_gives_what_it_gives_alone() {
    let (scene, lights) = (still_life(), every_light());
    let mut truth = traced(&scene, &lights[5], 24);
    for light in [&lights[0], &lights[6]] {
        truth.set_light(light, &[]);
        assert_eq!((truth.samples(), truth.is_whole()), (0, false));
        while truth.samples() < 24 && truth.advance(|| false) {}
        let alone = traced(&scene, light, 24);
        assert!(truth.visibility() == alone.visibility() && truth.scored() == alone.scored());
        assert!(truth.geometry().unwrap().depth == alone.geometry().unwrap().depth);
    }
}

#[test]
fn pictures_of_nothing_end() {
    let (scene, light) = (still_life(), every_light()[4].clone());
    let empty = Scene { camera: scene.camera.clone(), ..Scene::default() };
    for (scene, size) in [(&empty, SIZE), (&scene, (0, 0)), (&scene, (5, 0))] {
        let mut truth = Progressive::new(Arc::new(Tracer::new(scene)), &scene.camera, size, &light, &[]);
        assert!(!truth.advance(|| true) && truth.is_whole());
        assert_eq!(truth.standard_error(), Some(0.0));
        assert!(truth.visibility().data.iter().all(|value| *value == 0.0));
    }
}

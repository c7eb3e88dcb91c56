//! Lights at exact places: on corners, edges and planes, and within casters.

use super::{Bench, EXACT, Target, assert_none, floor, put};
use crate::common::gpu;
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, Light, LightShape, Mesh, Scene, primitive};

/// Which way the technique moves a light that is on a corner or a plane.
const OFF: DVec3 = DVec3::new(0.1, 0.073, 0.087);

fn point(position: DVec3) -> Light {
    Light::new(LightShape::Point { position })
}

/// The unit cube about (0, 1, 0) over the floor and two boxes beside it.
fn scene() -> Scene {
    let mut scene = floor(LightShape::Point { position: DVec3::Y });
    put(&mut scene, primitive::cube(), DAffine3::from_translation(DVec3::Y));
    put(&mut scene, primitive::cube(), DAffine3::from_translation(DVec3::new(2.0, 0.5, 0.3)));
    put(&mut scene, primitive::cube(), DAffine3::from_translation(DVec3::new(-1.5, 0.5, -1.3)));
    scene
}

fn open_cube() -> Mesh {
    let mut cube = primitive::cube();
    cube.indices.truncate(30);
    cube
}

fn cameras() -> [Camera; 3] {
    let camera = |eye, target| Camera { eye, target, fov_y_deg: 60.0, ..Camera::default() };
    [
        camera(DVec3::new(0.3, 4.0, 6.0), DVec3::ZERO),
        camera(DVec3::new(-3.0, 1.2, -2.0), DVec3::new(0.0, 0.5, 0.0)),
        camera(DVec3::new(2.2, 0.4, 2.0), DVec3::new(0.2, 0.3, 0.0)),
    ]
}

/// What all lights around a place agree on is compared; the truth is that of a light on the
/// technique's side.
fn agreed(bench: &Bench, camera: &Camera, position: DVec3) -> [Target; 2] {
    let moved = |by: DVec3| bench.target(camera, &point(position + by * 1e-4));
    let own = moved(OFF);
    let mut mask = own.mask.clone();
    // To all sides, and on its own side where borders of shadows are seen under somewhat other
    // angles.
    for (low, high, i) in
        [(-1.0, 1.0, 0..8), (0.85, 1.15, 0..8)].into_iter().flat_map(|(l, h, r)| r.map(move |i| (l, h, i)))
    {
        let pick = |bit: usize| if i >> bit & 1 == 0 { low } else { high };
        let other = moved(OFF * DVec3::new(pick(0), pick(1), pick(2)));
        let differs = |p: usize| other.mask.data[p] && other.reference.data[p] != own.reference.data[p];
        (0..mask.data.len()).for_each(|p| mask.data[p] &= !differs(p));
    }
    let agreed = Target::new(own.reference.clone(), mask, false);
    [own, agreed]
}

#[test]
fn a_light_on_a_corner_an_edge_or_a_face_throws_the_shadow_from_beside_it() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let open = {
        let mut scene = scene();
        scene.meshes[1] = open_cube();
        scene
    };
    let mut benches = [scene(), open].map(|scene| Bench::new(&gpu, scene, (120, 90), &EXACT));
    let places = [-0.5, 0.0, 0.5, 1.5];
    for i in 0..64 {
        let position = DVec3::new(places[i % 4], places[i / 4 % 4] + 1.0, places[i / 16]);
        let camera = &cameras()[i % 3];
        let bench = &mut benches[i / 3 % 2];
        let [own, agreed] = agreed(bench, camera, position);
        for (set, seen) in bench.visibility(camera, &point(position)) {
            let what = format!("light at {position} from {}, {set}", camera.eye);
            wrong.extend(agreed.complaint(&what, &seen));
            // From two millionths of a metre beside an edge, where its shadow begins is seen under
            // the right angle to within some per cent.
            let (correct, _) = own.right_pct(&seen);
            if correct < 98.5 {
                wrong.push(format!("{what}: {correct:.3} % correct"));
            }
        }
    }
    assert_none(&wrong);
}

#[test]
fn parallel_light_along_faces_and_edges_leaves_no_streaks() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let mut bench = Bench::new(&gpu, scene(), (160, 120), &EXACT);
    for direction in [DVec3::NEG_Y, DVec3::new(1.0, -1.0, 0.0), DVec3::new(1.0, -1.0, 1.0), DVec3::new(0.0, -1.0, 1.0)]
    {
        for camera in &cameras() {
            let shape = LightShape::Directional { direction: direction.normalize(), angle_deg: 0.0 };
            wrong.extend(bench.complaints(&format!("{direction} from {}", camera.eye), camera, &Light::new(shape)));
        }
    }
    assert_none(&wrong);
}

#[test]
fn nothing_outside_a_closed_box_is_lit_from_within() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    for (name, mesh) in [("box", primitive::cube()), ("sphere", primitive::sphere(16, 8))] {
        let mut scene = scene();
        scene.meshes[scene.instances[1].mesh] = mesh;
        // The others have boxes of their own.
        let cube = scene.add_mesh(primitive::cube());
        scene.instances[2].mesh = cube;
        scene.instances[3].mesh = cube;
        let mut bench = Bench::new(&gpu, scene, (160, 120), &EXACT);
        for position in [DVec3::Y, DVec3::new(0.3, 0.8, -0.41), DVec3::new(0.1, 1.15, 0.2)] {
            for camera in &cameras() {
                let light = point(position);
                let target = bench.target(camera, &light);
                let (scored, dark) = target.pixels();
                assert!(scored == dark && scored > 500, "{dark} of {scored}");
                wrong.extend(bench.compare(&format!("{name}, light at {position}"), camera, &light, &target));
            }
            // And from within.
            let camera = Camera { eye: DVec3::new(-0.1, 0.9, 0.1), target: position + DVec3::X, ..Camera::default() };
            wrong.extend(bench.complaints(&format!("in the {name}, light at {position}"), &camera, &point(position)));
        }
    }
    assert_none(&wrong);
}

#[test]
fn lights_at_great_and_small_distance_are_right() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let mut bench = Bench::new(&gpu, scene(), (160, 120), &EXACT);
    let toward = DVec3::new(0.3, 1.0, 0.2).normalize();
    for distance in [1e3, 1e5, 1e7] {
        for camera in &cameras() {
            wrong.extend(bench.complaints(&format!("{distance} m away"), camera, &point(toward * distance)));
        }
    }
    // Just above the box, beside it and above the floor.
    for position in [DVec3::new(0.1, 1.501, 0.2), DVec3::new(0.501, 1.1, 0.1), DVec3::new(1.0, 0.001, 0.5)] {
        for camera in &cameras() {
            wrong.extend(bench.complaints(&format!("light at {position}"), camera, &point(position)));
        }
    }
    assert_none(&wrong);
}

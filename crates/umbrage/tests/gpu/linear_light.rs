//! Maps for linear lights: the closed form where it is exact, lights that are none, gaps, and what
//! is kept.

use crate::common::{against_truth, gpu, renderer, visibility};
use crate::robust::box_scene;
use crate::shared_references::{mask, size, stored};
use umbrage::Gpu;
use umbrage::core::glam::{DAffine3, DMat3, DVec2, DVec3};
use umbrage::core::{Camera, Image, Light, LightShape, Material, Scene, primitive};
use umbrage_metrics::{Comparison, score};
use umbrage_reference::{Options, Tracer};

const HEIGHT: f64 = 4.0;
const SIZE: (u32, u32) = (128, 32);

/// A line light along x over an edge at x = 0 over a floor, the camera below the edge.
fn edge_scene(half: f64, edge: f64, width: f64) -> Scene {
    let line = LightShape::Line { from: DVec3::new(-half, HEIGHT, 0.0), to: DVec3::new(half, HEIGHT, 0.0) };
    let mut scene = Scene { lights: vec![Light::new(line)], ..Scene::default() };
    let (plane, material) = (scene.add_mesh(primitive::plane()), scene.add_material(Material::default()));
    let place = |size: f64, at: DVec3| DAffine3 { matrix3: DMat3::from_diagonal(DVec3::splat(size)), translation: at };
    scene.place(plane, material, place(40.0, DVec3::ZERO));
    scene.place(plane, material, place(20.0, DVec3::new(-10.0, edge, 0.0)));
    let above = 0.9 * edge;
    let half_rows = 0.5 * width * f64::from(SIZE.1) / f64::from(SIZE.0);
    scene.camera = Camera {
        eye: DVec3::new(0.0, above, 0.0),
        target: DVec3::ZERO,
        up: DVec3::NEG_Z,
        fov_y_deg: 2.0 * (half_rows / above).atan().to_degrees(),
        near: 0.01 * above,
        ..Camera::default()
    };
    scene
}

/// The largest error of a picture whose columns see `share(x)` of the light.
fn worst(seen: &Image<f32>, width: f64, share: impl Fn(f64) -> f64) -> f64 {
    let off = |x: u32, y: u32| {
        let place = ((f64::from(x) + 0.5) / f64::from(SIZE.0) - 0.5) * width;
        (f64::from(seen[(x, y)]) - share(place)).abs()
    };
    (0..SIZE.0).flat_map(|x| (0..SIZE.1).map(move |y| (x, y))).map(|(x, y)| off(x, y)).fold(0.0, f64::max)
}

fn picture(gpu: &Gpu, scene: &Scene, set: &str) -> Image<f32> {
    visibility(&mut renderer(gpu, scene, 0, "linear-light", set, SIZE), scene)
}

#[test]
fn blocker_light_and_receiver_that_are_parallel_are_exact() {
    let gpu = gpu();
    for (half, edge) in [(0.5, 1.5), (0.2, 2.5)] {
        // From the shadow of one end to that of the other.
        let penumbra = half * edge / (HEIGHT - edge);
        let width = 3.0 * penumbra;
        let scene = edge_scene(half, edge, width);
        let share = |x: f64| ((x / penumbra + 1.0) * 0.5).clamp(0.0, 1.0);
        for set in ["", "edges=map", "edges=map,shares=linear", "samples=3", "samples=4,edges=map,shares=linear"] {
            let off = worst(&picture(&gpu, &scene, &format!("size=1536,{set}")), width, share);
            println!("half {half} edge {edge} {set}: {off:.4}");
            assert!(off <= 0.005, "light of ±{half} m, edge at {edge} m, {set}: off by {off}");
        }
    }
}

/// Two plates above each other beside a box, and a line that slopes.
fn plates() -> Scene {
    let line = LightShape::Line { from: DVec3::new(-0.8, 4.0, 0.6), to: DVec3::new(0.9, 4.4, -0.3) };
    let mut scene = box_scene(line);
    let plate = |at: DVec3| DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(0.5, 0.05, 0.4)), translation: at };
    for at in [DVec3::new(1.6, 0.9, 0.4), DVec3::new(1.9, 1.6, 0.2)] {
        scene.place(1, 0, plate(at));
    }
    scene
}

#[test]
fn errors_under_a_line_are_as_stated() {
    let (gpu, scene) = (gpu(), plates());
    // Mean absolute error ×10⁻⁴.
    let rows =
        [("", 18.0), ("samples=3", 9.0), ("samples=5", 6.5), ("edges=map", 19.0), ("edges=map,shares=linear", 41.0)];
    let mut wrong = Vec::new();
    for (set, mae) in rows {
        let s = against_truth(&gpu, &scene, 0, "linear-light", set, (160, 120), 256);
        let got = s.mae * 1e4;
        let row = format!("{set}: mae {got:.2}e-4 (stated {mae}), interior {:.2}", s.interior_pct.unwrap_or(0.0));
        println!("{row}");
        if got > mae || got < 0.5 * mae || s.not_finite > 0 {
            wrong.push(row);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
#[ignore = "needs the shared references"]
fn two_maps_and_five_are_as_near_to_the_truth_as_they_have_to_be() {
    let gpu = gpu();
    for (name, light, scene, stored) in stored(|scene, _| scene.name.contains("line light")) {
        let hard = hard(&scene, light, size(&stored));
        for (samples, most) in [(2, 0.15), (5, 0.05)] {
            let set = format!("samples={samples}");
            let mut renderer = renderer(&gpu, &scene, light, "linear-light", &set, size(&stored));
            let produced = visibility(&mut renderer, &scene);
            let (reference, mask) = (&stored.visibility, mask(&stored));
            let compared = Comparison {
                produced: &produced,
                reference,
                mask: &mask,
                hard: Some(&hard),
                reach: None,
                contacts: None,
            };
            let s = score(&compared).unwrap();
            println!("{name} samples={samples}: mae {:.5}, vs_hard {:.3}", s.mae, s.vs_hard.unwrap());
            assert!(s.vs_hard.unwrap() <= most, "{name} samples={samples}");
        }
    }
}

/// The shadow of the light's centre.
fn hard(scene: &Scene, light: usize, (width, height): (u32, u32)) -> Image<f32> {
    let tracer = Tracer::new(scene);
    let geometry = tracer.geometry(&scene.camera, width, height);
    let one = Options { samples: 1, ..Options::default() };
    tracer.visibility(&geometry, &scene.lights[light], &scene.textures, &one, &|_, _| ()).visibility
}

/// Of a frame in which nothing moves the look-up is left, one for both ends.
#[test]
fn nothing_is_drawn_while_nothing_moves() {
    let (gpu, mut scene) = (gpu(), plates());
    for edges in ["silhouettes", "map"] {
        let mut renderer =
            renderer(&gpu, &scene, 0, "linear-light", &format!("size=256,focus=light,edges={edges}"), SIZE);
        let first = visibility(&mut renderer, &scene);
        let drawn = renderer.stats(0).draws;
        assert!(drawn > 10, "{drawn}");
        for _ in 0..2 {
            assert_eq!(visibility(&mut renderer, &scene).data, first.data);
            assert_eq!(renderer.stats(0).draws, 1);
        }
        // A walk in a scene that stands still.
        let eye = scene.camera.eye;
        scene.camera.eye.x += 0.1;
        visibility(&mut renderer, &scene);
        assert_eq!(renderer.stats(0).draws, 1);
        scene.camera.eye = eye;
        renderer.light_mut(0).unwrap().shape =
            LightShape::Line { from: DVec3::new(-0.8, 4.0, 0.6), to: DVec3::new(1.2, 4.2, -0.3) };
        let moved = visibility(&mut renderer, &scene);
        assert!(renderer.stats(0).draws > 10);
        assert_ne!(moved.data, first.data);
    }
}

#[test]
fn a_light_cut_by_the_receivers_plane_is_seen_in_part() {
    let gpu = gpu();
    // The floor hides the half of the line that is below it; no other caster is left.
    let line = LightShape::Line { from: DVec3::new(0.0, -1.0, 0.0), to: DVec3::new(0.0, 1.0, 0.0) };
    let mut scene = box_scene(line);
    scene.instances.truncate(1);
    for set in ["", "samples=3", "samples=4", "edges=map"] {
        let mut renderer = renderer(&gpu, &scene, 0, "linear-light", set, (160, 120));
        let seen = visibility(&mut renderer, &scene);
        let depth = renderer.depth(&scene.camera).unwrap();
        let floor = seen.data.iter().zip(&depth.data).filter(|(_, depth)| **depth > 0.0);
        let (size, off) = (floor.clone().count(), floor.filter(|(v, _)| (**v - 0.5).abs() > 0.02).count());
        assert!(size > 1000 && off < 10, "{set}: {off} of {size} pixels of the floor");
    }
}

#[test]
fn a_line_without_length_is_a_point() {
    let gpu = gpu();
    let position = DVec3::new(1.0, 4.0, 1.0);
    let line = box_scene(LightShape::Line { from: position, to: position });
    let point = box_scene(LightShape::Point { position });
    let of = |scene: &Scene, id: &str| visibility(&mut renderer(&gpu, scene, 0, id, "", (160, 120)), scene);
    let want = of(&point, "shadow-map");
    assert!(want.data.contains(&0.0) && want.data.contains(&1.0));
    assert_eq!(of(&line, "linear-light").data, want.data);
    // Nor has one that is all but without.
    let short = box_scene(LightShape::Line { from: position, to: position + DVec3::X * 1e-9 });
    let off = |a: f32, b: f32| (a - b).abs() > 0.01;
    let wrong = of(&short, "linear-light").data.iter().zip(&want.data).filter(|(a, b)| off(**a, **b)).count();
    assert!(wrong < 20, "{wrong} pixels");
}

#[test]
fn a_thin_rectangle_is_its_axis() {
    let gpu = gpu();
    let rect = |up: DVec3, size: DVec2| {
        let position = DVec3::new(1.0, 4.0, 1.0);
        box_scene(LightShape::Rect { position, direction: DVec3::NEG_Y, up, size, texture: None })
    };
    // One eighth as wide as long, either way round.
    for (up, size) in [(DVec3::Z, DVec2::new(1.0, 0.125)), (DVec3::X, DVec2::new(0.125, 1.0))] {
        let s = against_truth(&gpu, &rect(up, size), 0, "linear-light", "", (160, 120), 256);
        println!("{size}: mae {:.5}", s.mae);
        assert!(s.mae < 0.0002, "{size}: {}", s.mae);
    }
}

#[test]
fn odd_lights_and_meshes_leave_no_pixel_without_a_number() {
    let gpu = gpu();
    let mut broken = primitive::cube();
    broken.positions[3].x = f32::NAN;
    broken.positions[9].y = f32::INFINITY;
    let ends = [
        // Through the box, along one of its edges, in the floor, far away, and from the camera.
        [DVec3::new(-2.0, 1.0, 0.0), DVec3::new(2.0, 1.1, 0.0)],
        [DVec3::new(0.5, 1.5, -0.5), DVec3::new(0.5, 1.5, 0.5)],
        [DVec3::ZERO, DVec3::X],
        [DVec3::new(-1e6, 1e6, 0.0), DVec3::new(1e6, 1e6, 0.0)],
        [DVec3::new(0.0, 4.0, 7.0), DVec3::new(0.0, 5.0, 7.0)],
    ];
    for [from, to] in ends {
        let mut scene = box_scene(LightShape::Line { from, to });
        let mesh = scene.add_mesh(broken.clone());
        scene.place(mesh, 0, DAffine3::from_translation(DVec3::new(3.0, 1.0, 0.0)));
        for set in ["size=128", "size=128,edges=map,samples=3", "size=1"] {
            let seen = picture(&gpu, &scene, set);
            assert!(seen.data.iter().all(|v| (0.0..=1.0).contains(v)), "{from} to {to}, {set}");
        }
    }
}

#[test]
fn far_from_the_origin_a_line_has_the_same_shadows() {
    let gpu = gpu();
    let here = plates();
    let mut far = here.clone();
    let offset = DVec3::new(1e7, 0.0, -1e7);
    far.camera.eye += offset;
    far.camera.target += offset;
    far.instances.iter_mut().for_each(|i| i.world_from_mesh.translation += offset);
    if let LightShape::Line { from, to } = &mut far.lights[0].shape {
        *from += offset;
        *to += offset;
    }
    for set in ["size=512", "size=512,edges=map"] {
        let (a, b) = (picture(&gpu, &here, set), picture(&gpu, &far, set));
        let mae = a.data.iter().zip(&b.data).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / a.data.len() as f64;
        assert!(mae < 5e-4, "{set}: {mae}");
    }
}

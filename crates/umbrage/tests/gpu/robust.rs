//! Strange input gives a right picture or a clear error, never a panic.

use crate::common::{against_truth, gpu, pairs, renderer, scene, visibility};
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, Light, LightKind, LightShape, Material, Mesh, Scene, primitive};
use umbrage::{Error, find, light_samples, techniques};
use umbrage_renderer::{LightPass, Renderer};

/// A box over a floor under one light.
pub fn box_scene(shape: LightShape) -> Scene {
    let mut scene = Scene { lights: vec![Light::new(shape)], ..Scene::default() };
    let (floor, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let material = scene.add_material(Material::default());
    scene.place(floor, material, DAffine3::from_scale(DVec3::splat(10.0)));
    scene.place(cube, material, DAffine3::from_translation(DVec3::new(0.0, 1.0, 0.0)));
    scene.camera = Camera { eye: DVec3::new(0.0, 4.0, 7.0), ..Camera::default() };
    scene
}

fn every_light() -> Vec<LightShape> {
    let position = DVec3::new(1.0, 4.0, 1.0);
    let direction = DVec3::new(-0.2, -1.0, -0.2).normalize();
    vec![
        LightShape::Point { position },
        LightShape::Spot { position, direction, inner_angle_deg: 20.0, outer_angle_deg: 30.0 },
        LightShape::Directional { direction, angle_deg: 0.0 },
        LightShape::Directional { direction, angle_deg: 2.0 },
        LightShape::Sphere { position, radius: 0.3 },
        LightShape::Ellipsoid { position, radii: DVec3::new(0.1, 0.2, 0.4), rotation: Default::default() },
        LightShape::Disc { position, direction, radius: 0.3 },
        LightShape::Rect {
            position,
            direction,
            up: direction.any_orthonormal_vector(),
            size: [0.4, 0.2].into(),
            texture: None,
        },
        LightShape::Line { from: position, to: position + DVec3::X },
    ]
}

#[test]
fn every_technique_does_every_light_that_it_claims() {
    let gpu = gpu();
    for info in techniques() {
        for shape in every_light().into_iter().filter(|s| info.lights.contains(s.kind())) {
            let scene = box_scene(shape);
            let kind = scene.lights[0].shape.kind().name();
            let seen = visibility(&mut renderer(&gpu, &scene, 0, info.id, "", (160, 120)), &scene);
            assert!(seen.data.iter().all(|v| (0.0..=1.0).contains(v)), "{} {kind}: outside 0…1", info.id);
            let dark = seen.data.iter().filter(|v| **v < 0.5).count();
            assert_eq!(dark > 100, info.id != "none", "{} {kind}: {dark} dark pixels", info.id);
        }
    }
}

#[test]
fn nothing_to_draw_is_all_lit() {
    let gpu = gpu();
    let full = box_scene(every_light()[0].clone());
    let no_instances = Scene { instances: Vec::new(), ..full.clone() };
    let no_triangles = Scene { meshes: vec![Mesh::default(); 2], ..full.clone() };
    let mut no_casters = full.clone();
    no_casters.instances.iter_mut().for_each(|i| i.casts = false);
    let mut light_off = full;
    light_off.lights[0].casts = false;
    for (what, scene) in
        [("instances", no_instances), ("triangles", no_triangles), ("casters", no_casters), ("shadow", light_off)]
    {
        for info in techniques() {
            let seen = visibility(&mut renderer(&gpu, &scene, 0, info.id, "", (32, 24)), &scene);
            assert!(seen.data.iter().all(|v| *v == 1.0), "{} without {what}", info.id);
        }
    }
}

/// Nothing of a frame at a larger size is left, such as the part of the picture that was drawn.
#[test]
fn a_light_that_casts_no_more_lights_all_at_any_size() {
    let gpu = gpu();
    let scene = box_scene(every_light()[0].clone());
    for id in ["shadow-map", "cascaded", "pcss-jitter", "evsm"] {
        let mut renderer = renderer(&gpu, &scene, 0, id, "", (160, 120));
        assert!(visibility(&mut renderer, &scene).data.contains(&0.0), "{id} has no shadow");
        renderer.light_mut(0).unwrap().casts = false;
        renderer.resize(64, 48).unwrap();
        assert!(visibility(&mut renderer, &scene).data.iter().all(|v| *v == 1.0), "{id}");
        gpu.check().unwrap();
    }
}

#[test]
fn no_lights_leave_ambient() {
    let gpu = gpu();
    let mut scene = box_scene(every_light()[0].clone());
    scene.lights.clear();
    scene.ambient = [0.5; 3].into();
    let mut renderer = Renderer::new(&gpu, &scene, 32, 24, Vec::new()).unwrap();
    renderer.frame(&scene.camera).unwrap();
    let picture = renderer.color().unwrap();
    assert!(picture[(16, 12)][0] > 100, "{:?}", picture[(16, 12)]);
}

#[test]
fn sizes_are_checked() {
    let gpu = gpu();
    let scene = box_scene(every_light()[0].clone());
    let limit = gpu.device.limits().max_texture_dimension_2d;
    for (width, height) in [(0, 24), (32, 0), (limit + 1, 24)] {
        let error = Renderer::new(&gpu, &scene, width, height, Vec::new()).err().expect("an error");
        assert!(matches!(error, Error::Size { .. }), "{error}");
    }
    let seen = visibility(&mut renderer(&gpu, &scene, 0, "shadow-map", "size=1", (1, 1)), &scene);
    assert_eq!(seen.size(), (1, 1));
    let info = find("shadow-map").unwrap();
    assert!(info.settings(&pairs("size=0")).is_err());
    for samples in [0, 1_000_000] {
        let settings = info.settings(&[]).unwrap();
        assert!(matches!(light_samples(&gpu, &settings, samples), Err(Error::Size { .. })));
    }
}

#[test]
fn a_light_that_is_not_there_is_an_error() {
    let gpu = gpu();
    let scene = box_scene(every_light()[0].clone());
    let info = find("none").unwrap();
    let technique = info.settings(&[]).unwrap().make(&gpu).unwrap();
    let error = Renderer::new(&gpu, &scene, 8, 8, vec![LightPass { light: 7, technique }]).err().expect("an error");
    assert!(error.to_string().contains("no light 7"), "{error}");
}

/// From the largest half float below 1 to 1.
fn half_below_one() -> f32 {
    1.0 / 2048.0
}

#[test]
fn lights_in_casters_and_far_away_are_no_trouble() {
    let gpu = gpu();
    // Inside the box; far above, where only the floor below the box is dark; in the floor, which
    // lights nothing above it.
    let center = DVec3::new(0.0, 1.0, 0.0);
    for (position, floor) in [(center, 0.0), (DVec3::new(0.0, 1e6, 0.0), 1.0), (DVec3::new(0.0, -1e6, 0.0), 0.0)] {
        let scene = box_scene(LightShape::Point { position });
        for id in ["shadow-map", "pcf", "volume", "projective", "projective-fake"] {
            let seen = visibility(&mut renderer(&gpu, &scene, 0, id, "", (160, 120)), &scene);
            // Weights of a filter may add up to one rounding less than 1, which a driver that cuts
            // half floats off stores as the next below.
            let off = (seen[(80, 110)] - floor).abs();
            assert!(off <= half_below_one(), "{id} {position}: {off} off");
        }
    }
}

#[test]
fn a_thin_gap_keeps_its_shadow_with_every_choice_of_faces() {
    // A plate just above a floor under a lamp far up: what counts as the same surface must not
    // swallow the gap.
    let gpu = gpu();
    let mut scene = box_scene(LightShape::Point { position: DVec3::new(3.0, 35.0, 2.0) });
    scene.instances[1].world_from_mesh = DAffine3::from_scale_rotation_translation(
        DVec3::new(2.0, 0.02, 2.0),
        Default::default(),
        DVec3::new(0.0, 0.12, 0.0),
    );
    let dark = |faces: &str| {
        let set = format!("size=2048,faces={faces}");
        let seen = visibility(&mut renderer(&gpu, &scene, 0, "shadow-map", &set, (320, 240)), &scene);
        seen.data.iter().filter(|v| **v < 0.5).count()
    };
    let front = dark("front");
    assert!(front > 100, "{front}");
    for faces in ["back", "midpoint"] {
        let count = dark(faces);
        assert!(count.abs_diff(front) * 20 < front, "{faces}: {count} dark pixels, {front} with front");
    }
}

#[test]
fn a_light_in_two_passes_is_an_error() {
    let gpu = gpu();
    let scene = box_scene(every_light()[0].clone());
    let make = || {
        let info = find("shadow-map").unwrap();
        LightPass { light: 0, technique: info.settings(&[]).unwrap().make(&gpu).unwrap() }
    };
    let twice = Renderer::new(&gpu, &scene, 8, 8, vec![make(), make()]).err().expect("an error");
    assert!(twice.to_string().contains("two passes"), "{twice}");
}

#[test]
fn vertices_that_are_not_finite_do_no_harm() {
    let gpu = gpu();
    let mut scene = box_scene(every_light()[2].clone());
    let mut broken = primitive::cube();
    broken.positions[3].x = f32::NAN;
    broken.positions[9].y = f32::INFINITY;
    let mesh = scene.add_mesh(broken);
    scene.place(mesh, 0, DAffine3::from_translation(DVec3::new(3.0, 1.0, 0.0)));
    for id in ["shadow-map", "volume", "projective", "projective-fake"] {
        let seen = visibility(&mut renderer(&gpu, &scene, 0, id, "", (160, 120)), &scene);
        assert!(seen.data.iter().all(|v| v.is_finite()), "{id}");
        assert!(seen.data.contains(&0.0) && seen.data.contains(&1.0), "{id}");
    }
}

#[test]
fn ten_thousand_kilometres_away_looks_the_same() {
    let gpu = gpu();
    let here = scene("contact", 1.0);
    let mut far = here.clone();
    // A whole number that single precision holds, so that only the arithmetic is tested.
    let offset = DVec3::new(1e7, 0.0, -1e7);
    far.camera.eye += offset;
    far.camera.target += offset;
    far.instances.iter_mut().for_each(|i| i.world_from_mesh.translation += offset);
    for light in &mut far.lights {
        match &mut light.shape {
            LightShape::Point { position } | LightShape::Sphere { position, .. } => *position += offset,
            other => panic!("the scene has a light of another kind: {other:?}"),
        }
    }
    for id in ["shadow-map", "volume", "projective", "projective-fake"] {
        let of = |scene: &Scene| visibility(&mut renderer(&gpu, scene, 0, id, "", (320, 240)), scene);
        let (a, b) = (of(&here), of(&far));
        let mae = a.data.iter().zip(&b.data).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / a.data.len() as f64;
        assert!(mae < 2e-4, "{id}: {mae}");
    }
}

#[test]
fn flags_are_honoured() {
    let gpu = gpu();
    let mut scene = box_scene(LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 });
    scene.camera.eye = DVec3::new(0.0, 1.0, 9.0);
    let dark = |scene: &Scene, id: &str| {
        let mut renderer = renderer(&gpu, scene, 0, id, "", (160, 120));
        renderer.frame(&scene.camera).unwrap();
        let picture = renderer.color().unwrap();
        // The middle of the floor, below the box.
        picture[(80, 60)][0] < 60
    };
    let mut blind = scene.clone();
    blind.instances[0].receives = false;
    let mut through = scene.clone();
    through.instances[1].casts = false;
    for id in ["shadow-map", "volume", "projective", "projective-fake"] {
        assert!(dark(&scene, id), "{id}");
        assert!(!dark(&blind, id), "{id}: no shadow falls on a floor that does not receive");
        assert!(!dark(&through, id), "{id}: a box that does not cast has no shadow");
    }
}

#[test]
fn soft_lights_are_refused_where_a_technique_is_not_hard() {
    let gpu = gpu();
    let info = find("pcf").unwrap();
    let settings = info.settings(&[]).unwrap();
    let error = light_samples(&gpu, &settings, 16).err().expect("an error");
    assert!(error.to_string().contains("not a hard technique"), "{error}");
    assert!(find("none").unwrap().supports(LightKind::Rect).is_ok());
    assert!(find("shadowmap").unwrap_err().to_string().contains("did you mean `shadow-map`"));
}

#[test]
fn filters_beside_an_area_light_are_like_a_single_compare() {
    // 1 mm above the floor, which filters continue to beyond its horizon there.
    let gpu = gpu();
    let up = DVec3::Y;
    let position = DVec3::new(0.0, 0.001, 2.0);
    let shapes = [
        LightShape::Line { from: position - DVec3::X * 2.0, to: position + DVec3::X * 2.0 },
        LightShape::Rect { position, direction: up, up: DVec3::Z, size: [1.2, 0.8].into(), texture: None },
    ];
    for shape in shapes {
        let scene = box_scene(shape);
        let error = |id, set| against_truth(&gpu, &scene, 0, id, set, (80, 60), 16).false_shadow;
        let one = error("shadow-map", "");
        for (id, set) in
            [("pcf", ""), ("pcf", "kernel=7"), ("pcf", "kernel=disc"), ("pcf-jitter", ""), ("pcf-blur", "")]
        {
            let wide = error(id, set);
            assert!(wide < one + 0.01, "{id} {set}: false shadow {wide}, of one compare {one}");
        }
    }
}

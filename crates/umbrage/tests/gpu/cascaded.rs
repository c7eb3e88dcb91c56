//! Splits under every filter: one split is the filter's own map, more of them err less, and steady
//! ones stand still.

use crate::common::{against_truth, gpu, renderer, scene, visibility};
use umbrage::Registry;
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, Image, Instance, Light, LightShape, Scene};

const SIZE: (u32, u32) = (320, 240);

fn filters() -> Vec<&'static str> {
    Registry::default().filters(false).map(|info| info.id).collect()
}

fn mae(a: &Image<f32>, b: &Image<f32>) -> f64 {
    a.data.iter().zip(&b.data).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / a.data.len() as f64
}

/// A spot that shines on all that is seen from 8 m above it.
fn lamp() -> Light {
    let direction = DVec3::new(0.1, -1.0, -0.05).normalize();
    Light::new(LightShape::Spot { position: DVec3::Y * 8.0, direction, inner_angle_deg: 40.0, outer_angle_deg: 50.0 })
}

fn sun() -> Light {
    Light::new(LightShape::Directional { direction: DVec3::new(0.4, -1.0, 0.3).normalize(), angle_deg: 2.0 })
}

#[test]
fn one_split_is_the_map_of_the_filter() {
    let gpu = gpu();
    for light in [sun(), lamp()] {
        let scene = Scene { lights: vec![light], ..scene("primitives", 0.5) };
        for filter in filters() {
            let kernel = if filter == "pcf" { ",kernel=3" } else { "" };
            let set = format!("splits=1,blend=off,filter={filter}{kernel}");
            let split = visibility(&mut renderer(&gpu, &scene, 0, "cascaded", &set, SIZE), &scene);
            let alone = visibility(&mut renderer(&gpu, &scene, 0, filter, "", SIZE), &scene);
            let apart = mae(&split, &alone);
            assert!(apart < 2e-4, "{filter} under {:?}: {apart}", scene.lights[0].shape);
        }
    }
}

#[test]
fn every_filter_gives_shares_on_splits_of_every_kind() {
    let gpu = gpu();
    for light in [sun(), lamp(), Light::new(LightShape::Sphere { position: DVec3::Y * 6.0, radius: 0.4 })] {
        let scene = Scene { lights: vec![light], ..scene("primitives", 0.3) };
        let size = (160, 120);
        for filter in filters() {
            let truth = visibility(&mut renderer(&gpu, &scene, 0, filter, "", size), &scene);
            for more in ["blend=lerp", "stabilize=on,margin=0.2", "depth-fit=on,splits=9"] {
                let set = format!("filter={filter},{more}");
                let got = visibility(&mut renderer(&gpu, &scene, 0, "cascaded", &set, size), &scene);
                assert!(got.data.iter().all(|v| (0.0..=1.0).contains(v)), "{set}");
                // Texels of another size make edges of another width, no more.
                let apart = mae(&got, &truth);
                assert!(apart < 0.012, "{set} under {:?}: {apart}", scene.lights[0].shape);
            }
        }
    }
}

#[test]
fn every_filter_mixes_splits() {
    let gpu = gpu();
    let scene = scene("terrain", 0.25);
    for filter in filters() {
        let [alone, mixed] = ["off", "lerp"].map(|blend| {
            let set = format!("filter={filter},blend={blend}");
            visibility(&mut renderer(&gpu, &scene, 0, "cascaded", &set, (160, 120)), &scene)
        });
        let apart = mae(&alone, &mixed);
        assert!(apart > 1e-5 && apart < 5e-3, "{filter}: {apart}");
    }
}

#[test]
fn four_splits_err_at_most_half_as_much_as_a_map_of_as_many_texels_each() {
    let gpu = gpu();
    let city = scene("city", 1.0);
    let error = |id: &str, set: &str| {
        let s = against_truth(&gpu, &city, 0, id, set, (640, 480), 1);
        assert!(s.interior_pct.unwrap_or(0.0) >= 99.8, "{id} {set}: interior {:?}", s.interior_pct);
        s.mae
    };
    let one = error("shadow-map", "size=4096");
    // What covers the whole part, receivers or not, has coarser texels.
    let fits =
        [("", 0.5), ("stabilize=on", 0.5), ("depth-fit=on", 0.5), ("filter=shadow-map", 0.5), ("fit=frustum", 0.6)];
    for (set, share) in fits {
        let splits = error("cascaded", format!("size=1024,{set}").trim_end_matches(','));
        println!("{set}: {splits} of {one}");
        assert!(splits <= share * one, "{set}: {splits} of {one}");
    }
}

#[test]
fn steady_views_with_a_margin_stay_while_the_camera_moves() {
    let gpu = gpu();
    let city = scene("city", 0.3);
    let mut r = renderer(&gpu, &city, 0, "cascaded", "stabilize=on,margin=0.1,size=256", (64, 48));
    let mut changes = 0;
    let mut before = None;
    for i in 0..20 {
        let step = DVec3::new(0.02 * f64::from(i), 0.0, 0.01 * f64::from(i));
        let camera = Camera { eye: city.camera.eye + step, target: city.camera.target + step, ..city.camera.clone() };
        r.frame(&camera).unwrap();
        let views = r.technique(0).unwrap().inside().light_views().to_vec();
        assert_eq!(views.len(), 4);
        changes += usize::from(before.replace(views.clone()).is_some_and(|b| b != views));
    }
    assert!(changes <= 2, "{changes} of 19 frames with other views");
}

#[test]
fn ten_thousand_kilometres_away_splits_and_warped_maps_look_the_same() {
    let gpu = gpu();
    let here = scene("city", 0.3);
    let mut far = here.clone();
    let offset = DVec3::new(1e7, 0.0, -1e7);
    far.camera.eye += offset;
    far.camera.target += offset;
    far.instances.iter_mut().for_each(|i| i.world_from_mesh.translation += offset);
    let splits = ["", "stabilize=on", "depth-fit=on", "filter=pcss-jitter", "filter=evsm"].map(|set| ("cascaded", set));
    let warps = [("psm", ""), ("psm", "cube=on"), ("psm", "shift=off"), ("lispsm", ""), ("plane-optimal", "")];
    for (id, set) in splits.into_iter().chain(warps) {
        let of = |scene: &Scene| visibility(&mut renderer(&gpu, scene, 0, id, set, SIZE), scene);
        let apart = mae(&of(&here), &of(&far));
        println!("{id} {set}: {apart}");
        assert!(apart < 0.002, "{id} {set}: {apart}");
    }
}

#[test]
fn odd_views_are_no_trouble() {
    let gpu = gpu();
    let city = scene("city", 0.2);
    let along = |direction: DVec3| Light::new(LightShape::Directional { direction, angle_deg: 0.0 });
    let ahead = (city.camera.target - city.camera.eye).normalize();
    let lights = [along(ahead), along(-ahead), along(DVec3::Y), along(DVec3::NEG_Y)];
    for (i, light) in lights.into_iter().enumerate() {
        for eye in [city.camera.eye, DVec3::Y * 3000.0, DVec3::NEG_Y * 5.0] {
            let camera = Camera { eye, ..city.camera.clone() };
            let scene = Scene { lights: vec![light.clone()], camera, ..city.clone() };
            for set in
                ["", "stabilize=on", "depth-fit=on", "distance=5", "splits=9,fit=frustum", "splits=1,distance=1e-9"]
            {
                let set = format!("size=128{}{set}", if set.is_empty() { "" } else { "," });
                let got = visibility(&mut renderer(&gpu, &scene, 0, "cascaded", &set, (64, 48)), &scene);
                assert!(got.data.iter().all(|v| (0.0..=1.0).contains(v)), "light {i}, eye {eye}, {set}");
            }
        }
    }
}

#[test]
fn outside_of_a_narrow_cone_shadows_are_those_of_other_maps() {
    // Receivers all around the axis, most of them farther than 60 degrees from it.
    let mut scene = crate::robust::box_scene(LightShape::Spot {
        position: DVec3::new(1.5, 3.0, 1.0),
        direction: DVec3::new(0.0, -1.0, 1e-4).normalize(),
        inner_angle_deg: 0.045,
        outer_angle_deg: 0.05,
    });
    scene.camera.fov_y_deg = 70.0;
    let cube = scene.instances[1].clone();
    for x in [-4.0, 4.0] {
        let at = DVec3::new(x, 1.0, -3.0);
        scene.instances.push(Instance { world_from_mesh: DAffine3::from_translation(at), ..cube.clone() });
    }
    let score = |id, set| against_truth(&gpu(), &scene, 0, id, set, (96, 72), 1).mae;
    let expected = score("shadow-map", "size=512");
    // A point light has no splits either.
    for set in ["size=512", "size=512,fit=frustum", "size=512,depth-fit=on", "size=512,filter=pcss"] {
        let got = score("cascaded", set);
        assert!(got < expected + 0.002, "cascaded:{set}: {got}, shadow-map {expected}");
    }
    let none = score("none", "");
    assert!(none > 0.01, "hardly any shadow: {none}");
}

//! Pictures of what happens inside.

use super::{floor, put};
use crate::common::{gpu, pairs};
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Image, LightShape, Scene, primitive};
use umbrage::{Technique, find};
use umbrage_renderer::{LightPass, Renderer};

fn scene(shape: LightShape) -> Scene {
    let mut scene = floor(shape);
    for x in [-1.5, 0.0, 1.5] {
        put(&mut scene, primitive::sphere(12, 6), DAffine3::from_translation(DVec3::new(x, 1.5, 0.0)));
    }
    scene
}

fn technique(gpu: &umbrage::Gpu, set: &str) -> Box<dyn Technique> {
    let info = find("volume").unwrap();
    info.settings(&pairs(set)).unwrap().make(gpu).unwrap()
}

/// The picture of `view`, and the visibility beside it.
fn picture(gpu: &umbrage::Gpu, scene: &Scene, set: &str, view: Option<&str>) -> (Option<Image<[u8; 4]>>, Image<f32>) {
    let mut technique = technique(gpu, set);
    technique.inside_mut().inspect(view);
    let pass = LightPass { light: 0, technique };
    let mut renderer = Renderer::new(gpu, scene, 160, 120, vec![pass]).unwrap();
    // Lights that light nothing in view have pictures, too.
    renderer.set_clipping(false);
    renderer.frame(&scene.camera).unwrap();
    renderer.frame(&scene.camera).unwrap();
    let shown = renderer.technique(0).unwrap().inside().debug_views();
    assert_eq!(shown.iter().map(|v| v.name).collect::<Vec<_>>(), view.into_iter().collect::<Vec<_>>());
    let picture = shown.first().map(|v| renderer.read_debug_color(v).unwrap());
    (picture, renderer.visibility(0).unwrap())
}

#[test]
fn every_view_shows_something_and_changes_no_shadow() {
    let gpu = gpu();
    let direction = DVec3::new(0.2, -1.0, 0.1).normalize();
    let lights = [
        LightShape::Point { position: DVec3::new(0.4, 5.0, 1.0) },
        LightShape::Directional { direction, angle_deg: 0.0 },
    ];
    let names = find("volume").unwrap().views;
    assert!(names.len() >= 5, "{names:?}");
    for scene in lights.map(scene) {
        for extrude in ["compute", "vertex", "cpu"] {
            for count in ["z-pass-eye", "z-fail"] {
                let set = format!("extrude={extrude},count={count}");
                let (nothing, plain) = picture(&gpu, &scene, &set, None);
                assert!(nothing.is_none());
                for name in names {
                    let (seen, visibility) = picture(&gpu, &scene, &set, Some(name));
                    let seen = seen.unwrap();
                    let differ = seen.data.iter().filter(|p| **p != seen.data[0]).count();
                    assert!(differ > 200, "{name}, {set}: all but {differ} pixels are {:?}", seen.data[0]);
                    assert_eq!(visibility, plain, "{name}, {set}");
                }
            }
        }
    }
}

#[test]
fn views_of_nothing_are_drawn_too() {
    let gpu = gpu();
    let mut scene = scene(LightShape::Point { position: DVec3::new(0.4, 5.0, 1.0) });
    scene.instances.iter_mut().for_each(|i| i.casts = false);
    for name in find("volume").unwrap().views {
        let (_, visibility) = picture(&gpu, &scene, "", Some(name));
        assert!(visibility.data.iter().all(|v| *v == 1.0), "{name}");
    }
    scene.instances.clear();
    for name in find("volume").unwrap().views {
        picture(&gpu, &scene, "", Some(name));
    }
}

#[test]
fn counts_are_shown_as_they_are() {
    // Two plates above each other: their common shadow has another colour than that of one, and
    // that another than the light.
    let gpu = gpu();
    let mut scene = floor(LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 });
    for (x, y) in [(0.0, 1.0), (0.5, 1.5)] {
        put(&mut scene, primitive::plane(), DAffine3::from_translation(DVec3::new(x, y, 0.0)));
    }
    scene.instances[1].receives = false;
    scene.camera.eye = DVec3::new(0.3, 0.9, 1.5);
    scene.camera.target = DVec3::new(0.3, 0.0, 0.0);
    scene.camera.fov_y_deg = 60.0;
    for count in ["z-pass-eye", "z-fail"] {
        let seen = picture(&gpu, &scene, &format!("count={count}"), Some("count")).0.unwrap();
        // Colours of one and two shadows; magenta would be less than none.
        let has = |r: f64, g: f64, b: f64| {
            let bytes = [r, g, b].map(|v| (v * 255.0).round() as u8);
            seen.data.iter().filter(|p| (0..3).all(|i| p[i].abs_diff(bytes[i]) <= 1)).count()
        };
        let (one, two, below) = (has(0.10, 0.30, 0.75), has(0.05, 0.60, 0.60), has(1.0, 0.0, 1.0));
        println!("{count}: {one} pixels in one shadow, {two} in two");
        assert!(one > 300 && two > 300 && below == 0, "{count}: {one}, {two}, {below}");
    }
}

//! What hosts choose: alpha masks, casters the camera can't see, and one overlay for all lights.

use super::{Bench, EXACT, assert_none, floor, put, renderer_of};
use crate::common::gpu;
use umbrage::core::glam::{DAffine3, DVec2, DVec3, Vec4};
use umbrage::core::{Camera, Light, LightShape, Material, Scene, primitive};
use umbrage::find;
use umbrage_reference::Tracer;
use umbrage_renderer::{LightPass, Renderer};

const LIGHT: DVec3 = DVec3::new(0.5, 6.0, 0.5);

/// A card over a floor, cut away wholly by its mask: the eye looks through it and its shadow is
/// still whole.
fn masked() -> Scene {
    let mut scene = floor(LightShape::Point { position: LIGHT });
    let base_color = Vec4::new(0.8, 0.8, 0.8, 0.2);
    let glass = scene.add_material(Material { base_color, alpha_cutoff: Some(0.5), ..Material::default() });
    let card = put(&mut scene, primitive::plane(), DAffine3::from_translation(DVec3::new(0.0, 2.0, 0.0)));
    scene.instances[card].material = glass;
    scene
}

#[test]
fn masked_cards_cast_whole_also_where_the_eye_looks_through_them() {
    let gpu = gpu();
    let mut whole = masked();
    whole.materials.iter_mut().for_each(|m| m.alpha_cutoff = None);
    let (seen_by, truth) = (Tracer::new(&masked()), Tracer::new(&whole));
    let size = (160, 120);
    // From above through the card, from beside it, and from within its shadow.
    for eye in [DVec3::new(0.2, 7.0, 1.0), DVec3::new(0.0, 3.0, 5.0), DVec3::new(0.1, 1.0, 0.1)] {
        let camera = Camera { eye, target: DVec3::new(0.0, 0.0, -0.4), ..Camera::default() };
        let depth = seen_by.geometry(&camera, size.0, size.1).depth;
        for way in EXACT {
            let whole = format!("{way}{}masked=whole", if way.is_empty() { "" } else { "," });
            let mut renderer = renderer_of(&gpu, &masked(), &whole, size);
            renderer.frame(&camera).unwrap();
            let seen = renderer.visibility(0).unwrap();
            let floor = (0..size.0 * size.1).map(|i| (i % size.0, i / size.0)).filter(|p| depth[*p] > 0.0);
            let is_wrong = |&(x, y): &(u32, u32)| {
                let ray = camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5), size.0, size.1);
                // Depth is rounded; the floor itself must not be in the way.
                let point = eye + ray * f64::from(depth[(x, y)]) + DVec3::Y * 1e-5;
                (seen[(x, y)] < 0.5) != truth.blocked(point, LIGHT.extend(1.0))
            };
            let (all, wrong) = (floor.clone().count(), floor.filter(is_wrong).count());
            assert!(all > 2000 && wrong * 1000 <= all, "{way} from {eye}: {wrong} of {all} pixels wrong");
        }
    }
}

#[test]
fn casters_unseen_by_the_camera_change_nothing_where_all_are_seen() {
    let gpu = gpu();
    let mut scene = floor(LightShape::Point { position: LIGHT });
    put(&mut scene, primitive::torus(1.0, 0.4, 24, 12), DAffine3::from_translation(DVec3::new(0.0, 1.5, 0.0)));
    put(&mut scene, primitive::plane(), DAffine3::from_translation(DVec3::new(1.5, 1.0, 1.5)));
    let mut bench =
        Bench::new(&gpu, scene, (160, 120), &["unseen=on", "unseen=on,counter=stencil", "", "wedges:unseen=on"]);
    assert_none(&bench.own_complaints("unseen"));
    assert_eq!((bench.count_of(0, "from the eye"), bench.count_of(2, "from infinity")), (0, 0));
}

#[test]
fn the_overlay_darkens_what_is_in_any_shadow() {
    let gpu = gpu();
    let mut scene = floor(LightShape::Point { position: LIGHT });
    scene.lights.push(Light::new(LightShape::Directional {
        direction: DVec3::new(0.6, -1.0, 0.2).normalize(),
        angle_deg: 0.0,
    }));
    scene.ambient = [0.5; 3].into();
    put(&mut scene, primitive::cube(), DAffine3::from_translation(DVec3::new(0.0, 1.5, 0.0)));
    let passes = (0..2).map(|light| {
        let info = find("volume").unwrap();
        LightPass { light, technique: info.settings(&[]).unwrap().make(&gpu).unwrap() }
    });
    let mut renderer = Renderer::new(&gpu, &scene, 160, 120, passes.collect()).unwrap();
    renderer.frame(&scene.camera).unwrap();
    let [one, other] = [0, 1].map(|light| renderer.visibility(light).unwrap());
    let (depth, right) = (renderer.depth(&scene.camera).unwrap(), renderer.color().unwrap());
    renderer.set_overlay(Some(1.0)).unwrap();
    renderer.frame(&scene.camera).unwrap();
    let overlay = renderer.color().unwrap();
    let mut dark = [0; 2];
    for (i, color) in overlay.data.iter().enumerate().filter(|(i, _)| depth.data[*i] > 0.0) {
        let in_any = one.data[i] < 0.5 || other.data[i] < 0.5;
        dark[usize::from(in_any)] += 1;
        assert_eq!(color[..3] == [0; 3], in_any, "pixel {i}: {color:?}");
    }
    assert!(dark.iter().all(|n| *n > 500), "{dark:?}");
    // And back to the right way.
    renderer.set_overlay(None).unwrap();
    renderer.frame(&scene.camera).unwrap();
    assert_eq!(renderer.color().unwrap().data, right.data);
}

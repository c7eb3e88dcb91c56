//! Depth maps with silhouettes.

use crate::common::{against_truth, gpu, pairs, renderer, scene, visibility};
use umbrage::core::glam::{DAffine3, DMat3, DVec3};
use umbrage::core::{Camera, Light, LightShape, Material, Scene, primitive};
use umbrage::find;
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (160, 120);

#[test]
fn a_few_texels_are_as_good_as_many_without_silhouettes() {
    let gpu = gpu();
    for (id, detail) in [("contact", 1.0), ("overlap", 1.0), ("lantern", 0.5), ("duelling-frusta", 1.0)] {
        let scene = scene(id, detail);
        let error = |technique, set| against_truth(&gpu, &scene, 0, technique, set, SIZE, 1).mae;
        let [with, without] =
            [("silhouette-map", "size=256"), ("shadow-map", "size=1024")].map(|(t, set)| error(t, set));
        assert!(with < 0.75 * without, "{id}: {with} with silhouettes, {without} without");
    }
}

#[test]
fn two_edges_in_a_texel_are_no_worse_than_none_until_all_texels_have_them() {
    let gpu = gpu();
    let scene = scene("picket-fence", 1.0);
    // At 16 texels a picket is a third of one.
    for (size, at_most) in [(16, 2.5), (64, 0.6), (128, 0.3)] {
        let [with, without] = ["silhouette-map", "shadow-map"]
            .map(|id| against_truth(&gpu, &scene, 0, id, &format!("size={size}"), SIZE, 1));
        assert!(with.mae < at_most * without.mae, "{size}: {} and {} without", with.mae, without.mae);
        assert_eq!(with.not_finite, 0);
    }
}

/// A wall of boards, each farther out than the one below, whose ledges all face a light from below.
fn ledges() -> Scene {
    let light = LightShape::Point { position: DVec3::new(0.4, -1.5, 4.0) };
    let mut scene = Scene { lights: vec![Light::new(light)], ..Scene::default() };
    let (cube, material) = (scene.add_mesh(primitive::cube()), scene.add_material(Material::default()));
    for i in 0..10 {
        let out = 0.03 * f64::from(i);
        let matrix3 = DMat3::from_diagonal(DVec3::new(8.0, 0.22, 0.5 + out));
        let translation = DVec3::new(0.0, 0.11 + 0.2 * f64::from(i), 0.5 * (out - 0.5));
        scene.place(cube, material, DAffine3 { matrix3, translation });
    }
    scene.camera =
        Camera { eye: DVec3::new(0.3, 1.0, 4.0), target: DVec3::new(0.0, 1.0, 0.0), fov_y_deg: 12.0, ..scene.camera };
    scene
}

#[test]
fn ledges_narrower_than_texels_that_face_the_light_are_no_shadows() {
    let gpu = gpu();
    let mut scene = ledges();
    let score = |scene: &Scene, id, set| against_truth(&gpu, scene, 0, id, set, SIZE, 1);
    let [with, without] = ["silhouette-map", "shadow-map"].map(|id| score(&scene, id, "size=64").false_shadow);
    assert!(with == 0.0 && without > 1e-3, "{with}, {without} without silhouettes");
    // What stands out of the wall has a shadow all the same, from the wall on.
    for (y, width) in [(0.85, 0.3), (1.1, 0.1)] {
        let matrix3 = DMat3::from_diagonal(DVec3::new(width, 0.05, 1.0));
        scene.place(0, 0, DAffine3 { matrix3, translation: DVec3::new(0.1, y, 0.0) });
    }
    let [none, with, without] = [("none", ""), ("silhouette-map", "size=64"), ("shadow-map", "size=64")]
        .map(|(id, set)| score(&scene, id, set).mae);
    assert!(with < 0.1 * without && without < 0.2 * none, "{with}, {without} without silhouettes, {none} with none");
}

#[test]
fn the_order_of_casters_and_of_edges_does_not_matter() {
    let gpu = gpu();
    let mut turned = scene("city", 0.3);
    let known = visibility(&mut renderer(&gpu, &turned, 0, "silhouette-map", "size=256", SIZE), &turned);
    turned.instances.reverse();
    for mesh in &mut turned.meshes {
        mesh.indices.as_chunks_mut::<3>().0.reverse();
    }
    for _ in 0..2 {
        let again = visibility(&mut renderer(&gpu, &turned, 0, "silhouette-map", "size=256", SIZE), &turned);
        let differ = known.data.iter().zip(&again.data).filter(|(a, b)| a != b).count();
        // Where surfaces meet, the picture's own depth may be that of the other one.
        assert!(differ < 4, "{differ} pixels differ");
    }
}

#[test]
fn every_picture_shows_something_and_changes_no_shadow() {
    let gpu = gpu();
    let scene = scene("contact", 1.0);
    let frame = |view: Option<&str>| {
        let mut technique = find("silhouette-map").unwrap().settings(&pairs("size=128")).unwrap().make(&gpu).unwrap();
        technique.inside_mut().inspect(view);
        let mut renderer = Renderer::new(&gpu, &scene, 160, 120, vec![LightPass { light: 0, technique }]).unwrap();
        let shadow = visibility(&mut renderer, &scene);
        let views = renderer.technique(0).unwrap().inside().debug_views();
        let shown = views.iter().find(|v| Some(v.name) == view).map(|v| renderer.read_debug_color(v).unwrap());
        (shown, shadow.data)
    };
    let (_, shadow) = frame(None);
    for name in ["silhouettes", "silhouette-pixels", "parts"] {
        let (shown, seen) = frame(Some(name));
        assert!(seen == shadow, "{name} changes the shadow");
        let data = shown.unwrap_or_else(|| panic!("{name} is not shown")).data;
        let colored = data.iter().filter(|[r, g, b, _]| r.max(g).max(b) - r.min(g).min(b) > 60).count();
        assert!((20..4000).contains(&colored), "{name}: {colored} pixels in colour");
    }
    gpu.check().unwrap();
}

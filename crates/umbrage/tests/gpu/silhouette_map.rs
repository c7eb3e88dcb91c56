//! Depth maps with silhouettes.

use crate::common::{against_truth, gpu, pairs, renderer, scene, visibility};
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

//! Pictures of what happens inside `wedges`.

use crate::common::{gpu, pairs};
use crate::wedges::star;
use umbrage::core::glam::DVec3;
use umbrage::core::{Image, LightShape, Sampling, Scene, Texture, primitive};
use umbrage::find;
use umbrage_renderer::{LightPass, Renderer};

/// The picture of `view`, and the visibility beside it.
fn picture(gpu: &umbrage::Gpu, scene: &Scene, set: &str, view: Option<&str>) -> (Option<Image<[u8; 4]>>, Image<f32>) {
    let info = find("wedges").unwrap();
    let mut technique = info.settings(&pairs(set)).unwrap().make(gpu).unwrap();
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

const POSITION: DVec3 = DVec3::new(0.6, 4.0, 0.4);

fn ball() -> Scene {
    star(LightShape::Sphere { position: POSITION, radius: 0.5 })
}

fn rect(texture: Option<usize>) -> Scene {
    let (direction, up) = (DVec3::NEG_Y, DVec3::Z);
    let mut scene = star(LightShape::Rect { position: POSITION, direction, up, size: [1.0, 0.6].into(), texture });
    let rgba = (0..16).map(|i| [if i % 3 == 0 { 255 } else { 40 }; 4]).collect();
    scene.textures = vec![Texture { name: "light".into(), width: 4, height: 4, rgba, sampling: Sampling::default() }];
    scene
}

#[test]
fn every_view_shows_something_and_changes_no_shadow() {
    let gpu = gpu();
    let direction = DVec3::new(0.2, -1.0, 0.1).normalize();
    let line = LightShape::Line { from: POSITION, to: POSITION + DVec3::X };
    let sun = LightShape::Directional { direction, angle_deg: 6.0 };
    let names = find("wedges").unwrap().views;
    assert!(names.len() >= 5, "{names:?}");
    for scene in [ball(), rect(None), rect(Some(0)), star(line), star(sun)] {
        let what = &scene.lights[0].shape;
        let (nothing, plain) = picture(&gpu, &scene, "", None);
        assert!(nothing.is_none());
        for name in names {
            let (seen, visibility) = picture(&gpu, &scene, "", Some(name));
            let seen = seen.unwrap();
            let differ = seen.data.iter().filter(|p| **p != seen.data[0]).count();
            assert!(differ > 200, "{name}, {what:?}: all but {differ} pixels are {:?}", seen.data[0]);
            assert_eq!(visibility, plain, "{name}, {what:?}");
        }
    }
}

#[test]
fn views_of_nothing_are_drawn_too() {
    let gpu = gpu();
    let mut hard = star(LightShape::Point { position: POSITION });
    for name in find("wedges").unwrap().views {
        picture(&gpu, &hard, "", Some(name));
    }
    hard.instances.iter_mut().for_each(|i| i.casts = false);
    for name in find("wedges").unwrap().views {
        let (_, visibility) = picture(&gpu, &hard, "", Some(name));
        assert!(visibility.data.iter().all(|v| *v == 1.0), "{name}");
    }
    hard.instances.clear();
    for name in find("wedges").unwrap().views {
        picture(&gpu, &hard, "", Some(name));
    }
}

/// Colours say what visibility says.
#[test]
fn penumbras_and_corrections_are_where_the_light_is_partly_hidden() {
    let gpu = gpu();
    let (seen, visibility) = picture(&gpu, &ball(), "", Some("penumbra"));
    let seen = seen.unwrap();
    let is_penumbra = |p: &[u8; 4]| p[0] > 150 && p[2] < 80;
    let is_umbra = |p: &[u8; 4]| p[2] > 100 && p[0] < 40;
    let both = || seen.data.iter().zip(&visibility.data);
    let partly = both().filter(|(_, v)| **v > 0.01 && **v < 0.99).count();
    let shown = both().filter(|(p, v)| **v > 0.01 && **v < 0.99 && is_penumbra(p)).count();
    let dark = both().filter(|(_, v)| **v == 0.0).count();
    let umbra = both().filter(|(p, v)| **v == 0.0 && (is_umbra(p) || is_penumbra(p))).count();
    println!("{shown} of {partly} partly lit, {umbra} of {dark} dark");
    assert!(partly > 500 && shown == partly, "{shown} of {partly}");
    assert!(umbra == dark, "{umbra} of {dark}");
    let (seen, hard) = (picture(&gpu, &ball(), "", Some("correction")).0.unwrap(), hard());
    // Where the hard shadow is too dark light is added, where it is too bright taken.
    let mut wrong = 0;
    for ((p, soft), hard) in seen.data.iter().zip(&visibility.data).zip(&hard.data) {
        let (is_blue, is_red) = (p[2] > p[0].saturating_add(8), p[0] > p[2].saturating_add(8));
        let (added, taken) = (soft - hard > 0.05, hard - soft > 0.05);
        wrong += u32::from((added && !is_blue) || (taken && !is_red));
    }
    assert_eq!(wrong, 0);
}

fn hard() -> Image<f32> {
    picture(&gpu(), &star(LightShape::Point { position: POSITION }), "", None).1
}

/// The numbers behind colours of `heat` in `inspect.wgsl`, added up.
fn heat(picture: &Image<[u8; 4]>) -> f64 {
    let number = |[r, g, ..]: [u8; 4]| {
        let [r, g] = [r, g].map(|c| f64::from(c) / 255.0);
        65_f64.powf(if g > 0.0 { (g + 0.55) / 1.9 } else { r / 2.6 }) - 1.0
    };
    picture.data.iter().map(|p| number(*p)).sum()
}

/// A body whose edges are short against its penumbra, against the same where every wedge is drawn
/// by itself. How many find each other goes by the order of the list, which no two runs share.
#[test]
fn wedges_close_together_are_drawn_as_one() {
    let gpu = gpu();
    let (direction, up) = (DVec3::new(0.2, -1.0, 0.1).normalize(), DVec3::Z);
    let lights = [
        LightShape::Sphere { position: POSITION, radius: 0.5 },
        LightShape::Disc { position: POSITION, direction, radius: 0.5 },
        LightShape::Rect { position: POSITION, direction, up, size: [1.0, 0.6].into(), texture: None },
        LightShape::Line { from: POSITION, to: POSITION + DVec3::X },
        LightShape::Directional { direction, angle_deg: 30.0 },
    ];
    for light in lights {
        let what = format!("{light:?}");
        let mut scene = star(light);
        scene.meshes[1] = primitive::sphere(96, 64);
        let (together, visibility) = picture(&gpu, &scene, "", Some("fragments"));
        let (each, want) = picture(&gpu, &scene, "cull=stencil", Some("fragments"));
        let (together, each) = (heat(&together.unwrap()), heat(&each.unwrap()));
        let off: f64 = visibility.data.iter().zip(&want.data).map(|(a, b)| f64::from((a - b).abs())).sum();
        let off = off / want.data.len() as f64;
        println!("{what}: {together:.0} fragments of {each:.0}, off by {off:.1e}");
        assert!(together < 0.8 * each, "{what}: {together:.0} fragments of {each:.0}");
        assert!(off < 1e-5, "{what}: {off:.1e}");
    }
}

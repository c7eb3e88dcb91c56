//! Casters that change: pictures are those of a scene made anew, and misuse is an error.

mod host_drawn;
mod lending;
mod lending_errors;
mod misuse;
mod random;

use crate::common::{gpu, scene};
use random::{World, start};
use umbrage::core::glam::DVec3;
use umbrage::core::{Image, Light, LightKind, LightShape, Scene};
use umbrage::{Gpu, techniques};
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (64, 48);

fn shape(kind: LightKind) -> Option<LightShape> {
    let (position, direction) = (DVec3::new(-2.2, 5.2, 2.4), DVec3::new(0.4, -0.8, -0.3).normalize());
    Some(match kind {
        LightKind::Point => LightShape::Point { position },
        LightKind::Directional => LightShape::Directional { direction, angle_deg: 0.0 },
        LightKind::Sphere => LightShape::Sphere { position, radius: 0.35 },
        LightKind::Line => LightShape::Line { from: position, to: position + DVec3::X },
        _ => return None,
    })
}

/// Every technique with two kinds of light that it can do, each with a light of its own.
fn passes(gpu: &Gpu, scene: &mut Scene) -> Vec<(String, LightPass)> {
    scene.lights.clear();
    let mut passes = Vec::new();
    for info in techniques() {
        let set: &[_] = if info.family.has_maps() { &[("size".into(), "128".into())] } else { &[] };
        let wanted = [LightKind::Sphere, LightKind::Directional, LightKind::Point, LightKind::Line];
        let shapes = wanted.into_iter().filter(|kind| info.lights.contains(*kind)).filter_map(shape);
        for shape in shapes.take(2) {
            let name = format!("{} under {shape:?}", info.id);
            let technique = info.settings(set).unwrap().make(gpu).unwrap();
            passes.push((name, LightPass { light: scene.lights.len(), technique }));
            scene.lights.push(Light::new(shape));
        }
    }
    passes
}

struct Drawn {
    renderer: Renderer,
    names: Vec<String>,
}

impl Drawn {
    fn new(gpu: &Gpu, mut scene: Scene) -> Self {
        let (names, passes) = passes(gpu, &mut scene).into_iter().unzip();
        Self { renderer: Renderer::new(gpu, &scene, SIZE.0, SIZE.1, passes).unwrap(), names }
    }

    fn frame(&mut self, scene: &Scene) -> Vec<Image<f32>> {
        self.renderer.frame(&scene.camera).unwrap();
        (0..self.names.len()).map(|pass| self.renderer.visibility(pass).unwrap()).collect()
    }
}

fn assert_same(changed: &mut Drawn, scene: &Scene, what: &str) -> Vec<Image<f32>> {
    let now = changed.frame(scene);
    let anew = Drawn::new(&gpu(), scene.clone()).frame(scene);
    let differ = |(a, b): (&Image<f32>, &Image<f32>)| a.data.iter().zip(&b.data).filter(|(a, b)| a != b).count();
    let off = changed.names.iter().zip(now.iter().zip(&anew)).map(|(name, pair)| (name, differ(pair)));
    let off: Vec<String> =
        off.filter(|(_, pixels)| *pixels > 0).map(|(name, n)| format!("{name}: {n} pixels")).collect();
    assert!(off.is_empty(), "{what}: other than a scene made anew:\n{}", off.join("\n"));
    now
}

/// Every kind of change, in any order, with frames between that fill what is kept.
#[test]
fn a_changed_scene_is_a_scene_made_anew_for_every_technique() {
    let gpu = gpu();
    let scene = start(scene("tentacles", 0.1));
    let mut changed = Drawn::new(&gpu, scene.clone());
    let mut world = World::new(scene, changed.renderer.casters(), 11);
    changed.frame(&world.result());
    for _ in 0..16 {
        for _ in 0..5 {
            world.change(changed.renderer.casters_mut());
        }
        changed.renderer.frame(&world.scene.camera).unwrap();
    }
    let seen = assert_same(&mut changed, &world.result(), "after 80 changes");
    let is_dark = |image: &Image<f32>| image.data.iter().any(|v| *v < 0.5);
    let lit: Vec<_> = changed.names.iter().zip(&seen).filter(|(_, image)| !is_dark(image)).map(|(n, _)| n).collect();
    assert!(lit.iter().all(|name| name.starts_with("none")), "nothing is in shadow: {lit:?}");
    // Everything goes, and comes again.
    while world.count() > 0 {
        let last = world.count() - 1;
        world.remove(changed.renderer.casters_mut(), last);
    }
    assert!(changed.renderer.casters().is_empty());
    assert_same(&mut changed, &world.result(), "without anything");
    for _ in 0..40 {
        world.change(changed.renderer.casters_mut());
    }
    assert_same(&mut changed, &world.result(), "grown from nothing");
}

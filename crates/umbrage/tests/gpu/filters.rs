//! What holds for every technique that filters maps, those of the registry to come included.

use crate::common::{against_truth, gpu, mask, pairs, renderer, scene, visibility};
use crate::shared_references::{self, size, stored};
use umbrage::core::glam::{DMat3, DVec2, DVec3, Vec3};
use umbrage::core::{Image, Light, LightShape, Mesh, Scene};
use umbrage::{Gpu, ParamKind, Registry, TechniqueInfo, techniques};
use umbrage_io::stored::StoredReference;
use umbrage_metrics::{TOLERANCE, interior, map_reach};
use umbrage_reference::{Options, Tracer};
use umbrage_renderer::Renderer;

const SMALL: (u32, u32) = (64, 48);

/// All techniques that filter something with texels: maps, and textures of planes.
fn filters() -> impl Iterator<Item = &'static TechniqueInfo> {
    techniques().iter().copied().filter(|info| info.params().iter().any(|p| p.name == "size"))
}

/// Those that make penumbrae as wide as the light does, and none where it has no width; with their
/// settings.
const FOLLOW_THE_LIGHT: [(&str, &str); 3] = [("pcss", ""), ("pcss-jitter", ""), ("smoothies", "samples=1")];

/// All of them as they are by themselves, and those that can follow the light doing
/// so.
fn variants() -> impl Iterator<Item = (&'static TechniqueInfo, &'static str)> {
    let follows = |info: &TechniqueInfo| info.params().iter().any(|p| p.name == "softness");
    filters().flat_map(move |info| [(info, "")].into_iter().chain(follows(info).then_some((info, "softness=light"))))
}

/// Settings together.
fn joined(a: &str, b: &str) -> String {
    if a.is_empty() || b.is_empty() { format!("{a}{b}") } else { format!("{a},{b}") }
}

/// Shapes on a floor under one light.
fn under(shape: LightShape) -> Scene {
    Scene { lights: vec![Light::new(shape)], ..scene("primitives", 0.3) }
}

/// A light of every soft kind around a point or, from there, in a direction, as wide as `size`
/// metres or radians.
fn soft(position: DVec3, size: f64) -> Vec<LightShape> {
    let direction = DVec3::new(-0.3, -0.9, -0.2).normalize();
    let up = direction.any_orthonormal_vector();
    let rect = |size| LightShape::Rect { position, direction, up, size, texture: None };
    let rotation = DMat3::from_rotation_x(0.5);
    vec![
        LightShape::Sphere { position, radius: 0.5 * size },
        LightShape::Ellipsoid { position, radii: DVec3::new(0.2, 0.4, 0.5) * size, rotation },
        LightShape::Disc { position, direction, radius: 0.5 * size },
        rect(DVec2::splat(size)),
        LightShape::Line { from: position - up * 0.5 * size, to: position + up * 0.5 * size },
        LightShape::Directional { direction, angle_deg: size.to_degrees().min(179.0) },
    ]
}

const ABOVE: DVec3 = DVec3::new(1.9, 3.6, 1.7);

/// Lights that no scene should have but some will, with what is odd about them.
fn odd_lights() -> Vec<(&'static str, LightShape)> {
    let mut lights = Vec::new();
    let mut add = |what, shapes: Vec<LightShape>| lights.extend(shapes.into_iter().map(|shape| (what, shape)));
    let ball = DVec3::new(0.15, 0.62, -0.1);
    for (what, position) in [
        ("inside a caster", ball),
        ("a micrometre above a caster", ball + DVec3::Y * 0.620_001),
        ("on a caster", DVec3::new(-1.3, 0.7, 0.75)),
        ("on the floor", DVec3::new(1.0, 0.0, 2.5)),
        ("below the floor", DVec3::new(0.0, -1.0, 0.0)),
        ("at the eye", DVec3::new(-1.2, 3.4, 6.4)),
        ("far away", DVec3::new(1e6, 3e6, 0.0)),
    ] {
        add(what, vec![LightShape::Point { position }]);
        add(what, soft(position, 0.4));
    }
    add("without extent", soft(ABOVE, 0.0));
    add("narrow", soft(ABOVE, 1e-7));
    add("larger than the scene", soft(ABOVE, 100.0));
    let (position, direction) = (ABOVE, DVec3::new(-0.5, -1.0, -0.5).normalize());
    for size in [DVec2::new(0.0, 0.4), DVec2::new(0.4, 0.0), DVec2::new(1e-6, 30.0)] {
        add(
            "flat",
            vec![LightShape::Rect { position, direction, up: direction.any_orthonormal_vector(), size, texture: None }],
        );
    }
    for radii in [DVec3::new(0.0, 0.2, 0.4), DVec3::new(0.0, 0.0, 0.5), DVec3::new(0.3, 0.0, 1e-9)] {
        add("flat", vec![LightShape::Ellipsoid { position, radii, rotation: DMat3::IDENTITY }]);
    }
    for outer_angle_deg in [0.01, 5.0, 89.9] {
        add("with a cone", vec![LightShape::Spot { position, direction, inner_angle_deg: 0.0, outer_angle_deg }]);
    }
    add("along the floor", vec![LightShape::Directional { direction: DVec3::X, angle_deg: 3.0 }]);
    lights
}

/// What is wrong with a picture of visibility, if anything.
fn fault(seen: &Image<f32>) -> Option<String> {
    let wrong = |v: &f32| !(0.0..=1.0).contains(v);
    let count = seen.data.iter().filter(|v| wrong(v)).count();
    seen.data.iter().find(|v| wrong(v)).map(|first| format!("{count} pixels such as {first}"))
}

/// Runs all lights through one renderer, so that kinds of light follow each other in it.
fn faults(renderer: &mut Renderer, scene: &Scene, lights: &[(&str, LightShape)], info: &TechniqueInfo) -> Vec<String> {
    let mut faults = Vec::new();
    for (what, shape) in lights.iter().filter(|(_, shape)| info.lights.contains(shape.kind())) {
        renderer.light_mut(0).unwrap().shape = shape.clone();
        if let Some(fault) = fault(&visibility(renderer, scene)) {
            faults.push(format!("{}: {} {what}: {fault}", info.id, shape.kind().name()));
        }
    }
    faults
}

fn no_faults(faults: Vec<String>) {
    assert!(faults.is_empty(), "{}:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn odd_lights_give_shares() {
    let gpu = gpu();
    let lights = odd_lights();
    let scene = under(lights[0].1.clone());
    let mut all = Vec::new();
    for (info, variant) in variants() {
        let focuses = info.params().iter().any(|p| p.name == "focus").then_some("size=256,focus=light");
        for set in ["size=256", "size=1"].into_iter().chain(focuses) {
            let set = joined(set, variant);
            all.extend(faults(&mut renderer(&gpu, &scene, 0, info.id, &set, SMALL), &scene, &lights, info));
        }
    }
    no_faults(all);
}

/// The ends of every parameter's range and all its words, one at a time.
fn extreme_settings(info: &TechniqueInfo) -> Vec<String> {
    let of = |kind: ParamKind| match kind {
        ParamKind::Int { min, max, .. } => vec![min.to_string(), max.to_string()],
        ParamKind::Float { min, max, .. } => vec![min.to_string(), max.to_string()],
        ParamKind::Choice { .. } | ParamKind::Filter { .. } => {
            kind.words(&Registry::default()).into_iter().map(String::from).collect()
        }
        ParamKind::Switch { .. } => vec!["on".into(), "off".into()],
    };
    let sized = info.params().iter().filter(|p| p.name != "size");
    let one = sized.flat_map(|p| of(p.kind).into_iter().map(|value| format!("size=128,{}={value}", p.name)));
    one.chain(["size=1".into(), "size=2".into(), "size=3".into(), "size=129".into()]).collect()
}

#[test]
fn the_ends_of_all_parameters_give_shares() {
    let gpu = gpu();
    // A round one, a flat one with axes of its own, and a parallel one.
    let lights: Vec<_> = soft(ABOVE, 0.6).into_iter().skip(1).step_by(2).map(|shape| ("above", shape)).collect();
    let scene = under(lights[0].1.clone());
    let mut all = Vec::new();
    for info in filters() {
        for set in extreme_settings(info) {
            let found = faults(&mut renderer(&gpu, &scene, 0, info.id, &set, (32, 24)), &scene, &lights, info);
            all.extend(found.into_iter().map(|fault| format!("{set} {fault}")));
        }
    }
    no_faults(all);
}

#[test]
fn a_map_that_is_too_large_is_an_error_that_says_how_large_it_may_be() {
    let gpu = gpu();
    let limit = i64::from(gpu.device.limits().max_texture_dimension_2d);
    for info in filters() {
        let size = info.params().iter().find(|p| p.name == "size").unwrap();
        let ParamKind::Int { max, .. } = size.kind else { panic!("{}: size is no whole number", info.id) };
        let largest = max.min(limit);
        let set = pairs(&format!("size={}", largest + 1));
        let error = info.settings(&set).and_then(|settings| settings.make(&gpu)).err().expect("an error");
        assert!(error.to_string().contains(&largest.to_string()), "{}: {error}", info.id);
    }
}

#[test]
fn scenes_without_shadows_are_lit() {
    let gpu = gpu();
    let full = under(LightShape::Point { position: ABOVE });
    let empty = Scene { instances: Vec::new(), ..full.clone() };
    // One triangle whose corners are one point, or on a line, above the floor.
    let degenerate = |corners: [Vec3; 3]| {
        let mesh = Mesh { positions: corners.to_vec(), indices: vec![0, 1, 2], ..Mesh::default() };
        let mut scene = full.clone();
        scene.instances.truncate(1);
        let mesh = scene.add_mesh(mesh);
        scene.place(mesh, 0, Default::default());
        scene
    };
    let point = degenerate([Vec3::Y; 3]);
    let line = degenerate([Vec3::Y, Vec3::new(0.5, 1.0, 0.0), Vec3::new(1.0, 1.0, 0.0)]);
    let lights: Vec<_> = soft(ABOVE, 0.4).into_iter().chain([full.lights[0].shape.clone()]).collect();
    let mut wrong = Vec::new();
    for (info, variant) in variants() {
        for (what, scene) in [("nothing", &empty), ("a point", &point), ("a line", &line)] {
            let mut renderer = renderer(&gpu, scene, 0, info.id, &joined("size=256", variant), SMALL);
            for shape in lights.iter().filter(|shape| info.lights.contains(shape.kind())) {
                renderer.light_mut(0).unwrap().shape = shape.clone();
                let seen = visibility(&mut renderer, scene);
                let lowest = seen.data.iter().copied().fold(f32::INFINITY, f32::min);
                if fault(&seen).is_some() || lowest < 0.98 {
                    wrong.push(format!("{} {variant}: {what} under a {}: {lowest}", info.id, shape.kind().name()));
                }
            }
        }
    }
    no_faults(wrong);
}

#[test]
fn lights_without_extent_throw_hard_shadows() {
    let gpu = gpu();
    let (set, size) = ("size=4096", (320, 240));
    let mut wrong = Vec::new();
    for shape in soft(ABOVE, 0.0) {
        let scene = under(shape);
        let kind = scene.lights[0].shape.kind().name();
        let of = |id: &str, set: &str| visibility(&mut renderer(&gpu, &scene, 0, id, set, size), &scene);
        let hard = of("shadow-map", set);
        assert!(hard.data.iter().filter(|v| **v == 0.0).count() > 1000, "{kind}: hardly a shadow");
        // Maps of other techniques have other borders, so that their texels cut edges elsewhere: by
        // about as much as the hard shadow map itself is off the truth.
        let limit = 1.5 * against_truth(&gpu, &scene, 0, "shadow-map", set, size, 1).mae;
        for (id, variant) in FOLLOW_THE_LIGHT {
            let off: f64 =
                of(id, &joined(set, variant)).data.iter().zip(&hard.data).map(|(a, b)| f64::from((a - b).abs())).sum();
            let mae = off / hard.data.len() as f64;
            let row = format!("{id:12} {kind:12} mae against the hard shadow {mae:.6}, at most {limit:.6}");
            println!("{row}");
            if !(mae <= limit && limit < 5e-4) {
                wrong.push(row);
            }
        }
    }
    no_faults(wrong);
}

/// Mean visibility of what is dark and of what is lit in truth, far from all edges.
struct Means {
    dark: f64,
    lit: f64,
}

/// Pixels that are so far from edges that filters of a fixed width do not get there with their
/// defaults: 8 texels, as seen on the screen, and 8 pixels.
fn far(reference: &Image<f32>, mask: &Image<bool>, two_texels: &Image<f32>) -> Image<bool> {
    interior(reference, mask, Some(&two_texels.map(|r| (4.0 * r).max(8.0))))
}

/// Means of one technique with maps of several sizes over the pixels that are far from edges for
/// the first of them.
fn means(gpu: &Gpu, scene: &Scene, light: usize, (id, variant): (&str, &str), sizes: [u32; 2]) -> [Means; 2] {
    let (width, height) = (320, 240);
    let tracer = Tracer::new(scene);
    let geometry = tracer.geometry(&scene.camera, width, height);
    let options = Options { samples: 32, ..Options::default() };
    let truth = tracer.visibility(&geometry, &scene.lights[light], &scene.textures, &options, &|_, _| ());
    let mask = mask(&truth, &geometry, 60.0);
    let mut counted = None;
    sizes.map(|map| {
        let mut renderer = renderer(gpu, scene, light, id, &joined(&format!("size={map}"), variant), (width, height));
        let seen = visibility(&mut renderer, scene);
        let counted: &Image<bool> = counted.get_or_insert_with(|| {
            let technique = renderer.technique(0).unwrap();
            let reach = map_reach(
                technique.inside().light_views(),
                technique.inside().split_distances(),
                &scene.camera,
                &geometry.depth,
                &geometry.normal,
            );
            far(&truth.visibility, &mask, &reach)
        });
        let mean = |value: f32| {
            let of = |i: &usize| counted.data[*i] && truth.visibility.data[*i] == value;
            let some: Vec<usize> = (0..seen.data.len()).filter(of).collect();
            assert!(some.len() > 200, "{}: only {} pixels of {value} are far from edges", scene.name, some.len());
            some.iter().map(|i| f64::from(seen.data[*i])).sum::<f64>() / some.len() as f64
        };
        Means { dark: mean(0.0), lit: mean(1.0) }
    })
}

#[test]
fn what_is_far_from_edges_does_not_depend_on_the_size_of_the_map() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    for (id, light) in [("primitives", 1), ("overlap", 0)] {
        let scene = scene(id, 1.0);
        for (info, variant) in variants().filter(|(info, _)| info.lights.contains(scene.lights[light].shape.kind())) {
            let [small, large] = means(&gpu, &scene, light, (info.id, variant), [512, 4096]);
            let row = format!(
                "{id:12} {:12} {variant} dark {:.4} → {:.4}, lit {:.4} → {:.4}",
                info.id, small.dark, large.dark, small.lit, large.lit
            );
            println!("{row}");
            if !((small.dark - large.dark).abs() < 0.01 && (small.lit - large.lit).abs() < 0.01) {
                wrong.push(row);
            }
        }
    }
    no_faults(wrong);
}

/// With the settings that it has by itself: mean absolute error, percentages correct among interior
/// pixels and among those that are [`far`].
fn scores(gpu: &Gpu, scene: &Scene, light: usize, (id, variant): (&str, &str), stored: &StoredReference) -> [f64; 3] {
    let mut renderer = renderer(gpu, scene, light, id, variant, size(stored));
    let produced = visibility(&mut renderer, scene);
    let technique = renderer.technique(0).unwrap();
    let reach = map_reach(
        technique.inside().light_views(),
        technique.inside().split_distances(),
        &scene.camera,
        &stored.depth,
        &stored.normal.map(|n| (*n).into()),
    );
    let (reference, mask) = (&stored.visibility, shared_references::mask(stored));
    // What is not a number is off by 1.
    let off = |i: usize| f64::from(1.0_f32.min((produced.data[i] - reference.data[i]).abs()));
    let mean = |pixels: &Image<bool>, of: &dyn Fn(usize) -> f64| {
        let some: Vec<f64> = (0..pixels.data.len()).filter(|i| pixels.data[*i]).map(of).collect();
        some.iter().sum::<f64>() / some.len() as f64
    };
    let percent = |pixels: &Image<bool>| mean(pixels, &|i| if off(i) <= TOLERANCE { 100.0 } else { 0.0 });
    let interior = interior(reference, &mask, Some(&reach));
    [mean(&mask, &off), percent(&interior), percent(&far(reference, &mask, &reach))]
}

/// Where a method's own limit keeps its interior below what all others reach: picture, technique,
/// what it has at least. City: a texel is 0.4 m, and the filter some of them. Overlap: two layers,
/// of which a map has one. Line: a light without width, so that a tap sees it or does not.
const LIMITS: &[(&str, &str, f64)] = &[
    ("overlap", "evsm softness=light", 98.0),
    ("boxes-line", "evsm softness=light", 99.1),
    ("city", "pcf", 97.0),
    // Texels are 20 pixels across, and where their borders fall moves a point of it.
    ("city", "pcf-jitter", 89.0),
    ("city", "pcf-blur", 96.9),
    ("city", "smoothies", 99.5),
    ("overlap", "pcss", 98.0),
    ("overlap", "pcss-jitter", 97.9),
    ("boxes-line", "pcss", 99.4),
    ("boxes-line", "pcss-jitter", 99.5),
];

/// Interior that a technique has to reach on a picture, per cent.
fn least_interior(picture: &str, id: &str, variant: &str) -> f64 {
    let id = format!("{id} {variant}");
    LIMITS
        .iter()
        .find(|(name, technique, _)| *name == picture && *technique == id.trim())
        .map_or(99.7, |(_, _, least)| *least)
}

#[test]
#[ignore = "needs the shared references"]
fn filters_have_neither_acne_nor_leaks() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    for (name, light, scene, stored) in stored(|_, _| true) {
        let kind = scene.lights[light].shape.kind();
        // Textures of planes say nothing of what is not flat.
        let with_maps = variants().filter(|(info, _)| info.views.contains(&"map-0"));
        for (info, variant) in with_maps.filter(|(info, _)| info.lights.contains(kind)) {
            let [mae, inside, far] = scores(&gpu, &scene, light, (info.id, variant), &stored);
            let what = format!("{name:18} {:12} {:12} {variant}", kind.name(), info.id);
            let row = format!("{what} mae {mae:.5}, interior {inside:.3} %, far {far:.3} %");
            println!("{row}");
            if inside.is_nan() || inside < least_interior(&name, info.id, variant) {
                wrong.push(row);
            }
        }
    }
    no_faults(wrong);
}

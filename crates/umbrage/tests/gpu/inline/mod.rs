//! Look-ups in a host's own shader say what the full-screen passes of the same techniques say.

mod forward;

use crate::common::{gpu, pairs};
use forward::{Frame, Host, NOTHING};
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Bounds, Camera, Image, Light, LightShape, Material, Scene, primitive};
use umbrage::{Error, Followed, Gpu, Inline, Lent, Technique, TechniqueInfo, find, techniques};
use umbrage_reference::Tracer;

/// A floor, a cube, a sphere above it, a card that leans, all around `origin`.
fn scene(origin: DVec3) -> Scene {
    let mut scene = Scene::default();
    let material = scene.add_material(Material::default());
    let meshes = [primitive::plane(), primitive::cube(), primitive::sphere(16, 8)].map(|mesh| scene.add_mesh(mesh));
    let mut put = |mesh: usize, place: DAffine3| {
        scene.place(meshes[mesh], material, DAffine3::from_translation(origin) * place);
    };
    put(0, DAffine3::from_scale(DVec3::splat(8.0)));
    put(1, DAffine3::from_translation(DVec3::new(0.7, 1.0, 0.0)));
    put(2, DAffine3::from_translation(DVec3::new(-2.0, 1.6, 0.5)));
    put(0, DAffine3::from_translation(DVec3::new(2.6, 1.0, 1.5)) * DAffine3::from_rotation_z(1.1));
    scene
}

fn camera(origin: DVec3) -> Camera {
    Camera { eye: origin + DVec3::new(0.5, 4.5, 6.5), target: origin + DVec3::new(0.0, 0.6, 0.0), ..Camera::default() }
}

/// One light of each kind that maps differ for.
fn lights(origin: DVec3) -> [(&'static str, Light); 4] {
    let position = origin + DVec3::new(1.5, 5.0, 2.5);
    let direction = DVec3::new(-0.4, -1.0, -0.3).normalize();
    [
        ("sun", LightShape::Directional { direction, angle_deg: 1.0 }),
        ("spot", LightShape::Spot { position, direction, inner_angle_deg: 50.0, outer_angle_deg: 60.0 }),
        ("point", LightShape::Point { position: origin + DVec3::new(0.0, 2.8, 2.0) }),
        ("sphere", LightShape::Sphere { position, radius: 0.3 }),
    ]
    .map(|(name, shape)| (name, Light::new(shape)))
}

/// The look-up of the one light there is.
fn one(gpu: &Gpu, mut lent: Vec<Lent>) -> Inline {
    Inline::new(gpu, lent.remove(0), 1, "sun").unwrap()
}

/// What a host's shader calls.
const CALL: &str = "sun_visibility(in.position, normal_of(in))";

/// A device that asked for nothing.
fn plain_gpu() -> Gpu {
    let (device, queue) = pollster::block_on(async {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = instance.request_adapter(&Default::default()).await.unwrap();
        adapter.request_device(&Default::default()).await.unwrap()
    });
    Gpu::new(device, queue)
}

fn make(gpu: &Gpu, id: &str, set: &str) -> Box<dyn Technique> {
    find(id).unwrap().settings(&pairs(set)).unwrap().make(gpu).unwrap()
}

/// How two pictures differ: on the mean, and the share of pixels that differ by more than 0.001.
struct Difference {
    mean: f64,
    apart: f64,
}

fn difference(a: &Image<f32>, b: &Image<f32>) -> Difference {
    let pairs = || a.data.iter().zip(&b.data).filter(|(_, b)| **b != NOTHING);
    assert!(pairs().all(|(_, b)| (-1e-5..=1.00001).contains(b)), "shares from 0 to 1");
    let count = pairs().count() as f64;
    assert!(count > 2000.0, "{count} pixels");
    let mean = pairs().map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / count;
    let apart = pairs().filter(|(a, b)| (*a - *b).abs() > 1e-3).count() as f64 / count;
    Difference { mean, apart }
}

/// Compares one technique's two answers about a light.
fn compare(host: &mut Host, camera: &Camera, light: &Light, technique: &mut Box<dyn Technique>) -> (Difference, f64) {
    let Frame { full_screen, inline, .. } = host.frame(camera, &mut [(light, technique)], one, CALL);
    let seen = &full_screen[0];
    let shadow = seen.data.iter().filter(|share| **share < 0.5).count() as f64 / seen.data.len() as f64;
    (difference(seen, &inline), shadow)
}

/// Every technique that lends, and what it is set to.
fn settings() -> Vec<(&'static str, &'static str)> {
    // What a filter makes of the look-up's pixels afterwards is not in a host's shader.
    let is_denoised = |info: &TechniqueInfo| info.params().iter().any(|param| param.name == "denoise");
    let plain = |info: &TechniqueInfo| if is_denoised(info) { "size=256,denoise=off" } else { "size=256" };
    let all = techniques().iter().filter(|info| info.is_lent()).map(|info| (info.id, plain(info)));
    let more = [
        ("pcf", "size=256,kernel=disc"),
        ("pcf", "size=256,kernel=bicubic"),
        ("evsm", "size=256,softness=light"),
        ("cascaded", "size=256,filter=vsm,stabilize=true"),
        ("cascaded", "size=256,depth-fit=true,blend=dither"),
        ("psm", "size=256,filter=msm"),
    ];
    all.filter(|(id, _)| *id != "none").chain(more).collect()
}

#[test]
fn the_answer_is_that_of_the_full_screen_pass() {
    let gpu = gpu();
    let origin = DVec3::ZERO;
    let mut host = Host::new(&gpu, &scene(origin));
    let mut wrong = Vec::new();
    for (id, set) in settings() {
        let mut technique = make(&gpu, id, set);
        for (name, light) in lights(origin) {
            let (Difference { mean, apart }, shadow) = compare(&mut host, &camera(origin), &light, &mut technique);
            // Where corners are snapped, what is interpolated and what depth says are apart by up
            // to a sixteenth of a pixel.
            let most_apart = if gpu.snapping() < 0.01 { 1e-3 } else { 0.05 };
            if !(mean <= 1e-3 && apart <= most_apart && shadow > 0.02) {
                wrong.push(format!("{id}:{set} {name}: {mean:.6}, {apart:.5} apart, {shadow:.3} in shadow"));
            }
        }
    }
    assert_eq!(wrong, [""; 0]);
}

#[test]
fn far_from_the_origin_nothing_changes() {
    let gpu = gpu();
    let origin = DVec3::new(1e7, 0.0, -1e7);
    let mut host = Host::new(&gpu, &scene(origin));
    for (id, set) in [("pcf", "size=256"), ("cascaded", "size=256"), ("pcss-jitter", "size=256,denoise=off")] {
        let mut technique = make(&gpu, id, set);
        for (name, light) in lights(origin) {
            let (Difference { mean, .. }, shadow) = compare(&mut host, &camera(origin), &light, &mut technique);
            assert!(mean <= 1e-3 && shadow > 0.02, "{id}:{set} {name}: {mean:.6}");
        }
    }
}

#[test]
fn several_lights_are_one_group_and_a_number() {
    let gpu = gpu();
    let mut host = Host::new(&gpu, &scene(DVec3::ZERO));
    let camera = camera(DVec3::ZERO);
    let [sun, _, point, sphere] = lights(DVec3::ZERO).map(|(_, light)| light);
    let mut techniques = ["cascaded", "vsm", "pcss"].map(|id| make(&gpu, id, "size=256"));
    for number in 0..4 {
        let [a, b, c] = &mut techniques;
        let join = |gpu: &Gpu, lent: Vec<_>| Inline::join(gpu, &lent, 1, "lights").unwrap();
        let call = format!("lights_visibility({number}u, in.position, normal_of(in))");
        let Frame { full_screen, inline, .. } =
            host.frame(&camera, &mut [(&sun, a), (&point, b), (&sphere, c)], join, &call);
        match full_screen.get(number) {
            Some(seen) => assert!(difference(seen, &inline).mean <= 1e-3, "light {number}"),
            None => assert!(inline.data.iter().all(|share| *share == 1.0 || *share == NOTHING), "no such light"),
        }
    }
}

/// The share of points in the air, `above` metres over what is seen, for which the shader and rays
/// differ.
fn wrong_in_air(host: &mut Host, camera: &Camera, light: &Light, above: f64) -> (f64, f64) {
    let mut technique = make(&host.gpu, "shadow-map", "size=1024");
    let call = format!("sun_visibility_in_air(in.position + vec3f(0.0, {above:?}, 0.0))");
    let inline = host.frame(camera, &mut [(light, &mut technique)], one, &call).inline;
    let tracer = Tracer::new(&host.scene);
    let geometry = tracer.geometry(camera, forward::SIZE.0, forward::SIZE.1);
    let (mut count, mut wrong, mut dark) = (0, 0, 0);
    for y in 0..forward::SIZE.1 {
        for x in 0..forward::SIZE.0 {
            let Some(surface) = geometry.surface(x, y).filter(|_| inline[(x, y)] != NOTHING) else { continue };
            let from = surface.position + DVec3::Y * above;
            let is_lit = !tracer.blocked(from, light.shape.center());
            count += 1;
            wrong += u32::from(is_lit != (inline[(x, y)] > 0.5));
            dark += u32::from(!is_lit);
        }
    }
    (f64::from(wrong) / f64::from(count), f64::from(dark) / f64::from(count))
}

#[test]
fn what_floats_in_the_air_is_lit_as_rays_say() {
    let gpu = gpu();
    let mut host = Host::new(&gpu, &scene(DVec3::ZERO));
    // So that maps reach as high as what floats.
    let [min, max] = [DVec3::new(-8.0, 0.0, -8.0), DVec3::new(8.0, 2.0, 8.0)];
    host.casters.receive_in(&[Bounds { min, max }]);
    for (name, light) in lights(DVec3::ZERO) {
        let (wrong, dark) = wrong_in_air(&mut host, &camera(DVec3::ZERO), &light, 0.4);
        println!("{name}: {wrong:.4} wrong, {dark:.3} dark");
        assert!(wrong < 0.015 && dark > 0.05, "{name}: {wrong:.4} wrong, {dark:.3} dark");
    }
}

#[test]
fn maps_cover_what_a_host_says_and_beyond_all_is_lit() {
    let gpu = gpu();
    // Over a small floor that a roof hides from the light.
    let mut scene = Scene::default();
    let material = scene.add_material(Material::default());
    let plane = scene.add_mesh(primitive::plane());
    scene.place(plane, material, DAffine3::from_scale(DVec3::splat(0.4)));
    scene.place(
        plane,
        material,
        DAffine3::from_translation(DVec3::new(0.0, 6.0, 0.0)) * DAffine3::from_scale(DVec3::splat(3.0)),
    );
    let sun = Light::new(LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 });
    let camera = Camera { eye: DVec3::new(0.0, 2.0, 1.6), target: DVec3::ZERO, ..Camera::default() };
    let mut host = Host::new(&gpu, &scene);
    let mut technique = make(&gpu, "pcf", "size=64");
    // A metre beside what is seen: in the roof's shadow, and on no instance.
    let mut beside = |host: &mut Host| {
        let call = "sun_visibility_in_air(in.position + vec3f(1.0, 0.0, 0.0))";
        let inline = host.frame(&camera, &mut [(&sun, &mut technique)], one, call).inline;
        let shown: Vec<f32> = inline.data.into_iter().filter(|share| *share != NOTHING).collect();
        assert!(shown.len() > 100, "{} pixels", shown.len());
        shown
    };
    assert!(beside(&mut host).iter().all(|share| *share == 1.0), "no map is there");
    host.casters.receive_in(&[Bounds { min: DVec3::new(0.5, -0.1, -0.5), max: DVec3::new(1.5, 0.1, 0.5) }]);
    assert!(beside(&mut host).iter().all(|share| *share == 0.0), "the roof's shadow");
    host.casters.receive_in(&[Bounds::EMPTY, Bounds { min: DVec3::NAN, max: DVec3::NAN }]);
    assert!(beside(&mut host).iter().all(|share| *share == 1.0), "boxes that count for nothing");
}

#[test]
fn a_pane_is_lit_from_behind_and_a_wall_is_not() {
    let gpu = gpu();
    let mut host = Host::new(&gpu, &scene(DVec3::ZERO));
    let light = &lights(DVec3::ZERO)[0].1;
    // Turned away from the sun and to the eye.
    for (function, lit) in [("visibility_of_pane", true), ("visibility", false)] {
        let mut technique = make(&gpu, "shadow-map", "size=256");
        let call = format!("sun_{function}(in.position + vec3f(0.0, 3.5, 0.0), vec3f(-0.6, -0.6, 0.5))");
        let inline = host.frame(&camera(DVec3::ZERO), &mut [(light, &mut technique)], one, &call).inline;
        let shown = inline.data.iter().filter(|share| **share != NOTHING);
        let share = shown.clone().sum::<f32>() / shown.count() as f32;
        assert_eq!(share > 0.5, lit, "{function}: {share}");
    }
}

#[test]
fn look_ups_follow_sizes_and_lights() {
    let gpu = gpu();
    let mut host = Host::new(&gpu, &scene(DVec3::ZERO));
    let camera = camera(DVec3::ZERO);
    let [sun, _, point, _] = lights(DVec3::ZERO).map(|(_, light)| light);
    let mut kept: Option<Inline> = None;
    let mut technique = make(&gpu, "pcf", "size=256");
    let larger = find("pcf").unwrap().settings(&pairs("size=300")).unwrap();
    let expected =
        [None, Some(Followed::Same), Some(Followed::BindGroup), Some(Followed::Shader), Some(Followed::Same)];
    for (light, expected) in [&sun, &sun, &sun, &point, &point].into_iter().zip(expected) {
        if expected == Some(Followed::BindGroup) {
            assert!(technique.set(&gpu, &larger).unwrap());
        }
        let mut followed = None;
        let follow = |gpu: &Gpu, lent: Vec<_>| match kept.take() {
            Some(mut kept) => {
                followed = Some(kept.follow(gpu, &lent).unwrap());
                kept
            }
            None => one(gpu, lent),
        };
        let frame = host.frame(&camera, &mut [(light, &mut technique)], follow, CALL);
        assert_eq!(followed, expected);
        assert!(difference(&frame.full_screen[0], &frame.inline).mean <= 1e-3, "{expected:?}");
        kept = Some(frame.lookups);
    }
}

#[test]
fn maps_alone_give_the_same_answer_and_without_casters_all_is_lit() {
    let gpu = gpu();
    let mut host = Host::new(&gpu, &scene(DVec3::ZERO));
    let (camera, light) = (camera(DVec3::ZERO), lights(DVec3::ZERO)[3].1.clone());
    let both = host.frame(&camera, &mut [(&light, &mut make(&gpu, "pcss", "size=256"))], one, CALL).inline;
    host.only_maps = true;
    let alone = host.frame(&camera, &mut [(&light, &mut make(&gpu, "pcss", "size=256"))], one, CALL).inline;
    assert_eq!(both, alone);
    for (id, light) in [("pcf", Light { casts: false, ..light.clone() }), ("none", light)] {
        let seen = host.frame(&camera, &mut [(&light, &mut make(&gpu, id, ""))], one, CALL).inline;
        assert!(seen.data.iter().all(|share| *share == 1.0 || *share == NOTHING), "{id}");
    }
}

#[test]
fn what_can_not_be_is_an_error_that_says_why() {
    let gpu = plain_gpu();
    let mut host = Host::new(&gpu, &scene(DVec3::ZERO));
    let light = lights(DVec3::ZERO)[3].1.clone();
    let mut lent = Vec::new();
    for id in ["pcss", "pcf"] {
        let mut technique = make(&gpu, id, "size=64");
        let keep = |gpu: &Gpu, mut of_one: Vec<Lent>| {
            lent.push(of_one[0].clone());
            Inline::new(gpu, of_one.remove(0), 1, "sun").unwrap()
        };
        let _ = host.frame(&camera(DVec3::ZERO), &mut [(&light, &mut technique)], keep, "1.0");
    }
    let error = |result: Result<Inline, Error>| result.expect_err("no look-up").to_string();
    // WebGPU promises 8 storage buffers, of which each reads two, and 12 uniform buffers.
    for (light, fit, what) in [(&lent[0], 4, "storage buffers"), (&lent[1], 12, "uniform buffers")] {
        assert!(Inline::join(&gpu, &vec![light.clone(); fit], 1, "lights").is_ok());
        let said = error(Inline::join(&gpu, &vec![light.clone(); fit + 1], 1, "lights"));
        assert!(said.contains(what) && said.starts_with(&format!("{} lights", fit + 1)), "{said}");
    }
    let said = error(Inline::new(&gpu, lent[1].clone(), 4, "sun"));
    assert!(said.contains("bind group 4"), "{said}");
    let said = error(Inline::new(&gpu, lent[1].clone(), 1, "1 sun"));
    assert!(said.contains("1 sun"), "{said}");
    let mut one = Inline::new(&gpu, lent[1].clone(), 1, "sun").unwrap();
    assert!(matches!(one.follow(&gpu, &[]), Err(Error::Inline(_))));
    assert_eq!(Inline::join(&gpu, &[], 1, "lights").unwrap().wgsl().matches("fn ").count(), 3, "no lights at all");
}

#[test]
fn techniques_without_maps_refuse_by_name() {
    let gpu = gpu();
    for info in techniques() {
        let lent = info.default_settings().make(&gpu).unwrap().lend(&gpu);
        match lent {
            Ok(_) => assert!(info.is_lent(), "{} lends", info.id),
            Err(Error::Unsupported { technique, what }) => {
                assert!(
                    !info.is_lent() && technique == info.id && what.contains("shaders of hosts"),
                    "{technique}: {what}"
                );
            }
            Err(other) => panic!("{}: {other}", info.id),
        }
    }
}

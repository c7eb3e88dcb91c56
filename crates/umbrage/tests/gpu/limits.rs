//! Devices with WebGPU's default limits and no optional feature: every technique works there, or
//! says what it lacks.

use crate::common::{gpu, pairs, scene};
use crate::wedges::difference;
use std::sync::{Arc, Mutex};
use umbrage::core::environment::{Environment, Sky};
use umbrage::core::glam::{DAffine3, DMat3, DVec2, DVec3, Vec3};
use umbrage::core::{Image, Light, LightShape, Scene, primitive};
use umbrage::{Error, Gpu, Param, ParamKind, Registry, TechniqueInfo, baseline, find, techniques};
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (96, 72);

/// Settings that take other shaders and buffers than the defaults, beside those.
const SETS: &[(&str, &str)] = &[
    ("wedges", "batch=per-loop"),
    ("wedges", "batch=per-wedge"),
    ("wedges", "batch=per-wedge,cull=shader"),
    ("wedges", "combine=max"),
    ("wedges", "cull=stencil"),
    ("wedges", "split-light=2"),
    ("wedges", "scale=1/2"),
    ("wedges", "budget-ms=5"),
    ("wedges", "coverage=table"),
    ("wedges", "unseen=on"),
    ("volume", "extrude=vertex"),
    ("volume", "extrude=cpu"),
    ("volume", "count=z-fail,counter=float"),
    ("volume", "depth-bounds=on"),
    ("cascaded", "depth-fit=on"),
    ("cascaded", "filter=evsm"),
    ("evsm", "softness=light"),
];

/// A device of a host that asked for no feature and these limits, and what the driver complains of.
fn plain(limits: wgpu::Limits) -> (Gpu, Arc<Mutex<Vec<String>>>) {
    let (device, queue) = pollster::block_on(async {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = instance.request_adapter(&Default::default()).await.unwrap();
        let descriptor = wgpu::DeviceDescriptor { required_limits: limits.clone(), ..Default::default() };
        adapter.request_device(&descriptor).await.unwrap()
    });
    assert!(device.features().is_empty() && device.limits() == limits, "{:?}", device.limits());
    let complaints = Arc::new(Mutex::new(Vec::new()));
    let kept = complaints.clone();
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| kept.lock().unwrap().push(error.to_string())));
    (Gpu::new(device, queue), complaints)
}

/// Every technique at its defaults, and [`SETS`].
fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    techniques().iter().map(|t| (t.id, "")).chain(SETS.iter().copied())
}

/// One whose light takes all that the technique has.
fn scene_for(id: &str) -> Scene {
    if id == "cascaded" { scene("city", 0.3) } else { scene("contact", 1.0) }
}

fn picture(gpu: &Gpu, scene: &Scene, id: &str, set: &str) -> Result<Image<f32>, Error> {
    let info = find(id)?;
    let technique = info.settings(&pairs(set))?.make(gpu)?;
    let mut renderer = Renderer::new(gpu, scene, SIZE.0, SIZE.1, vec![LightPass { light: 0, technique }])?;
    renderer.frame(&scene.camera)?;
    renderer.visibility(0)
}

/// Whether a text names a feature or a limit as wgpu does.
fn names_what_is_lacking(text: &str) -> bool {
    let is_feature = |word: &str| word.contains('_') && wgpu::Features::from_name(word).is_some();
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .any(|word| is_feature(word) || word.starts_with("max_"))
}

#[test]
fn every_technique_works_or_says_what_is_lacking() {
    let (full, (plain, complaints)) = (gpu(), plain(wgpu::Limits::default()));
    let mut wrong = Vec::new();
    let mut works = 0;
    for (id, set) in all() {
        let scene = scene_for(id);
        match picture(&plain, &scene, id, set) {
            Ok(seen) => {
                let off = difference(&seen, &picture(&full, &scene, id, set).unwrap());
                works += 1;
                println!("{id} {set}: off by {off:.1e}");
                if off > 2e-3 {
                    wrong.push(format!("{id} {set}: off by {off:.1e}"));
                }
            }
            Err(error) if names_what_is_lacking(&error.to_string()) => println!("{id} {set}: {error}"),
            Err(error) => wrong.push(format!("{id} {set}: {error}, which names nothing that is lacking")),
        }
        wrong.extend(complaints.lock().unwrap().drain(..).map(|text| format!("{id} {set}: {text}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(works > techniques().len(), "only {works} work");
}

/// What the renderer takes itself.
const OF_RENDERER: u32 = 2;

/// What every native device has that can do any of the work, apart from storage buffers.
fn storage_buffers(count: u32) -> wgpu::Limits {
    wgpu::Limits { max_storage_buffers_per_shader_stage: count, ..wgpu::Limits::downlevel_defaults() }
}

/// How many storage buffers a technique asks for.
fn declared(info: &TechniqueInfo) -> u32 {
    assert!(info.features.is_empty(), "{} asks for features: let its device have them here", info.id);
    let (mut needed, before) = (storage_buffers(0), storage_buffers(0));
    (info.limits)(&mut needed);
    let count = std::mem::take(&mut needed.max_storage_buffers_per_shader_stage);
    assert_eq!(needed, before, "{} asks for another limit: let its device have it here", info.id);
    count
}

/// Lights of all kinds over the scene.
pub fn lights() -> Vec<Light> {
    let (position, direction) = (DVec3::new(0.5, 3.0, 0.5), DVec3::NEG_Y);
    let shapes = [
        LightShape::Point { position },
        LightShape::Spot { position, direction, inner_angle_deg: 40.0, outer_angle_deg: 50.0 },
        LightShape::Directional { direction, angle_deg: 0.0 },
        LightShape::Directional { direction, angle_deg: 2.0 },
        LightShape::Sphere { position, radius: 0.3 },
        LightShape::Ellipsoid { position, radii: DVec3::new(0.3, 0.1, 0.2), rotation: DMat3::IDENTITY },
        LightShape::Disc { position, direction, radius: 0.3 },
        LightShape::Rect { position, direction, up: DVec3::X, size: DVec2::splat(0.5), texture: None },
        LightShape::Line { from: position, to: position + 0.5 * DVec3::X },
    ];
    shapes.map(Light::new).into()
}

/// A technique's defaults, its part of [`SETS`] and all of its choices one by one; maps are small.
fn choices(info: &TechniqueInfo) -> Vec<String> {
    let registry = Registry::default();
    let words = |param: &Param| match param.kind {
        ParamKind::Switch { .. } => vec!["on", "off"],
        kind => kind.words(&registry),
    };
    let one = |param: &Param| words(param).iter().map(|word| format!("{}={word}", param.name)).collect::<Vec<_>>();
    let sets = SETS.iter().filter(|(id, _)| *id == info.id).map(|(_, set)| (*set).to_string());
    let all = std::iter::once(String::new()).chain(sets).chain(info.params().iter().flat_map(one));
    let is_sized = info.params().iter().any(|param| param.name == "size");
    all.map(|set| if is_sized { format!("{set},size=64") } else { set }).collect()
}

/// On a device that has what the technique declares and not a bit more: the defaults under every
/// kind of light, every choice under two kinds, which take turns. With less it is refused.
#[test]
fn techniques_need_no_more_than_they_say() {
    let mut wrong = Vec::new();
    let mut scene = scene("contact", 0.3);
    scene.lights = lights();
    for info in techniques() {
        let count = declared(info);
        let (gpu, complaints) = plain(storage_buffers(count.max(OF_RENDERER)));
        let resting = LightPass { light: 0, technique: baseline::floor(&gpu) };
        let mut renderer = Renderer::new(&gpu, &scene, 24, 18, vec![resting]).unwrap();
        for (number, set) in choices(info).into_iter().enumerate() {
            let takes_turn = |light: usize| number == 0 || light % 5 == number % 5;
            for (light, of_light) in scene.lights.iter().enumerate().filter(|(light, _)| takes_turn(*light)) {
                let drawn = info.settings(&pairs(&set)).unwrap().make(&gpu).and_then(|technique| {
                    renderer.exchange(0, LightPass { light, technique })?;
                    renderer.frame(&scene.camera)?;
                    renderer.wait()
                });
                let refused = drawn.err().map(|error| error.to_string()).filter(|text| !names_what_is_lacking(text));
                let texts = refused.into_iter().chain(complaints.lock().unwrap().drain(..)).collect::<Vec<_>>();
                let of_light = of_light.shape.kind().name();
                wrong.extend(texts.iter().map(|text| format!("{} {set}, {of_light}, {count}: {text}", info.id)));
            }
        }
        if count > 0 {
            let (gpu, _) = plain(storage_buffers(count - 1));
            let error = info.default_settings().make(&gpu).map(drop).unwrap_err().to_string();
            let limit = format!("max_storage_buffers_per_shader_stage is {} and has to be {count}", count - 1);
            assert!(error.contains(&limit), "{error}");
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The smallest devices of native drivers have four storage buffers a stage.
#[test]
fn techniques_with_maps_shadow_posed_casters_on_the_smallest_devices() {
    let (full, (plain, complaints)) = (gpu(), plain(wgpu::Limits::downlevel_defaults()));
    let scene = scene("tentacles", 0.3);
    let mut works = 0;
    for info in techniques() {
        match picture(&plain, &scene, info.id, "") {
            Ok(seen) => {
                let off = difference(&seen, &picture(&full, &scene, info.id, "").unwrap());
                assert!(off < 2e-3, "{}: off by {off:.1e}", info.id);
                works += 1;
            }
            Err(error) => {
                // Those that also draw edges of casters need more.
                assert!(!info.family.has_maps() || declared(info) > 4, "{}: {error}", info.id);
                assert!(names_what_is_lacking(&error.to_string()), "{}: {error}", info.id);
            }
        }
        let complaints = std::mem::take(&mut *complaints.lock().unwrap());
        assert!(complaints.is_empty(), "{}: {}", info.id, complaints.join("\n"));
    }
    assert!(works > 10, "only {works} work");
}

/// No share of a light is an answer to a sky, and a host that asks for it is told so.
#[test]
fn techniques_of_shares_refuse_a_sky() {
    let gpu = gpu();
    let mut scene = scene("contact", 0.1);
    scene.lights = vec![Environment::new(Sky::Constant(Vec3::ONE)).light()];
    let technique = baseline::floor(&gpu);
    let mut renderer = Renderer::new(&gpu, &scene, 24, 18, vec![LightPass { light: 0, technique }]).unwrap();
    for info in techniques() {
        let technique = info.default_settings().make(&gpu).unwrap();
        let drawn = renderer.exchange(0, LightPass { light: 0, technique }).and_then(|_| renderer.frame(&scene.camera));
        let text = drawn.unwrap_err().to_string();
        assert!(text.contains("the environment"), "{}: {text}", info.id);
    }
}

/// Wedges and caps that do not fit a binding come in rounds, which leaves the picture as it is.
#[test]
fn wedges_come_in_rounds_where_bindings_are_small() {
    let scene = boxes_around_the_eye();
    let [whole, rounds] = [wgpu::Limits::default().max_storage_buffer_binding_size, 1 << 16].map(|limit| {
        let limits = wgpu::Limits { max_storage_buffer_binding_size: limit, ..Default::default() };
        let (gpu, complaints) = plain(limits);
        let pictures = ["", "split-light=2"].map(|set| picture(&gpu, &scene, "wedges", set).unwrap());
        let complaints = complaints.lock().unwrap();
        assert!(complaints.is_empty(), "{}", complaints.join("\n"));
        pictures
    });
    for (whole, rounds) in whole.iter().zip(&rounds) {
        let mean = whole.data.iter().sum::<f32>() / whole.data.len() as f32;
        assert!((0.2..0.95).contains(&mean), "{mean} is lit");
        // Sums of halves of floats in another order.
        assert!(difference(whole, rounds) < 1e-3, "{}", difference(whole, rounds));
    }
}

/// 400 boxes before, beside and behind the eye, which is in the shadow of some.
fn boxes_around_the_eye() -> Scene {
    let mut scene = scene("contact", 1.0);
    let (floor, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    scene.instances.clear();
    scene.place(floor, 0, DAffine3::from_scale(DVec3::splat(20.0)));
    for i in 0..400 {
        let (x, z) = (f64::from(i % 20) - 9.5, f64::from(i / 20) - 9.5);
        let at = DAffine3::from_translation(DVec3::new(x, 1.0 + 0.3 * (2.1 * x + z).sin(), z));
        scene.place(cube, 0, at * DAffine3::from_rotation_y(x) * DAffine3::from_scale(DVec3::splat(0.3)));
    }
    scene.camera.eye = DVec3::new(0.4, 0.3, 3.0);
    scene.camera.target = DVec3::new(0.0, 0.0, -3.0);
    scene.lights = vec![Light::new(LightShape::Sphere { position: DVec3::new(1.0, 6.0, 2.0), radius: 0.4 })];
    scene
}

/// A thousandth of WebGPU's default, for a mesh of a thousandth of ten million triangles: indices
/// of them fit a binding, and so has all that techniques with edges keep of a mesh.
#[test]
fn a_mesh_whose_indices_just_fit_a_binding_casts_the_same_shadows() {
    let scene = bumps();
    let sets = [
        ("wedges", ""),
        ("wedges", "unseen=on"),
        ("volume", ""),
        ("volume", "extrude=vertex"),
        ("volume", "count=z-fail"),
        ("silhouette-map", "size=256"),
        ("smoothies", "size=256"),
        ("linear-light", "size=256"),
    ];
    let [whole, small] = [1 << 27, 1 << 17].map(|limit| {
        let limits = wgpu::Limits { max_storage_buffer_binding_size: limit, ..Default::default() };
        let (gpu, complaints) = plain(limits);
        let pictures =
            sets.map(|(id, set)| picture(&gpu, &scene, id, set).unwrap_or_else(|e| panic!("{id} {set}: {e}")));
        let complaints = complaints.lock().unwrap();
        assert!(complaints.is_empty(), "{}", complaints.join("\n"));
        pictures
    });
    for ((id, set), (whole, small)) in sets.iter().zip(whole.iter().zip(&small)) {
        let mean = whole.data.iter().sum::<f32>() / whole.data.len() as f32;
        assert!((0.2..0.95).contains(&mean), "{id} {set}: {mean} is lit");
        let off = difference(whole, small);
        assert!(off < 1e-3, "{id} {set}: off by {off:.1e}");
    }
}

/// A sphere of 10,000 triangles above a floor, with bumps, so that there are silhouettes all over.
fn bumps() -> Scene {
    let mut scene = scene("contact", 1.0);
    let mut sphere = primitive::sphere(100, 51);
    for p in &mut sphere.positions {
        *p *= 1.0 + 0.1 * (9.0 * p.x).sin() * (8.0 * p.y).sin() * (7.0 * p.z).cos();
    }
    assert_eq!(sphere.triangle_count(), 10_000);
    scene.instances.clear();
    scene.meshes.clear();
    let (floor, sphere) = (scene.add_mesh(primitive::plane()), scene.add_mesh(sphere));
    scene.place(floor, 0, DAffine3::from_scale(DVec3::splat(20.0)));
    scene.place(sphere, 0, DAffine3::from_translation(DVec3::new(0.0, 1.2, 0.0)));
    scene.camera.eye = DVec3::new(0.4, 3.0, 5.0);
    scene.camera.target = DVec3::new(0.0, 0.5, 0.0);
    let (from, to) = (DVec3::new(0.5, 5.0, 2.0), DVec3::new(1.5, 5.0, 2.0));
    scene.lights = vec![Light::new(LightShape::Line { from, to })];
    scene
}

/// Scenes whose edges are more than the device binds at once are refused by name; maps do them.
#[test]
fn casters_beyond_a_binding_are_refused_with_the_limit_and_the_remedy() {
    let limits = wgpu::Limits { max_storage_buffer_binding_size: 1 << 16, ..Default::default() };
    let (gpu, complaints) = plain(limits);
    let scene = bumps();
    for id in ["wedges", "volume"] {
        let text = picture(&gpu, &scene, id, "").unwrap_err().to_string();
        assert!(text.contains("max_storage_buffer_binding_size") && text.contains("65536"), "{id}: {text}");
        assert!(text.contains("techniques with maps need none"), "{id}: {text}");
    }
    picture(&gpu, &scene, "pcf", "").unwrap();
    let complaints = complaints.lock().unwrap();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

//! `prt` against closed forms, against what it was baked of, and against the path tracer. Needs a
//! graphics adapter.

use umbrage::core::glam::{DAffine3, DQuat, DVec3, Vec3, Vec4};
use umbrage::core::harmonics::{self, Light, Order};
use umbrage::core::transfer::Transfer;
use umbrage::core::{Camera, Environment, Image, Material, Scene, Sky, primitive};
use umbrage::{Error, Gpu, Technique, find};
use umbrage_bake::{Settings, bake};
use umbrage_metrics::{RadianceComparison, RadianceScores, discontinuities, score_radiance};
use umbrage_reference::{PathTracer, RadianceOptions, Tracer};
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (64, 48);

/// The best adapter. Without one these tests fail and say how to get one.
fn gpu() -> Gpu {
    let chosen = std::env::var("UMBRAGE_ADAPTER").ok();
    Gpu::request(chosen.as_deref()).unwrap_or_else(|e| panic!("this test needs a graphics adapter: {e}"))
}

fn pairs(set: &str) -> Vec<(String, String)> {
    let pair = |s: &str| s.split_once('=').map(|(a, b)| (a.to_string(), b.to_string())).expect("name=value");
    set.split(',').filter(|s| !s.is_empty()).map(pair).collect()
}

fn move_instance(renderer: &mut Renderer, number: usize, world_from_mesh: &DAffine3) {
    let instance = renderer.casters().instance(number).expect("an instance of the scene");
    renderer.casters_mut().move_instance(instance, world_from_mesh).expect("a transform");
}

fn never(_: u64, _: u64) -> std::ops::ControlFlow<()> {
    std::ops::ControlFlow::Continue(())
}

fn technique(gpu: &Gpu, set: &str) -> Box<dyn Technique> {
    find("prt").unwrap().settings(&pairs(set)).unwrap().make(gpu).unwrap()
}

fn baked(technique: &dyn Technique, scene: &Scene) -> Transfer {
    let wanted = technique.wants().expect("a transfer is wanted");
    let settings = Settings {
        order: wanted.order,
        kind: wanted.kind,
        rays: wanted.rays,
        detail: wanted.detail,
        ..Settings::default()
    };
    bake(scene, &settings, &never).unwrap()
}

/// A renderer of the sky's light.
fn renderer(gpu: &Gpu, scene: &Scene, set: &str) -> Renderer {
    let mut technique = technique(gpu, set);
    let transfer = baked(&*technique, scene);
    technique.take_transfer(gpu, &transfer, scene).unwrap();
    let pass = LightPass { light: scene.lights.len(), technique };
    Renderer::new(gpu, scene, SIZE.0, SIZE.1, vec![pass]).unwrap()
}

fn radiance(renderer: &mut Renderer, camera: &Camera) -> Image<[f32; 3]> {
    renderer.frame(camera).unwrap();
    renderer.radiance(0).unwrap()
}

/// Red on one side, so that turned and mirrored pictures differ.
fn lopsided() -> Sky {
    Sky::Picture(
        umbrage::core::environment::SkyPicture::new(Image::from_fn(32, 16, |x, y| {
            let lobe = |at: u32| (1.0 + (std::f32::consts::TAU * (x as f32 - at as f32) / 32.0).cos()) * 0.5;
            [0.2 + lobe(4), 0.3 + 0.7 * lobe(14) * (1.0 - y as f32 / 16.0), 0.4]
        }))
        .unwrap(),
    )
}

/// A box on a floor, seen from above.
fn scene(sky: Sky) -> Scene {
    let mut scene = Scene {
        camera: Camera { eye: DVec3::new(1.0, 4.0, 5.0), target: DVec3::new(0.0, 0.4, 0.0), ..Camera::default() },
        environment: Some(Environment::new(sky)),
        ..Scene::default()
    };
    let plane = scene.add_mesh(primitive::plane());
    let cube = scene.add_mesh(primitive::cube());
    let grey = scene.add_material(Material { base_color: Vec4::new(0.6, 0.5, 0.4, 1.0), ..Material::default() });
    scene.place(plane, grey, DAffine3::from_scale(DVec3::new(6.0, 1.0, 6.0)));
    let turned = DQuat::from_rotation_y(0.4);
    scene.place(cube, grey, DAffine3::from_scale_rotation_translation(DVec3::ONE, turned, DVec3::new(0.0, 0.5, 0.0)));
    scene
}

/// Scores against paths; nothing beside borders of surfaces counts.
fn scores(
    picture: &Image<[f32; 3]>,
    scene: &Scene,
    environment: &Environment,
    options: RadianceOptions,
) -> RadianceScores {
    let tracer = Tracer::new(scene);
    let geometry = tracer.geometry(&scene.camera, SIZE.0, SIZE.1);
    let paths = PathTracer::under(&tracer, scene, environment).unwrap();
    let truth = paths.radiance((&geometry, &scene.camera), &options, &|_, _| ()).unwrap();
    let edges = discontinuities(&geometry.depth, &geometry.model);
    let mask = Image::from_fn(SIZE.0, SIZE.1, |x, y| truth.scored[(x, y)] && !edges[(x, y)]);
    score_radiance(&RadianceComparison { produced: picture, reference: &truth.radiance, mask: &mask }).unwrap()
}

#[test]
fn under_a_constant_sky_a_plane_sends_out_its_colour_and_the_foot_of_a_wall_half_of_it() {
    let gpu = gpu();
    let mut scene = scene(Sky::Constant(Vec3::new(1.0, 2.0, 0.5)));
    scene.instances.truncate(1);
    let flat = radiance(&mut renderer(&gpu, &scene, ""), &scene.camera);
    let middle = flat[(SIZE.0 / 2, SIZE.1 / 2)];
    for (found, want) in middle.into_iter().zip([0.6, 1.0, 0.2]) {
        // A step of half floats.
        assert!((found - want).abs() <= want / 1024.0, "{found} instead of {want}");
    }
    // A wall so wide and high that it hides half of the sky from its foot, where the floor ends.
    scene.instances[0].world_from_mesh =
        DAffine3::from_translation(DVec3::Z * 2.0) * scene.instances[0].world_from_mesh;
    scene.instances[0].world_from_mesh.matrix3.z_axis = DVec3::Z * 4.0;
    let wide = DVec3::new(30.0, 30.0, 1.0);
    scene.place(1, 0, DAffine3::from_scale_rotation_translation(wide, DQuat::IDENTITY, DVec3::new(0.0, 0.0, -0.5)));
    scene.camera = Camera { eye: DVec3::new(0.0, 1.0, 2.0), target: DVec3::new(0.0, 0.0, 0.004), ..scene.camera };
    let walled = radiance(&mut renderer(&gpu, &scene, "bake-samples=1024"), &scene.camera);
    let foot = walled[(SIZE.0 / 2, SIZE.1 / 2)][0];
    assert!((foot - 0.3).abs() < 0.012, "{foot} at the foot of the wall, and not half of 0.6");
}

#[test]
fn pictures_are_those_of_the_path_tracer_up_to_what_few_functions_hold() {
    let gpu = gpu();
    for (set, bounces, least, most) in [
        ("order=6", 0, 0.001, 0.02),
        ("order=6,transfer=interreflected,bounces=2,bake-samples=64,detail=32", 2, 0.001, 0.02),
    ] {
        let scene = scene(lopsided());
        let picture = radiance(&mut renderer(&gpu, &scene, set), &scene.camera);
        let environment = scene.environment.as_ref().unwrap();
        let found = scores(&picture, &scene, environment, RadianceOptions { samples: 128, bounces });
        println!("{set}: {found:?}");
        let mae = found.relative_mae.unwrap();
        assert!((least..most).contains(&mae) && found.not_finite == 0, "{set}: {found:?}");
    }
}

#[test]
fn an_object_that_turns_with_its_sky_looks_as_before() {
    let gpu = gpu();
    let mut scene = scene(lopsided());
    let mut renderer = renderer(&gpu, &scene, "");
    let before = radiance(&mut renderer, &scene.camera);
    let angle: f64 = 70.0;
    let turn = DQuat::from_rotation_y(angle.to_radians());
    for (number, instance) in scene.instances.iter().enumerate() {
        move_instance(&mut renderer, number, &(DAffine3::from_quat(turn) * instance.world_from_mesh));
    }
    scene.camera.eye = turn * scene.camera.eye;
    scene.camera.target = turn * scene.camera.target;
    let still = radiance(&mut renderer, &scene.camera);
    let environment = scene.environment.as_mut().unwrap();
    environment.rotate_deg = angle;
    *renderer.light_mut(0).unwrap() = environment.light();
    let turned = radiance(&mut renderer, &scene.camera);
    let off = |picture: &Image<[f32; 3]>| {
        let all = picture.data.as_flattened().iter().zip(before.data.as_flattened());
        let sum: f32 = all.map(|(a, b)| (a - b).abs()).sum();
        sum / before.data.as_flattened().iter().sum::<f32>()
    };
    assert!(
        off(&turned) < 1e-3 && off(&still) > 0.01,
        "{} turned with it, {} under the same sky",
        off(&turned),
        off(&still)
    );
    // Without a change nothing is summed again.
    let sums = |renderer: &Renderer| renderer.counts(0).iter().find(|(name, _)| *name == "sums").unwrap().1;
    let before = sums(&renderer);
    radiance(&mut renderer, &scene.camera);
    assert_eq!(sums(&renderer), before);
}

#[test]
fn what_does_not_fit_is_refused_with_the_remedy() {
    let gpu = gpu();
    let scene = scene(Sky::Constant(Vec3::ONE));
    let pass = |technique| vec![LightPass { light: 0, technique }];
    let frame = |renderer: &mut Renderer| renderer.frame(&scene.camera).unwrap_err().to_string();
    let mut bare = Renderer::new(&gpu, &scene, SIZE.0, SIZE.1, pass(technique(&gpu, ""))).unwrap();
    assert!(frame(&mut bare).contains("umbrage-bake"), "{}", frame(&mut bare));
    let hard = find("shadow-map").unwrap().default_settings().make(&gpu).unwrap();
    let mut of_visibility = Renderer::new(&gpu, &scene, SIZE.0, SIZE.1, pass(hard)).unwrap();
    assert!(frame(&mut of_visibility).contains("answer is radiance"));
    // Under another light.
    let mut lit = scene.clone();
    lit.lights = (umbrage::core::scenes::find("contact").unwrap().build)(0.1).lights;
    let mut wrong = Renderer::new(&gpu, &lit, SIZE.0, SIZE.1, pass(technique(&gpu, ""))).unwrap();
    assert!(frame(&mut wrong).contains("environment"), "{}", frame(&mut wrong));
    // Of other settings, and of another scene.
    let mut prt = technique(&gpu, "order=3");
    let transfer = baked(&*technique(&gpu, "order=2"), &scene);
    assert!(matches!(prt.take_transfer(&gpu, &transfer, &scene), Err(Error::Scene(text)) if text.contains("order 3")));
    let fitting = baked(&*prt, &scene);
    assert!(prt.take_transfer(&gpu, &fitting, &Scene::default()).is_err());
    prt.take_transfer(&gpu, &fitting, &scene).unwrap();
    let mut more = scene.clone();
    more.place(1, 0, DAffine3::from_translation(DVec3::new(2.0, 0.5, 0.0)));
    let mut grown = Renderer::new(&gpu, &more, SIZE.0, SIZE.1, pass(prt)).unwrap();
    assert!(frame(&mut grown).contains("bake the scene"), "{}", frame(&mut grown));
    let mut none = find("none").unwrap().default_settings().make(&gpu).unwrap();
    assert!(none.take_transfer(&gpu, &fitting, &scene).is_err_and(|e| e.to_string().contains("no use")));
}

#[test]
fn an_empty_scene_and_a_mesh_without_shape_are_black() {
    let gpu = gpu();
    let mut empty = scene(Sky::Constant(Vec3::ONE));
    empty.instances.clear();
    assert!(radiance(&mut renderer(&gpu, &empty, ""), &empty.camera).data.iter().all(|p| *p == [0.0; 3]));
    let mut flat = scene(Sky::Constant(Vec3::ONE));
    flat.instances[1].world_from_mesh = DAffine3::from_scale(DVec3::new(1.0, 0.0, 0.0));
    let picture = radiance(&mut renderer(&gpu, &flat, ""), &flat.camera);
    assert!(picture.data.as_flattened().iter().all(|c| c.is_finite()));
}

/// Only the rays of the bake and the size of its triangles are between this and the transfer.
#[test]
fn a_sky_of_few_functions_is_as_the_tracer_has_it() {
    let gpu = gpu();
    let scene = {
        let few = |d: DVec3| harmonics_of_few(d);
        let picture = Image::from_fn(512, 257, |x, y| {
            few(umbrage::core::environment::direction_of(umbrage::core::environment::place_of_pixel((512, 257), x, y)))
                .as_vec3()
                .to_array()
        });
        scene(Sky::Picture(umbrage::core::environment::SkyPicture::new(picture).unwrap()))
    };
    let picture = radiance(&mut renderer(&gpu, &scene, "order=3,bake-samples=1024"), &scene.camera);
    let options = RadianceOptions { samples: 256, bounces: 0 };
    let found = scores(&picture, &scene, scene.environment.as_ref().unwrap(), options);
    println!("{found:?}");
    assert!(found.relative_mae.unwrap() < 0.01 && found.relative_bias.unwrap().abs() < 0.004, "{found:?}");
}

/// A light of order 3 that is nowhere below 0.
fn harmonics_of_few(direction: DVec3) -> DVec3 {
    let order = Order::new(3).unwrap();
    let mut light = harmonics::project(order, 0, |_| Vec3::ONE);
    light.add_direction(DVec3::new(0.6, 0.48, 0.64), DVec3::new(1.2, 0.9, 0.6));
    let light: Light = light;
    light.radiance(direction)
}

//! Radiance against closed forms.

use std::f64::consts::{FRAC_PI_2, PI};
use umbrage_core::environment::{Daylight, Gradient, SkyPicture, direction_of, solid_angle};
use umbrage_core::glam::{DAffine3, DVec2, DVec3, Vec3, Vec4};
use umbrage_core::{Camera, Environment, Image, Material, Mesh, Scene, Sky, primitive};
use umbrage_reference::{PathTracer, RadianceOptions, RadianceTruth, Tracer};

const ALBEDO: f32 = 0.6;

fn scene(sky: Sky, eye: DVec3, target: DVec3) -> Scene {
    let up = if (target - eye).normalize().y.abs() > 0.9 { DVec3::Z } else { DVec3::Y };
    let camera = Camera { eye, target, up, fov_y_deg: 2.0, near: 1e-3, ..Camera::default() };
    Scene { camera, environment: Some(Environment::new(sky)), ..Scene::default() }
}

fn add(scene: &mut Scene, mesh: Mesh, albedo: f32, place: DAffine3) {
    let mesh = scene.add_mesh(mesh);
    let base_color = Vec3::splat(albedo).extend(1.0);
    let material = scene.add_material(Material { base_color, ..Material::default() });
    scene.place(mesh, material, place);
}

/// A plane seen from above.
fn plane(sky: Sky) -> Scene {
    let mut scene = scene(sky, DVec3::new(0.0, 3.0, 0.5), DVec3::ZERO);
    add(&mut scene, primitive::plane(), ALBEDO, DAffine3::from_scale(DVec3::splat(8.0)));
    scene
}

fn trace(scene: &Scene, size: (u32, u32), samples: u32, bounces: u32) -> RadianceTruth {
    let tracer = Tracer::new(scene);
    let geometry = tracer.geometry(&scene.camera, size.0, size.1);
    let options = RadianceOptions { samples, bounces };
    let paths = PathTracer::new(&tracer, scene).expect("a scene that can be traced");
    paths.radiance((&geometry, &scene.camera), &options, &|_, _| ()).expect("a truth")
}

/// The mean of the red channel over the scored pixels, and its standard error.
fn mean(truth: &RadianceTruth) -> (f64, f64) {
    let scored = truth.scored.data.iter().filter(|s| **s).count() as f64;
    assert!(scored > 0.0, "nothing is seen");
    let sum: f64 = truth.radiance.data.iter().map(|p| f64::from(p[0])).sum();
    let squares: f64 = truth.error.data.iter().map(|e| f64::from(*e).powi(2)).sum();
    (sum / scored, squares.sqrt() / scored)
}

fn is_near(truth: &RadianceTruth, want: f64, share: f64) {
    let (got, error) = mean(truth);
    assert!((got - want).abs() <= 4.0 * error + share * want, "{got} ± {error} instead of {want}");
}

#[test]
fn a_plane_under_an_even_sky_is_as_bright_as_its_albedo() {
    for bounces in [0, 3] {
        let truth = trace(&plane(Sky::Constant(Vec3::ONE)), (6, 4), 16, bounces);
        let albedo = f64::from(ALBEDO);
        assert!(truth.radiance.data.iter().flatten().all(|c| (f64::from(*c) / albedo - 1.0).abs() < 1e-6));
        assert!(truth.error.data.iter().all(|e| *e < 1e-6));
    }
}

/// A scene of a host may name meshes that are gone.
#[test]
fn an_instance_without_its_mesh_lends_its_colour_to_nobody() {
    let mut scene = plane(Sky::Constant(Vec3::ONE));
    let red = scene.add_material(Material { base_color: Vec4::new(0.9, 0.0, 0.0, 1.0), ..Material::default() });
    scene.place(99, red, DAffine3::IDENTITY);
    let gone = scene.instances.pop().expect("what was placed");
    scene.instances.insert(0, gone);
    let truth = trace(&scene, (6, 4), 4, 1);
    assert!(truth.radiance.data.iter().flatten().all(|c| (c / ALBEDO - 1.0).abs() < 1e-5));
}

#[test]
fn at_a_walls_foot_it_is_half_as_bright() {
    let mut foot = scene(Sky::Constant(Vec3::ONE), DVec3::new(2.0, 2.0, 0.0), DVec3::new(1e-3, 0.0, 0.0));
    foot.camera.fov_y_deg = 0.005;
    let upright = DAffine3::from_rotation_z(FRAC_PI_2) * DAffine3::from_scale(DVec3::splat(2000.0));
    add(&mut foot, primitive::plane(), ALBEDO, DAffine3::from_scale(DVec3::splat(2000.0)));
    add(&mut foot, primitive::plane(), 0.0, upright);
    is_near(&trace(&foot, (8, 8), 256, 2), 0.5 * f64::from(ALBEDO), 2e-3);
}

#[test]
fn every_sky_gives_a_plane_the_light_that_it_sends() {
    let gradient = Gradient { zenith: Vec3::ONE, horizon: Vec3::splat(0.25), nadir: Vec3::splat(9.0) };
    is_near(&trace(&plane(Sky::Gradient(gradient)), (8, 8), 256, 0), f64::from(ALBEDO) * (0.25 + 2.0) / 3.0, 1e-4);
    let image = Image::from_fn(32, 16, |x, y| [if (x, y) == (5, 3) { 2e3 } else { 0.2 + x as f32 / 32.0 }; 3]);
    let daylight = Daylight::new(DVec3::new(0.5, 0.7, 0.2), 3.0, Vec3::ZERO, 0.53).expect("a sky");
    for sky in [Sky::Picture(SkyPicture::new(image).expect("a picture")), Sky::Daylight(daylight)] {
        // Fine enough for what is interpolated; the sun is apart.
        let (width, height) = (512, 256);
        let mut irradiance = sky.sun().map_or(0.0, |s| f64::from(s.radiance.x) * s.solid_angle() * s.direction.y);
        let sun = sky.sun().copied();
        for (x, y) in (0..height / 2).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let place = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / DVec2::new(width.into(), height.into());
            let direction = direction_of(place);
            if sun.is_none_or(|s| !s.holds(direction)) {
                irradiance += f64::from(sky.radiance(direction).x) * direction.y * solid_angle(width, height, y);
            }
        }
        let want = f64::from(ALBEDO) * irradiance / PI;
        let truth = trace(&plane(sky), (8, 8), 256, 0);
        is_near(&truth, want, 3e-3);
        let (got, error) = mean(&truth);
        assert!(error < 0.01 * got, "{error} of {got}: the sky is not drawn by its brightness");
    }
}

/// A hollow sphere that is open at the top, down to this height over its middle; radius 1.
fn bowl(opening: f32) -> Mesh {
    let mut mesh = primitive::sphere(128, 64);
    let triangles: Vec<[u32; 3]> = mesh.triangles().collect();
    let scale = mesh.positions[0].length();
    let middle = |t: &[u32; 3]| t.iter().map(|i| mesh.positions[*i as usize].y / scale).sum::<f32>() / 3.0;
    mesh.indices = triangles.iter().filter(|t| middle(t) < opening).flatten().copied().collect();
    mesh.positions.iter_mut().for_each(|p| *p /= scale);
    mesh
}

#[test]
fn a_furnace_keeps_its_energy() {
    // In a hollow sphere every part sees every other one under the same form factor: the walls fill
    // a share w of what each sees, so light falls off as a geometric series of ρ w, towards 1 / (1
    // − ρ) where the sphere closes.
    let (rho, mesh) = (0.8_f64, bowl(0.8));
    let walls: f64 = {
        // By the area of the real opening: rows of triangles end at a parallel.
        let top = mesh.indices.iter().map(|i| f64::from(mesh.positions[*i as usize].y)).fold(-1.0, f64::max);
        (1.0 + top) / 2.0
    };
    let mut furnace = scene(Sky::Constant(Vec3::ONE), DVec3::ZERO, DVec3::NEG_Y);
    furnace.camera.fov_y_deg = 60.0;
    add(&mut furnace, mesh, rho as f32, DAffine3::IDENTITY);
    for bounces in [0, 1, 2, 5, 48] {
        let series: f64 = (0..=bounces).map(|k| (rho * walls).powi(k as i32)).sum();
        is_near(&trace(&furnace, (12, 12), 256, bounces), rho * (1.0 - walls) * series, 6e-3);
    }
}

#[test]
fn both_sides_reflect() {
    let gradient = Gradient { zenith: Vec3::ZERO, horizon: Vec3::ZERO, nadir: Vec3::ONE };
    let mut below = plane(Sky::Gradient(gradient));
    is_near(&trace(&below, (4, 4), 64, 0), 0.0, 0.0);
    below.camera.eye.y = -3.0;
    is_near(&trace(&below, (4, 4), 256, 0), f64::from(ALBEDO) * 2.0 / 3.0, 1e-4);
}

#[test]
fn the_standard_error_is_that_of_the_pixels() {
    let image = Image::from_fn(32, 16, |x, y| [if (x, y) == (5, 3) { 50.0 } else { 0.2 }; 3]);
    let mut boxes = plane(Sky::Picture(SkyPicture::new(image).expect("a picture")));
    add(&mut boxes, primitive::cube(), 0.5, DAffine3::from_translation(DVec3::new(1.2, 0.5, 0.3)));
    let want = mean(&trace(&boxes, (24, 24), 2048, 1)).0;
    // All pixels show about the same point.
    let truth = trace(&boxes, (24, 24), 64, 1);
    let pixels = truth.radiance.data.len() as f64;
    let off: f64 = truth.radiance.data.iter().map(|p| (f64::from(p[0]) - want).powi(2)).sum();
    let stated: f64 = truth.error.data.iter().map(|e| f64::from(*e).powi(2)).sum();
    let ratio = (off / stated).sqrt();
    assert!((0.75..1.33).contains(&ratio), "errors are {ratio} of what is stated, over {pixels} pixels");
}

#[test]
fn the_same_paths_are_traced_again_whatever_the_threads() {
    let daylight = Daylight::new(DVec3::new(0.5, 0.7, 0.2), 3.0, Vec3::ONE, 4.0).expect("a sky");
    let scene = plane(Sky::Daylight(daylight));
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    assert_eq!(one.install(|| trace(&scene, (8, 6), 20, 2)), trace(&scene, (8, 6), 20, 2));
}

#[test]
fn what_cannot_be_traced_is_said() {
    let mut scene = plane(Sky::Constant(Vec3::ONE));
    let tracer = Tracer::new(&scene);
    let geometry = tracer.geometry(&scene.camera, 2, 2);
    let error = |scene: &Scene, bounces| {
        let options = RadianceOptions { bounces, ..RadianceOptions::default() };
        let traced = PathTracer::new(&tracer, scene)
            .and_then(|paths| paths.radiance((&geometry, &scene.camera), &options, &|_, _| ()));
        traced.expect_err("it was traced")
    };
    assert!(error(&scene, 65).contains("0 to 64"));
    scene.materials[0].base_color.x = 1.5;
    assert!(error(&scene, 0).contains("from 0 to 1"));
    scene.materials[0].base_color.x = f32::NAN;
    assert!(error(&scene, 0).contains("from 0 to 1"));
    scene.environment = None;
    assert!(error(&scene, 0).contains("no environment"));
}

#[test]
fn poor_meshes_give_light_that_is_a_number() {
    let mut poor = plane(Sky::Constant(Vec3::ONE));
    let mesh = &mut poor.meshes[0];
    // A triangle without area, normals that are none, and too few of them.
    mesh.indices.extend([0, 0, 1]);
    mesh.normals = vec![Vec3::NAN, Vec3::ZERO];
    let mut flat = primitive::sphere(8, 4);
    flat.normals.clear();
    add(&mut poor, flat, 0.5, DAffine3::from_scale(DVec3::new(0.4, 0.0, 0.4)));
    let truth = trace(&poor, (8, 8), 32, 3);
    assert!(truth.radiance.data.iter().flatten().all(|c| c.is_finite() && *c >= 0.0));
    assert!(truth.scored.data.iter().all(|s| *s));
}

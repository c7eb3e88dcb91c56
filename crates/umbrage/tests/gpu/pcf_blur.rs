//! What `pcf-blur` does to a picture: a Gaussian where there is something to blur, along surfaces
//! or with the paper's halo.

use crate::common::{gpu, mask, renderer, visibility};
use umbrage::Gpu;
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, Image, Light, LightShape, Material, Scene, primitive};
use umbrage_metrics::discontinuities;
use umbrage_reference::{Options, Tracer};

/// A floor of 20 m and boxes, each by its middle and size.
fn boxes(light: LightShape, camera: Camera, boxes: &[(DVec3, DVec3)]) -> Scene {
    let mut scene = Scene { lights: vec![Light::new(light)], camera, ..Scene::default() };
    let (floor, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let material = scene.add_material(Material::default());
    scene.place(floor, material, DAffine3::from_scale(DVec3::splat(20.0)));
    for &(middle, size) in boxes {
        scene.place(cube, material, DAffine3::from_translation(middle) * DAffine3::from_scale(size));
    }
    scene
}

fn seen(gpu: &Gpu, scene: &Scene, set: &str, size: (u32, u32)) -> Image<f32> {
    visibility(&mut renderer(gpu, scene, 0, "pcf-blur", set, size), scene)
}

/// Shadows on a floor that fills the picture.
fn floor_from_above() -> Scene {
    let light = LightShape::Point { position: DVec3::new(1.0, 5.0, 0.7) };
    let camera = Camera { eye: DVec3::new(0.3, 6.0, 2.0), target: DVec3::ZERO, ..Camera::default() };
    let shapes = [[-1.4, 0.2, 0.5], [0.1, 0.7, -0.7], [1.9, 1.1, 1.2]].map(DVec3::from);
    boxes(light, camera, &shapes.map(|middle| (middle, DVec3::new(0.9, 0.1, 0.5))))
}

/// The Gaussian by its definition, over rows and then columns of a picture that continues as its
/// border.
fn gaussian(picture: &Image<f32>, radius: f64) -> Image<f32> {
    let reach = radius.floor() as i64;
    let weights = |i: i64| (-2.0 * (i * i) as f64 / (radius * radius)).exp();
    let total: f64 = (-reach..=reach).map(weights).sum();
    let along = |picture: &Image<f32>, dx: i64, dy: i64| {
        let (width, height) = picture.size();
        let last = (i64::from(width) - 1, i64::from(height) - 1);
        Image::from_fn(width, height, |x, y| {
            let at = |i: i64| {
                let (x, y) = (i64::from(x) + i * dx, i64::from(y) + i * dy);
                f64::from(picture[(x.clamp(0, last.0) as u32, y.clamp(0, last.1) as u32)])
            };
            ((-reach..=reach).map(|i| weights(i) * at(i)).sum::<f64>() / total) as f32
        })
    };
    along(&along(picture, 1, 0), 0, 1)
}

#[test]
fn without_regard_to_depth_it_is_a_gaussian() {
    let gpu = gpu();
    let scene = floor_from_above();
    // Visibility is rounded to 1/254 after rows and after columns.
    let rounding = 1.1 / 254.0;
    for size in [(160, 120), (161, 119), (37, 53)] {
        for (source, radius) in [("3", 1.0), ("3", 3.0), ("hard", 4.5), ("3", 8.0), ("hard", 20.0), ("3", 64.0)] {
            let with = |radius: f64| format!("size=512,source={source},radius={radius},depth-aware=off");
            let sharp = seen(&gpu, &scene, &with(0.0), size);
            let blurred = seen(&gpu, &scene, &with(radius), size);
            let right = gaussian(&sharp, radius);
            let off = blurred.data.iter().zip(&right.data).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            let change = blurred.data.iter().zip(&sharp.data).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            println!("{size:?} {source} radius {radius}: off by up to {off:.4}, changed by up to {change:.3}");
            assert!(off <= rounding, "{size:?} {source} radius {radius}: off by {off}");
            assert!(change > 0.1, "{size:?} {source} radius {radius}: nothing is blurred");
        }
    }
}

#[test]
fn on_a_plane_depth_makes_no_difference() {
    let gpu = gpu();
    let mut scene = floor_from_above();
    // Only their shadows are seen.
    scene.camera = Camera { eye: DVec3::new(-3.0, 1.0, 0.0), target: DVec3::new(-1.0, 0.0, -0.8), ..scene.camera };
    for instance in &mut scene.instances[1..] {
        instance.world_from_mesh.translation.y += 1.5;
    }
    let [on, off] = ["on", "off"].map(|aware| seen(&gpu, &scene, &format!("radius=6,depth-aware={aware}"), (160, 120)));
    let partly = off.data.iter().filter(|v| **v > 0.05 && **v < 0.95).count();
    assert!(partly > 500, "only {partly} pixels are between light and shadow");
    // The border of the picture continues as a pixel and not as a plane.
    let inside = (6..114).flat_map(|y| (6..154).map(move |x| (x, y)));
    let differ = inside.filter(|at| (on[*at] - off[*at]).abs() > 1e-3).count();
    assert_eq!(differ, 0, "pixels of a plane are not blurred as such");
}

/// A lit post on the screen before the shadow of a wall.
fn post_before_shadow() -> Scene {
    let light = LightShape::Directional { direction: DVec3::new(1.0, -1.0, -0.2).normalize(), angle_deg: 0.0 };
    let camera = Camera {
        eye: DVec3::new(-1.2, 1.6, 7.0),
        target: DVec3::new(-1.2, 0.5, 0.0),
        fov_y_deg: 40.0,
        ..Camera::default()
    };
    let wall = (DVec3::new(-3.0, 1.25, 0.0), DVec3::new(0.2, 2.5, 4.0));
    let post = (DVec3::new(-1.2, 0.6, 3.2), DVec3::new(0.3, 1.2, 0.3));
    boxes(light, camera, &[wall, post])
}

/// Mean error of scored pixels within `reach` pixels of a silhouette but not beside a shadow's
/// edge, which blurs in any case.
fn error_beside_silhouettes(gpu: &Gpu, scene: &Scene, set: &str, reach: i64) -> f64 {
    let size = (320, 240);
    let tracer = Tracer::new(scene);
    let geometry = tracer.geometry(&scene.camera, size.0, size.1);
    let options = Options { samples: 1, ..Options::default() };
    let truth = tracer.visibility(&geometry, &scene.lights[0], &[], &options, &|_, _| ());
    let mask = mask(&truth, &geometry, 60.0);
    let silhouettes = discontinuities(&geometry.depth, &geometry.model);
    let around = |x: u32, y: u32| {
        let (x, y) = (i64::from(x), i64::from(y));
        (y - reach..=y + reach).flat_map(move |j| (x - reach..=x + reach).map(move |i| (i, j)))
    };
    let produced = seen(gpu, scene, set, size);
    let mut errors = Vec::new();
    for (x, y) in (0..size.1).flat_map(|y| (0..size.0).map(move |x| (x, y))).filter(|at| mask[*at]) {
        let at = |i, j| mask.get(i, j) == Some(&true);
        // Shadows' edges are between pixels of one surface.
        let same = |i: i64, j: i64| geometry.model.get(i, j) == Some(&geometry.model[(x, y)]);
        let value = truth.visibility[(x, y)];
        let is_edge = |(i, j)| at(i, j) && same(i, j) && truth.visibility.get(i, j) != Some(&value);
        if around(x, y).any(|(i, j)| silhouettes.get(i, j) == Some(&true)) && !around(x, y).any(is_edge) {
            errors.push(f64::from((produced[(x, y)] - value).abs()));
        }
    }
    assert!(errors.len() > 500, "only {} pixels", errors.len());
    errors.iter().sum::<f64>() / errors.len() as f64
}

#[test]
fn the_halo_beside_silhouettes_is_cured_by_depth() {
    let (gpu, scene) = (gpu(), post_before_shadow());
    for radius in [3_u32, 8] {
        let error = |aware| {
            let set = format!("size=2048,radius={radius},depth-aware={aware}");
            error_beside_silhouettes(&gpu, &scene, &set, radius.into())
        };
        let (off, on) = (error("off"), error("on"));
        println!("radius {radius}: mean error beside silhouettes {off:.4} without regard to depth, {on:.5} with");
        assert!(off > 0.02 && on < 0.05 * off, "radius {radius}: {off} without regard to depth, {on} with");
    }
}

#[test]
fn the_background_lights_nothing() {
    let gpu = gpu();
    // All that is seen of the floor is in the shadow of a slab above the picture.
    let light = LightShape::Point { position: DVec3::new(0.0, 9.0, 0.0) };
    let camera = Camera { eye: DVec3::new(0.0, 0.5, 3.0), target: DVec3::new(0.0, 0.4, 0.0), ..Camera::default() };
    let scene = boxes(light, camera, &[(DVec3::new(0.0, 6.0, 0.0), DVec3::new(60.0, 0.1, 60.0))]);
    for aware in ["on", "off"] {
        let seen = seen(&gpu, &scene, &format!("radius=12,depth-aware={aware}"), (160, 120));
        let (dark, lit) = (|v: &&f32| **v <= 1e-3, |v: &&f32| **v == 1.0);
        let [dark, lit] = [seen.data.iter().filter(dark).count(), seen.data.iter().filter(lit).count()];
        assert!(dark > 3000 && lit > 3000, "{dark} pixels of the floor, {lit} of the background");
        assert_eq!(dark + lit, seen.data.len(), "depth-aware={aware}: the background bleeds");
    }
}

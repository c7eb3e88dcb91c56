//! Smoothies: the outer half of penumbrae against the closed form.

use crate::common::{gpu, pairs, visibility};
use crate::penumbra::{Case, Profile, crossing};
use std::f64::consts::FRAC_PI_2;
use umbrage::core::glam::{DAffine3, DMat3, DVec2, DVec3};
use umbrage::core::light_view::LightView;
use umbrage::core::{Camera, Light, LightShape, Material, Scene, primitive};
use umbrage::{Gpu, find};
use umbrage_reference::closed_form::{past_half_plane, sphere_above_plane};
use umbrage_renderer::{LightPass, Renderer};

/// Allowed error of the width, as a share of it: what the technique promises.
const TOLERANCE: f64 = 0.1;

/// Sizes of lights over their height, heights of the edge over that of the light, heights of the
/// light.
const SIZES: [f64; 5] = [0.02, 0.05, 0.1, 0.2, 0.3];
const EDGES: [f64; 5] = [0.1, 0.3, 0.5, 0.65, 0.75];
const HEIGHTS: [f64; 5] = [2.0, 4.0, 8.0, 15.0, 30.0];

/// The penumbra outside of the hard shadow, metres across the edge.
#[derive(Clone, Copy, Debug)]
struct Outer {
    start: f64,
    width: f64,
}

/// By the closed form: from where the light's centre is hidden to where nothing is.
fn truth(case: &Case) -> Outer {
    let center = case.light.center();
    let way = DMat3::from_rotation_y(-case.turn) * (center.truncate() - DVec3::Y * (case.height * center.w));
    let start = -way.x / way.y * case.height;
    let (mut dark, mut lit) = (start, start + 1e3);
    for _ in 0..80 {
        let middle = 0.5 * (dark + lit);
        *if case.visibility(middle) < 1.0 - 1e-7 { &mut dark } else { &mut lit } = middle;
    }
    Outer { start, width: dark - start }
}

/// By where the profile leaves 0 and where it gets to 1.
fn measured(profile: &Profile) -> Outer {
    let column = (profile.places[1] - profile.places[0]).abs();
    let at = |columns: &[f64], level: f64| profile.places[0] + column * crossing(columns, level);
    let width = (at(&profile.columns, 0.98) - at(&profile.columns, 0.02)) / 0.96;
    Outer { start: at(&profile.lit, 0.5), width }
}

/// How wide a texel is on the floor.
fn texel(case: &Case, profile: &Profile) -> f64 {
    let turn = DMat3::from_rotation_y(case.turn);
    let middle = profile.places[profile.places.len() / 2];
    let step = 1e-3 * (profile.places[1] - profile.places[0]).abs();
    let of = |view: &LightView| {
        let [a, b] = [middle, middle + step].map(|x| view.project(turn * DVec3::X * x));
        let (a, b) = (a?.truncate(), b?.truncate());
        (a.abs().max_element() <= 1.0).then(|| step / ((a - b).length() * 0.5 * f64::from(view.size)))
    };
    profile.views.iter().find_map(of).expect("a view")
}

/// 25 lights of one kind: every size with every height of the edge, at all heights of the light.
fn cases(kind: &str, light: impl Fn(f64, DVec3, DMat3) -> LightShape) -> Vec<Case> {
    let pairs = (0..25).map(|i| (i % 5, i / 5));
    pairs
        .map(|(size, edge)| {
            let y = HEIGHTS[(size + edge + 2) % 5];
            let turn = [0.0, 0.4, 1.1, 2.3, 0.8][(2 * size + edge) % 5];
            let offset = [-0.4, 0.1, 0.6, 0.0][(size + edge) % 4];
            let turned = DMat3::from_rotation_y(turn);
            let at = turned * DVec3::new(offset * y, y, 0.3 * offset * y);
            let (size, height) = (SIZES[size] * y, EDGES[edge] * y);
            let name = format!("{kind}, size {size:.2} at {at:.2}, edge at {height:.2}, turned by {turn}");
            Case { name, light: light(size, at, turned), height, turn }
        })
        .collect()
}

fn rows(gpu: &Gpu, cases: &[&Case], set: &str) -> Vec<(String, bool)> {
    let info = find("smoothies").unwrap();
    let row = |case: &&Case| {
        let profile = case.profile(gpu, info.settings(&pairs(set)).unwrap().make(gpu).unwrap());
        let (got, want) = (measured(&profile), truth(case));
        let texel = texel(case, &profile);
        let falls = profile.columns.windows(2).map(|pair| pair[0] - pair[1]).fold(0.0, f64::max);
        let (wide, start) = (got.width / want.width, (got.start - want.start) / texel);
        let right = (wide - 1.0).abs() <= TOLERANCE && start.abs() <= 1.0 && falls < 0.02;
        let name = format!("{:66} outer width × {wide:.3}, starts {start:+.2} texels off, falls {falls:.3}", case.name);
        (name, right)
    };
    cases.iter().map(row).collect()
}

fn are_right(cases: &[Case]) {
    let gpu = gpu();
    let mut wrong = Vec::new();
    let some: Vec<&Case> = cases.iter().step_by(6).collect();
    for (set, cases) in [("", cases.iter().collect()), ("samples=1,geometry=cones", some)] {
        for (row, right) in rows(&gpu, &cases, set) {
            println!("{set} {row}");
            if !right {
                wrong.push(format!("{set} {row}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}

#[test]
fn outer_penumbrae_of_spheres_are_right() {
    are_right(&cases("sphere", |size, position, _| LightShape::Sphere { position, radius: 0.5 * size }));
}

#[test]
fn outer_penumbrae_of_discs_are_right() {
    for tilt in [0.0, -0.7] {
        are_right(&cases(&format!("disc tilted by {tilt}"), |size, position, turn| LightShape::Disc {
            position,
            direction: turn * (DMat3::from_rotation_z(tilt) * DVec3::NEG_Y),
            radius: 0.5 * size,
        }));
    }
}

#[test]
fn outer_penumbrae_of_rectangles_are_right() {
    for (spin, tilt) in [(0.0, 0.0), (0.7, -0.6)] {
        are_right(&cases(&format!("rect turned by {spin}, tilted by {tilt}"), |size, position, turn| {
            let axes = turn * DMat3::from_rotation_z(tilt) * DMat3::from_rotation_y(spin);
            let (direction, up) = (axes * DVec3::NEG_Y, axes * DVec3::Z);
            LightShape::Rect { position, direction, up, size: DVec2::new(1.0, 0.4) * size, texture: None }
        }));
    }
}

#[test]
fn outer_penumbrae_of_ellipsoids_are_right() {
    are_right(&cases("ellipsoid", |size, position, turn| LightShape::Ellipsoid {
        position,
        radii: DVec3::new(0.5, 0.3, 0.2) * size,
        rotation: turn * DMat3::from_rotation_y(0.5),
    }));
}

#[test]
fn outer_penumbrae_of_lines_are_right() {
    are_right(&cases("line", |size, position, turn| {
        let half = turn * DMat3::from_rotation_y(0.4) * DVec3::X * (0.5 * size);
        LightShape::Line { from: position - half, to: position + half }
    }));
}

#[test]
fn every_picture_shows_something_and_changes_no_shadow() {
    let gpu = gpu();
    let scene = crate::common::scene("contact", 1.0);
    let frame = |view: Option<&str>| {
        let mut technique = find("smoothies").unwrap().settings(&pairs("size=256")).unwrap().make(&gpu).unwrap();
        technique.inside_mut().inspect(view);
        let mut renderer = Renderer::new(&gpu, &scene, 160, 120, vec![LightPass { light: 1, technique }]).unwrap();
        let shadow = visibility(&mut renderer, &scene);
        let views = renderer.technique(0).unwrap().inside().debug_views();
        let shown = views.iter().find(|v| Some(v.name) == view).map(|v| renderer.read_debug_view(v).unwrap());
        (shown, shadow.data)
    };
    let (_, shadow) = frame(None);
    for (name, nothing) in [("smoothie-depth-0", 0.0), ("alpha-before-0", 1.0), ("alpha-0", 1.0)] {
        let (shown, seen) = frame(Some(name));
        assert!(seen == shadow, "{name} changes the shadow");
        let data = shown.unwrap_or_else(|| panic!("{name} is not shown")).data;
        let drawn = data.iter().filter(|v| **v != nothing).count();
        assert!(drawn > 500, "{name}: {drawn} texels");
    }
    gpu.check().unwrap();
}

#[test]
fn outer_penumbrae_of_suns_are_right() {
    are_right(&cases("sun", |size, position, _| LightShape::Directional {
        direction: -position.normalize(),
        // From 0.4 degrees to six.
        angle_deg: 20.0 * size / position.y,
    }));
}

/// Pixels across and down the picture of a wall's foot, and metres of each.
const FOOT: (u32, u32) = (256, 96);
const PIXEL: f64 = 0.004;

/// A wall that stands on a floor, its free edge upright above the origin, under a sphere light;
/// seen from above, where its shadow begins. Rows go along the shadow.
fn wall(floor_casts: bool) -> Scene {
    let light = LightShape::Sphere { position: FOOT_LIGHT, radius: FOOT_RADIUS };
    let mut scene = Scene { lights: vec![Light::new(light)], ..Scene::default() };
    let plane = scene.add_mesh(primitive::plane());
    let material = scene.add_material(Material::default());
    scene.place(plane, material, DAffine3::from_scale(DVec3::splat(40.0)));
    scene.instances[0].casts = floor_casts;
    let upright = DMat3::from_rotation_x(FRAC_PI_2) * DMat3::from_diagonal(DVec3::new(20.0, 1.0, 8.0));
    scene.place(plane, material, DAffine3 { matrix3: upright, translation: DVec3::new(-10.0, 4.0, 0.0) });
    let half = 0.5 * PIXEL * f64::from(FOOT.1);
    let target = DVec3::new(0.0, 0.0, half);
    let fov_y_deg = 2.0 * (half / 2.0).atan().to_degrees();
    scene.camera =
        Camera { eye: target + DVec3::Y * 2.0, target, up: DVec3::NEG_Z, fov_y_deg, near: 0.02, ..Camera::default() };
    scene
}

const FOOT_LIGHT: DVec3 = DVec3::new(0.0, 6.0, -4.0);
const FOOT_RADIUS: f64 = 1.5;

#[test]
fn shadows_are_sharp_at_the_contact_and_widen_from_there() {
    let gpu = gpu();
    let truth = |x: f64, z: f64| {
        let p = DVec3::new(x, 0.0, z);
        sphere_above_plane(p, past_half_plane(p, DVec3::ZERO, DVec3::Y, DVec3::NEG_X), FOOT_LIGHT, FOOT_RADIUS)
    };
    let place = |column: f64| (column + 0.5 - 0.5 * f64::from(FOOT.0)) * PIXEL;
    for floor_casts in [true, false] {
        let scene = wall(floor_casts);
        let technique = find("smoothies").unwrap().settings(&[]).unwrap().make(&gpu).unwrap();
        let mut renderer =
            Renderer::new(&gpu, &scene, FOOT.0, FOOT.1, vec![LightPass { light: 0, technique }]).unwrap();
        let seen = visibility(&mut renderer, &scene);
        for row in 1..FOOT.1 {
            let z = (f64::from(row) + 0.5) * PIXEL;
            let (mut dark, mut lit) = (0.0, 10.0);
            for _ in 0..60 {
                let middle = 0.5 * (dark + lit);
                *if truth(middle, z) < 1.0 - 1e-7 { &mut dark } else { &mut lit } = middle;
            }
            let columns: Vec<f64> = (0..FOOT.0).map(|x| f64::from(seen[(x, row)])).collect();
            let [start, end] = [0.02, 0.98].map(|level| place(crossing(&columns, level)));
            let what = format!(
                "floor casts: {floor_casts}, {z:.3} m from the foot: {start:.4} to {end:.4}, truth 0 to {dark:.4}"
            );
            // Two pixels for the texels of the map and of the picture.
            assert!((end - start - 0.96 * dark).abs() < 0.1 * dark + 2.0 * PIXEL, "{what}");
            assert!(start.abs() < 2.0 * PIXEL, "{what}");
        }
    }
}

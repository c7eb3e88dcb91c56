//! Penumbrae of a straight edge against the closed form: where they are and how wide.

use crate::common::{against_truth, gpu, pairs, visibility};
use std::f64::consts::FRAC_PI_2;
use umbrage::core::glam::{DAffine3, DMat3, DVec2, DVec3};
use umbrage::core::light_view::LightView;
use umbrage::core::{Camera, Light, LightShape, Material, Scene, primitive};
use umbrage::{Gpu, Technique, find, light_samples};
use umbrage_reference::closed_form::{disc_above_plane, past_half_plane, rect_above_plane, sphere_above_plane};
use umbrage_renderer::{LightPass, Renderer};

/// The picture: columns go across the edge, rows along it, and the penumbra is a quarter of the
/// columns wide.
const COLUMNS: u32 = 256;
const ROWS: u32 = 64;
const PENUMBRA: f64 = 64.0;

/// Columns that are averaged before levels are looked for: a tile of noise, which rows alone do not
/// average.
const SMOOTHED: usize = 8;

/// Allowed error of width and place, as a share of the width.
const TOLERANCE: f64 = 0.1;

/// A light over a half-plane over a floor. The edge is on the line x = 0, y = `height`, the
/// half-plane at x < 0, all turned around the vertical by `turn` radians with the light.
pub struct Case {
    pub name: String,
    pub light: LightShape,
    pub height: f64,
    pub turn: f64,
}

/// Place of the middle and width from 10 % to 90 % of the light, metres across the edge.
#[derive(Clone, Copy, Debug)]
struct Penumbra {
    middle: f64,
    width: f64,
}

impl Case {
    /// The share of the light that the floor sees `x` metres from below the edge.
    pub fn visibility(&self, x: f64) -> f64 {
        let turn = DMat3::from_rotation_y(self.turn);
        let (p, edge) = (turn * DVec3::new(x, 0.0, 0.0), DVec3::Y * self.height);
        let up = past_half_plane(p, edge, turn * DVec3::Z, turn * DVec3::NEG_X);
        match self.light {
            LightShape::Directional { direction, angle_deg } => {
                let radius = (angle_deg * 0.5).to_radians().tan();
                disc_above_plane(p, up, p - direction, direction, radius)
            }
            LightShape::Sphere { position, radius } => sphere_above_plane(p, up, position, radius),
            LightShape::Disc { position, direction, radius } => disc_above_plane(p, up, position, direction, radius),
            LightShape::Rect { position, direction, up: light_up, size, .. } => {
                let half = [light_up.cross(direction) * size.x * 0.5, light_up * size.y * 0.5];
                rect_above_plane(p, up, position, half)
            }
            LightShape::Line { from, to } => {
                rect_above_plane(p, up, (from + to) * 0.5, [(to - from) * 0.5, DVec3::ZERO])
            }
            LightShape::Ellipsoid { position, radii, rotation } => {
                // In the space where it is a sphere of radius 1, where planes are planes still.
                let to_unit = DMat3::from_diagonal(radii.recip()) * rotation.transpose();
                let up = to_unit.inverse().transpose() * up;
                sphere_above_plane(DVec3::ZERO, up.normalize(), to_unit * (position - p), 1.0)
            }
            LightShape::Point { .. } | LightShape::Spot { .. } | LightShape::Environment(_) => {
                panic!("neither hard lights nor the sky have a penumbra here")
            }
        }
    }

    fn penumbra(&self) -> Penumbra {
        let at = |level: f64| {
            let (mut dark, mut lit) = (-1e3, 1e3);
            for _ in 0..80 {
                let middle = 0.5 * (dark + lit);
                *if self.visibility(middle) < level { &mut dark } else { &mut lit } = middle;
            }
            0.5 * (dark + lit)
        };
        Penumbra { middle: at(0.5), width: at(0.9) - at(0.1) }
    }

    /// With a camera below the half-plane that looks straight down on the penumbra.
    fn scene(&self) -> Scene {
        let mut scene = Scene { lights: vec![Light::new(self.light.clone())], ..Scene::default() };
        let plane = scene.add_mesh(primitive::plane());
        let material = scene.add_material(Material::default());
        let turn = DMat3::from_rotation_y(self.turn);
        let place = |size: f64, at: DVec3| DAffine3 { matrix3: turn * size, translation: turn * at };
        scene.place(plane, material, place(400.0, DVec3::ZERO));
        scene.place(plane, material, place(200.0, DVec3::new(-100.0, self.height, 0.0)));
        let Penumbra { middle, width } = self.penumbra();
        let above = 0.9 * self.height;
        let half_rows = 0.5 * f64::from(ROWS) * width / PENUMBRA;
        scene.camera = Camera {
            eye: turn * DVec3::new(middle, above, 0.0),
            target: turn * DVec3::new(middle, 0.0, 0.0),
            up: turn * DVec3::NEG_Z,
            fov_y_deg: 2.0 * (half_rows / above).atan().to_degrees(),
            near: 0.01 * above,
            ..Camera::default()
        };
        scene
    }

    /// What the technique makes of it, column by column.
    pub fn profile(&self, gpu: &Gpu, technique: Box<dyn Technique>) -> Profile {
        let scene = self.scene();
        let mut renderer = Renderer::new(gpu, &scene, COLUMNS, ROWS, vec![LightPass { light: 0, technique }]).unwrap();
        let seen = visibility(&mut renderer, &scene);
        let mean = |x: u32, of: &dyn Fn(f32) -> f64| (0..ROWS).map(|y| of(seen[(x, y)])).sum::<f64>() / f64::from(ROWS);
        let want = self.penumbra();
        let place = |x: u32| (f64::from(x) + 0.5 - 0.5 * f64::from(COLUMNS)) / PENUMBRA * want.width + want.middle;
        let views = renderer.technique(0).unwrap().inside().light_views().to_vec();
        Profile {
            columns: (0..COLUMNS).map(|x| mean(x, &|v| v.into())).collect(),
            lit: (0..COLUMNS).map(|x| mean(x, &|v| if v > 0.0 { 1.0 } else { 0.0 })).collect(),
            places: (0..COLUMNS).map(place).collect(),
            views,
        }
    }

    /// What the technique makes of it, as shares of the true width: error of the middle, width.
    fn measure(&self, gpu: &Gpu, technique: Box<dyn Technique>) -> Penumbra {
        let profile = self.profile(gpu, technique);
        let got = smoothed(&profile.columns);
        let want = smoothed(&profile.places.iter().map(|x| self.visibility(*x)).collect::<Vec<_>>());
        let (got, want) = (penumbra_of(&got), penumbra_of(&want));
        Penumbra { middle: (got.middle - want.middle) / want.width, width: got.width / want.width }
    }
}

/// Means of visibility along lines that are parallel to the edge.
pub struct Profile {
    pub columns: Vec<f64>,
    /// Shares of pixels that see anything of the light.
    pub lit: Vec<f64>,
    /// Metres from below the edge.
    pub places: Vec<f64>,
    /// Of the maps.
    pub views: Vec<LightView>,
}

fn smoothed(profile: &[f64]) -> Vec<f64> {
    profile.windows(SMOOTHED).map(|some| some.iter().sum::<f64>() / SMOOTHED as f64).collect()
}

/// In columns.
fn penumbra_of(profile: &[f64]) -> Penumbra {
    Penumbra { middle: crossing(profile, 0.5), width: crossing(profile, 0.9) - crossing(profile, 0.1) }
}

/// Where the profile rises through `level`: the middle between the first and the last time that it
/// does, should noise make it several. Not a number where it never does.
pub fn crossing(profile: &[f64], level: f64) -> f64 {
    let rises = profile.windows(2).enumerate().filter(|(_, pair)| pair[0] < level && pair[1] >= level);
    let places: Vec<f64> = rises.map(|(i, pair)| i as f64 + (level - pair[0]) / (pair[1] - pair[0])).collect();
    places.first().zip(places.last()).map_or(f64::NAN, |(first, last)| 0.5 * (first + last))
}

/// Runs `make`'s technique over the cases; a line for each, and whether it is right.
fn results(cases: &[Case], mut make: impl FnMut() -> Box<dyn Technique>, gpu: &Gpu) -> Vec<(String, bool)> {
    let mut row = |case: &Case| {
        let got = case.measure(gpu, make());
        let right = got.middle.abs() <= TOLERANCE && (got.width - 1.0).abs() <= TOLERANCE;
        let Penumbra { middle, width } = got;
        (format!("{:58} width × {width:.3}, middle off by {middle:+.3} of it", case.name), right)
    };
    cases.iter().map(&mut row).collect()
}

/// Heights of the light, of the edge as a share of that, and sizes of the light as a share; with an
/// offset of the light and a turn that change from one to the next.
fn sizes() -> impl Iterator<Item = (f64, f64, f64, DVec3, f64)> {
    let lights = [2.0, 7.0].into_iter();
    let all =
        lights.flat_map(|y| [0.2, 0.5].map(|edge| (y, edge))).flat_map(|(y, e)| [0.05, 0.2, 0.4].map(|s| (y, e, s)));
    all.enumerate().map(|(i, (y, edge, size))| {
        let turn = [0.0, 0.4, 1.1, 2.3, 0.8][i % 5];
        let offset = [-0.4, 0.1, 0.6, 0.0][i % 4];
        let at = DVec3::new(offset * y, y, 0.3 * offset * y);
        (edge * y, size * y, y, DMat3::from_rotation_y(turn) * at, turn)
    })
}

/// A case for each of [`sizes`], the light made from its size, place and the way that its axes are
/// turned.
fn cases(kind: &str, light: impl Fn(f64, DVec3, DMat3) -> LightShape) -> Vec<Case> {
    sizes()
        .map(|(height, size, above, at, turn)| {
            let name = format!("{kind}, size {size:.2} at {above}, edge at {height:.2}, turned by {turn}");
            Case { name, light: light(size, at, DMat3::from_rotation_y(turn)), height, turn }
        })
        .collect()
}

fn spheres() -> Vec<Case> {
    cases("sphere", |size, position, _| LightShape::Sphere { position, radius: 0.5 * size })
}

fn ellipsoids() -> Vec<Case> {
    cases("ellipsoid", |size, position, turn| LightShape::Ellipsoid {
        position,
        radii: size * DVec3::new(0.5, 0.15, 0.3),
        rotation: turn * DMat3::from_rotation_z(0.6) * DMat3::from_rotation_x(0.4),
    })
}

/// Facing down, and tilted.
fn discs() -> Vec<Case> {
    let tilted = |tilt: f64| {
        cases(&format!("disc tilted by {tilt}"), move |size, position, turn| LightShape::Disc {
            position,
            direction: turn * (DMat3::from_rotation_z(tilt) * DVec3::NEG_Y),
            radius: 0.5 * size,
        })
    };
    tilted(0.0).into_iter().chain(tilted(-0.7).into_iter().step_by(2)).collect()
}

/// Long sides across the edge, along it, and turned; facing down, and tilted.
fn rects() -> Vec<Case> {
    let rect = |what: &str, spin: f64, tilt: f64| {
        cases(&format!("rect {what}"), move |size, position, turn| {
            let axes = turn * DMat3::from_rotation_z(tilt) * DMat3::from_rotation_y(spin);
            let (direction, up) = (axes * DVec3::NEG_Y, axes * DVec3::Z);
            LightShape::Rect { position, direction, up, size: DVec2::new(1.0, 0.25) * size, texture: None }
        })
    };
    let kinds = [("across", 0.0, 0.0), ("along", FRAC_PI_2, 0.0), ("turned", 0.7, 0.0), ("tilted", 0.4, -0.6)];
    let all = kinds.map(|(what, spin, tilt)| rect(what, spin, tilt));
    all.into_iter().enumerate().flat_map(|(i, cases)| cases.into_iter().skip(i % 2).step_by(2)).collect()
}

/// Across the edge, at an angle to it, and sloping.
fn lines() -> Vec<Case> {
    let line = |what: &str, way: DVec3| {
        cases(&format!("line {what}"), move |size, position, turn| {
            let half = turn * way.normalize() * (0.5 * size);
            LightShape::Line { from: position - half, to: position + half }
        })
    };
    let kinds = [("across", DVec3::X), ("turned", DVec3::new(0.6, 0.0, 0.8)), ("sloping", DVec3::new(0.8, 0.5, 0.3))];
    let all = kinds.map(|(what, way)| line(what, way));
    all.into_iter().enumerate().flat_map(|(i, cases)| cases.into_iter().skip(i % 2).step_by(2)).collect()
}

fn suns() -> Vec<Case> {
    let kinds = [0.5, 2.0, 8.0].into_iter().flat_map(|angle| [0.0, 0.5, -0.9].map(|tilt| (angle, tilt)));
    let all = kinds.flat_map(|(angle, tilt)| [0.5, 4.0].map(|height| (angle, tilt, height)));
    all.map(|(angle_deg, tilt, height)| {
        let turn = 0.3 + angle_deg + height;
        let direction = DMat3::from_rotation_y(turn) * (DMat3::from_rotation_z(tilt) * DVec3::new(0.0, -1.0, 0.2));
        let name = format!("sun of {angle_deg}°, tilted by {tilt}, edge at {height}");
        let light = LightShape::Directional { direction: direction.normalize(), angle_deg };
        Case { name, light, height, turn }
    })
    .collect()
}

fn every_case() -> Vec<Case> {
    [spheres(), ellipsoids(), discs(), rects(), lines(), suns()].into_iter().flatten().collect()
}

#[test]
fn brute_force_has_the_penumbrae_of_the_closed_form() {
    // So the closed form, the camera and the measurement are right.
    let gpu = gpu();
    let info = find("shadow-map").unwrap();
    let make = || light_samples(&gpu, &info.settings(&pairs("size=512")).unwrap(), 128).unwrap();
    let results = results(&every_case(), make, &gpu);
    let wrong: Vec<&str> = results.iter().filter(|(_, right)| !right).map(|(row, _)| row.as_str()).collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), results.len(), wrong.join("\n"));
}

#[test]
fn a_filter_of_constant_width_has_others() {
    // So a technique that does not know the light's size can't pass.
    let gpu = gpu();
    let info = find("pcf").unwrap();
    let make = || info.settings(&[]).unwrap().make(&gpu).unwrap();
    let right: Vec<String> =
        results(&every_case(), make, &gpu).into_iter().filter(|(_, right)| *right).map(|(row, _)| row).collect();
    assert!(right.is_empty(), "{}", right.join("\n"));
}

fn follows_the_light(cases: &[Case]) {
    let gpu = gpu();
    let mut wrong = Vec::new();
    // A grid of 5 × 5 taps, which `pcss` looks for blockers with by itself, gets the width of 2 of
    // 102 cases wrong by 0.12 and 0.13: both lights are large for their distance.
    for (id, set) in [("pcss", "search=7"), ("pcss-jitter", "")] {
        let info = find(id).unwrap();
        let make = || info.settings(&pairs(set)).unwrap().make(&gpu).unwrap();
        for (row, right) in results(cases, make, &gpu) {
            println!("{id:12} {row}");
            if !right {
                wrong.push(format!("{id}: {row}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), 2 * cases.len(), wrong.join("\n"));
}

#[test]
fn penumbrae_of_spheres_are_right() {
    follows_the_light(&spheres());
}

#[test]
fn penumbrae_of_ellipsoids_are_right() {
    follows_the_light(&ellipsoids());
}

#[test]
fn penumbrae_of_discs_are_right() {
    follows_the_light(&discs());
}

#[test]
fn penumbrae_of_rectangles_are_right() {
    follows_the_light(&rects());
}

#[test]
fn penumbrae_of_lines_are_right() {
    follows_the_light(&lines());
}

#[test]
fn penumbrae_of_suns_are_right() {
    follows_the_light(&suns());
}

/// A wide sun that is low: the floor's own plane hides a third of it, wherever the eye is.
#[test]
fn the_floor_hides_what_of_a_wide_sun_is_below_its_plane() {
    let gpu = gpu();
    let mut scene = Scene::default();
    let material = scene.add_material(Material::default());
    let (floor, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    scene.place(floor, material, DAffine3::from_scale(DVec3::splat(6.0)));
    scene.place(cube, material, DAffine3::from_translation(DVec3::new(-4.0, 0.5, -4.0)));
    let direction = DVec3::new(1.0, -0.1, 0.2).normalize();
    scene.lights.push(Light::new(LightShape::Directional { direction, angle_deg: 30.0 }));
    scene.camera = Camera { eye: DVec3::new(2.0, 3.0, 5.0), target: DVec3::ZERO, ..Camera::default() };
    for id in ["pcss", "pcss-jitter", "evsm"] {
        let set = if id == "evsm" { "softness=light" } else { "" };
        let scores = against_truth(&gpu, &scene, 0, id, set, (96, 72), 64);
        assert!(scores.mae < 0.05, "{id}: {:.4}", scores.mae);
    }
}

//! Layouts of maps for lights to all sides, how they store depth, and which surfaces they hold.

pub mod rooms;

use crate::common::{gpu, renderer, visibility};
use rooms::{LIGHT, Traced, empty_room, longest_edge, room, slab};
use umbrage::core::LightShape;
use umbrage::core::glam::DVec3;
use umbrage::core::light_view::{FARTHEST, Omni};
use umbrage::{Gpu, TechniqueInfo, find, techniques};

const OMNI: [&str; 3] = ["cube", "dual-paraboloid", "tetrahedral"];

/// All techniques with layouts.
fn filters() -> impl Iterator<Item = &'static TechniqueInfo> {
    techniques().iter().copied().filter(|info| has(info, "omni"))
}

fn has(info: &TechniqueInfo, param: &str) -> bool {
    info.params().iter().any(|p| p.name == param)
}

/// Mean absolute errors may be so many times that of a cube's faces with projective depth.
const WORST: f64 = 1.15;

/// Least percentage of interior pixels that are right.
fn least_interior(info: &TechniqueInfo) -> f64 {
    match info.id {
        // It blurs over the screen, into corners between walls, whatever the map is like.
        "pcf-blur" => 99.5,
        _ => 99.7,
    }
}

#[test]
fn maps_hold_the_distances_that_they_should() {
    let gpu = gpu();
    let scene = slab();
    let mut checked = 0;
    for (name, omni) in OMNI.into_iter().zip([Omni::Cube, Omni::DualParaboloid, Omni::Tetrahedral]) {
        for (faces, times) in [("front", 1.0), ("midpoint", 1.5), ("back", 2.0)] {
            for depth in ["projective", "linear"] {
                let set = format!("size=1024,focus=light,omni={name},faces={faces},depth={depth}");
                let mut renderer = renderer(&gpu, &scene, 0, "shadow-map", &set, (64, 48));
                renderer.frame(&scene.camera).unwrap();
                let technique = renderer.technique(0).unwrap();
                for (view, map) in technique.inside().light_views().iter().zip(technique.inside().debug_views()) {
                    let map = renderer.read_debug_view(&map).unwrap();
                    let on_top =
                        |i: i32| DVec3::new(f64::from(i % 40) / 25.0 - 0.78, -1.0, f64::from(i / 40) / 25.0 - 0.78);
                    for way in (0..1600).map(on_top).filter(|way| omni.layer_of(*way) == view.layer) {
                        let at = view.project(LIGHT + way).unwrap();
                        let texel = [at.x, -at.y].map(|x| ((0.5 * x + 0.5) * 1024.0) as u32);
                        let stored = f64::from(map[(texel[0], texel[1])]);
                        let held = if depth == "linear" { FARTHEST / (1.0 - stored) } else { stored };
                        let got = at.z / held;
                        assert!((got / times - 1.0).abs() < 0.01, "{set} {way}: {got} times as far, not {times}");
                        checked += 1;
                    }
                }
            }
        }
    }
    assert_eq!(checked, 3 * 3 * 2 * 1600);
}

/// Scores one filter in all layouts, depths and faces; what is not as it should be.
fn all_layouts(gpu: &Gpu, traced: &Traced, info: &TechniqueInfo, more: &str) -> Vec<String> {
    let usual = traced.score(gpu, info.id, &format!("size=1024{more}"));
    // Moments are taken of a linear depth of their own.
    let depths: &[_] = if has(info, "depth") { &[",depth=projective", ",depth=linear"] } else { &[""] };
    let mut wrong = Vec::new();
    for faces in ["front", "back", "midpoint"] {
        for omni in OMNI {
            for depth in depths {
                let set = format!("faces={faces},omni={omni}{depth}{more}");
                let s = traced.score(gpu, info.id, &format!("size=1024,{set}"));
                let (times, inside) = (s.mae / usual.mae, s.interior_pct.unwrap_or(0.0));
                let row = format!("{:12} {set:60} mae {:.5}, × {times:.3}, interior {inside:.3} %", info.id, s.mae);
                println!("{row}");
                if times > WORST || inside < least_interior(info) || s.not_finite > 0 {
                    wrong.push(row);
                }
            }
        }
    }
    wrong
}

#[test]
fn every_filter_is_as_good_in_every_layout() {
    let gpu = gpu();
    let sphere = LightShape::Sphere { position: LIGHT, radius: 0.06 };
    let traced = Traced::new(room(16, sphere), (160, 120), 256);
    let mut wrong: Vec<_> = filters().flat_map(|info| all_layouts(&gpu, &traced, info, "")).collect();
    let pcf = find("pcf").unwrap();
    wrong.extend(all_layouts(&gpu, &traced, pcf, ",kernel=7"));
    assert!(wrong.is_empty(), "{}:\n{}", wrong.len(), wrong.join("\n"));
}

/// Places where no light should be but some will.
const ODD: [(&str, DVec3); 6] = [
    ("in a corner of the table", DVec3::new(0.65, 0.78, 0.6)),
    ("inside of the table", DVec3::new(0.0, 0.75, 0.0)),
    ("on the floor", DVec3::new(0.5, 0.0, 1.0)),
    ("below the floor", DVec3::new(0.0, -1.0, 0.0)),
    ("at the eye", DVec3::new(2.4, 2.3, 2.6)),
    ("far away", DVec3::new(1e6, 3e6, 0.0)),
];

#[test]
fn odd_places_give_shares_in_every_layout() {
    let gpu = gpu();
    let scene = room(2, LightShape::Point { position: LIGHT });
    let mut wrong = Vec::new();
    for info in filters() {
        for omni in &OMNI[1..] {
            for more in if has(info, "depth") { &["", ",depth=linear", ",focus=light"][..] } else { &[""] } {
                let set = format!("size=128,omni={omni}{more}");
                let mut renderer = renderer(&gpu, &scene, 0, info.id, &set, (64, 48));
                for (what, position) in ODD {
                    for shape in [LightShape::Point { position }, LightShape::Sphere { position, radius: 0.3 }] {
                        renderer.light_mut(0).unwrap().shape = shape;
                        let seen = visibility(&mut renderer, &scene);
                        let faults = seen.data.iter().filter(|v| !(0.0..=1.0).contains(*v)).count();
                        if faults > 0 {
                            wrong.push(format!("{:12} {set} {what}: {faults} pixels", info.id));
                        }
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn walls_around_the_light_are_lit_across_all_seams() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    // Of the floor, two walls and the ceiling, each without its edges: there a filter of constant
    // width darkens corners.
    let looks = [
        (DVec3::new(0.2, 7.0, -0.1), DVec3::new(0.0, 0.0, -0.1)),
        (DVec3::new(0.4, 4.0, 0.2), DVec3::new(0.5, 4.1, -6.0)),
        (DVec3::new(-0.3, 3.9, 0.1), DVec3::new(6.0, 4.0, -0.6)),
        (DVec3::new(0.1, 1.0, 0.3), DVec3::new(-0.1, 8.0, 0.2)),
    ];
    let position = DVec3::new(0.1, 4.2, -0.15);
    for (parts, light) in [(4, LightShape::Point { position }), (16, LightShape::Sphere { position, radius: 0.2 })] {
        let mut scene = empty_room(DVec3::new(12.0, 8.0, 12.0), parts, light);
        scene.camera.fov_y_deg = 52.0;
        for info in filters() {
            for omni in OMNI {
                for more in ["focus=visible", "focus=light", "faces=midpoint"] {
                    let set = format!("size=512,omni={omni},{more}");
                    let mut renderer = renderer(&gpu, &scene, 0, info.id, &set, (160, 120));
                    for (eye, target) in looks {
                        (scene.camera.eye, scene.camera.target) = (eye, target);
                        let seen = visibility(&mut renderer, &scene);
                        let least = seen.data.iter().copied().fold(f32::INFINITY, f32::min);
                        let dark = seen.data.iter().filter(|v| **v < 0.999).count();
                        if dark > 0 {
                            wrong.push(format!("{:12} {set} towards {target}: {dark} pixels, {least}", info.id));
                        }
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}:\n{}", wrong.len(), wrong.join("\n"));
}

/// Parts of each edge, and the mean absolute error of a hard shadow map on paraboloids ×10⁻⁴: a
/// quarter for half the length, until it is that of the texels.
const SPLIT: [(u32, f64); 6] = [(1, 460.0), (2, 145.0), (4, 40.0), (8, 10.5), (16, 5.3), (32, 4.2)];

#[test]
fn paraboloids_need_short_edges() {
    let gpu = gpu();
    let mut wrong = Vec::new();
    for (parts, stated) in SPLIT {
        let scene = room(parts, LightShape::Point { position: LIGHT });
        let edge = longest_edge(&scene);
        let traced = Traced::new(scene, (320, 240), 1);
        for omni in OMNI {
            let s = traced.score(&gpu, "shadow-map", &format!("size=2048,omni={omni}"));
            let (mae, inside) = (s.mae * 1e4, s.interior_pct.unwrap_or(0.0));
            let row = format!(
                "edges up to {edge:6.2}°: {omni:16} mae {mae:6.2}e-4, correct {:.3} %, interior {inside:.3} %",
                s.correct_pct
            );
            println!("{row}");
            let is_as_stated = match omni {
                "dual-paraboloid" => (0.8 * stated..=stated).contains(&mae) && (inside == 100.0 || edge > 60.0),
                _ => mae < 3.0 && inside == 100.0,
            };
            if !is_as_stated {
                wrong.push(row);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

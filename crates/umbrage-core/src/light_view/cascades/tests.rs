use super::*;
use crate::camera::Camera;
use crate::light_view::Focus;

fn camera(eye: DVec3, target: DVec3) -> CameraView {
    Camera { eye, target, ..Camera::default() }.view(640, 480)
}

fn scene() -> FitScene {
    let floor = Bounds { min: DVec3::new(-200.0, -1.0, -200.0), max: DVec3::new(200.0, 0.0, 200.0) };
    let tower = |x: f64, z: f64| Bounds { min: DVec3::new(x, 0.0, z), max: DVec3::new(x + 4.0, 30.0, z + 4.0) };
    let casters = vec![tower(0.0, 0.0), tower(-60.0, -60.0), tower(50.0, -120.0)];
    let receivers = casters.iter().copied().chain([floor]).collect();
    FitScene::new(casters, receivers)
}

const SUN: LightShape = LightShape::Directional { direction: DVec3::new(0.48, -0.8, 0.36), angle_deg: 0.0 };
const FIT: Fit = Fit { focus: Focus::Visible, omni: Omni::Cube, size: 1024, border_texels: 2.0, border_m: 0.0 };
const COVERS: [Cover; 3] = [Cover::Receivers, Cover::Part, Cover::Steady { step_texels: 1.0 }];

fn lamp() -> LightShape {
    let direction = DVec3::new(0.1, -1.0, -0.2).normalize();
    LightShape::Spot { position: DVec3::new(0.0, 400.0, 0.0), direction, inner_angle_deg: 30.0, outer_angle_deg: 35.0 }
}

fn cascades(cover: Cover) -> Cascades {
    Cascades { count: 4, lambda: 0.5, overlap: 0.1, distance: 0.0, cover }
}

fn fitted(light: &LightShape, camera: &CameraView, cover: Cover) -> (Vec<LightView>, Vec<f64>) {
    let (mut views, mut borders) = (Vec::new(), Vec::new());
    assert!(fit_cascades(light, camera, &scene(), &cascades(cover), &FIT, &mut views, &mut borders).is_none());
    (views, borders)
}

/// Points of receivers that the camera sees.
fn seen_points(camera: &CameraView) -> Vec<DVec3> {
    let mut points = Vec::new();
    for x in -40..40 {
        for z in -40..40 {
            points.push(DVec3::new(f64::from(x) * 4.9, 0.0, f64::from(z) * 4.9));
        }
    }
    let seen = camera.frustum();
    points.retain(|p| seen.holds(&Bounds { min: *p, max: *p }));
    assert!(points.len() > 100);
    points
}

#[test]
fn every_part_covers_what_is_seen_in_it_and_in_the_overlap_before_it() {
    let camera = camera(DVec3::new(-150.0, 8.0, 20.0), DVec3::new(0.0, 0.0, 0.0));
    for light in [SUN, lamp()] {
        for cover in COVERS {
            let (views, borders) = fitted(&light, &camera, cover);
            assert_eq!((views.len(), borders.len()), (4, 5), "{cover:?}");
            for p in seen_points(&camera) {
                let distance = camera.forward().dot(p - camera.eye);
                let first = borders[1..4].iter().filter(|b| distance >= **b).count();
                let into_next =
                    first < 3 && distance > borders[first + 1] - 0.1 * (borders[first + 1] - borders[first]);
                for view in &views[first..=first + usize::from(into_next)] {
                    let at = view.project(p).unwrap();
                    let inside = at.truncate().abs().max_element() <= 1.0 - 3.9 / 1024.0 && (0.0..=1.0).contains(&at.z);
                    assert!(inside, "{light:?} {cover:?} layer {}: {p} at {at}", view.layer);
                }
            }
        }
    }
}

#[test]
fn every_caster_is_in_front_of_the_far_side_of_every_part() {
    let camera = camera(DVec3::new(-150.0, 8.0, 20.0), DVec3::ZERO);
    for cover in COVERS {
        let (views, _) = fitted(&SUN, &camera, cover);
        let corners: Vec<DVec3> = scene().casters.iter().flat_map(Bounds::corners).collect();
        for view in &views {
            assert!(corners.iter().all(|c| view.project(*c).unwrap().z <= 1.0), "{cover:?}");
        }
    }
}

#[test]
fn tighter_covers_have_smaller_texels() {
    let camera = camera(DVec3::new(-150.0, 8.0, 20.0), DVec3::ZERO);
    let texel = |cover| fitted(&SUN, &camera, cover).0[3].clip_from_world.row(0).truncate().length().recip();
    let [receivers, part, steady] = COVERS.map(texel);
    assert!(receivers <= part * 1.001 && part <= steady, "{receivers} {part} {steady}");
}

/// Where in its texel a point lies.
fn in_texel(view: &LightView, point: DVec3) -> [f64; 2] {
    let at = view.project(point).unwrap() * 0.5 * f64::from(view.size);
    [at.x, at.y].map(|v| v - v.floor())
}

#[test]
fn texels_of_steady_views_stay_where_they_are_when_the_camera_moves_and_turns() {
    let point = DVec3::new(3.3, 0.0, -7.7);
    for light in [SUN, lamp()] {
        let mut before: Option<Vec<LightView>> = None;
        for i in 0..200 {
            let turn = f64::from(i) * 0.003;
            let eye = DVec3::new(-60.0 + f64::from(i) * 0.013, 9.0, 4.0);
            let ahead = DVec3::new(turn.cos(), -0.1, turn.sin());
            let (views, _) = fitted(&light, &camera(eye, eye + ahead), Cover::Steady { step_texels: 1.0 });
            let same_scale = |a: &LightView, b: &LightView| {
                (a.clip_from_world.row(0).truncate() - b.clip_from_world.row(0).truncate()).length() < 1e-12
            };
            for (a, b) in before.iter().flatten().zip(&views) {
                // A spot's views come in sizes.
                if matches!(light, LightShape::Spot { .. }) && !same_scale(a, b) {
                    continue;
                }
                let (a, b) = (in_texel(a, point), in_texel(b, point));
                let apart = |i: usize| (a[i] - b[i]).abs().min(1.0 - (a[i] - b[i]).abs());
                assert!(apart(0) < 1e-6 && apart(1) < 1e-6, "frame {i}: {a:?} {b:?}");
            }
            before = Some(views);
        }
    }
}

#[test]
fn steady_views_in_large_steps_are_the_same_to_the_last_bit_within_a_step() {
    let cover = Cover::Steady { step_texels: 64.0 };
    let mut changes = 0;
    let mut before = None;
    for i in 0..100 {
        // A metre in all; the texels of the first part are some centimetres.
        let eye = DVec3::new(-60.0 + f64::from(i) * 0.01, 9.0, 4.0);
        let (views, _) = fitted(&SUN, &camera(eye, eye + DVec3::new(1.0, -0.1, 0.0)), cover);
        changes += usize::from(before.replace(views.clone()).is_some_and(|b| b != views));
    }
    assert!(changes <= 5, "{changes}");
}

#[test]
fn odd_ranges_give_views_that_are_finite() {
    let camera = camera(DVec3::new(-150.0, 8.0, 20.0), DVec3::ZERO);
    for cover in COVERS {
        for (count, distance) in [(1, 0.0), (9, 0.0), (4, 1e-9), (4, 1e9), (0, 0.0), (10, 10.0)] {
            let (mut views, mut borders) = (Vec::new(), Vec::new());
            let cascades = Cascades { count, distance, ..cascades(cover) };
            fit_cascades(&SUN, &camera, &scene(), &cascades, &FIT, &mut views, &mut borders);
            assert!(views.iter().all(|v| v.clip_from_world.is_finite()), "{cover:?} {count} {distance}");
            assert!(views.len() < borders.len());
        }
    }
    let nothing = FitScene::default();
    let (mut views, mut borders) = (Vec::new(), Vec::new());
    fit_cascades(&SUN, &camera, &nothing, &cascades(COVERS[2]), &FIT, &mut views, &mut borders);
    assert!(views.is_empty() && borders.is_empty());
}

#[test]
fn lights_to_all_sides_have_no_parts() {
    let light = LightShape::Point { position: DVec3::new(0.0, 40.0, 0.0) };
    let camera = camera(DVec3::new(-150.0, 8.0, 20.0), DVec3::ZERO);
    let (mut views, mut borders) = (Vec::new(), Vec::new());
    let omni = fit_cascades(&light, &camera, &scene(), &cascades(COVERS[0]), &FIT, &mut views, &mut borders);
    assert_eq!(omni, Some(Omni::Cube));
    assert!(borders.is_empty() && !views.is_empty());
}

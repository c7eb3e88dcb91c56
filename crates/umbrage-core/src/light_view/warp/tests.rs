use super::*;
use crate::bounds::Bounds;
use crate::camera::Camera;
use crate::light_view::{Focus, fit, texel_on_screen};

const WARPS: [Warp; 7] = [
    Warp::PostPerspective { shift: true, near: 0.0, cube: false },
    Warp::PostPerspective { shift: false, near: 0.0, cube: false },
    Warp::PostPerspective { shift: true, near: 0.0, cube: true },
    Warp::PostPerspective { shift: false, near: 0.0, cube: true },
    Warp::LightSpace { strength: 1.0 },
    Warp::Plane { plane: None, gives_way: true },
    Warp::Plane { plane: None, gives_way: false },
];

const FIT: Fit = Fit { focus: Focus::Visible, omni: Omni::Cube, size: 1024, border_texels: 2.0, border_m: 0.0 };

/// A small generator, so that tests need no crate.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1_u64 << 31) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn direction(&mut self) -> DVec3 {
        let (y, angle) = (self.between(-1.0, 1.0), self.between(0.0, std::f64::consts::TAU));
        let around = (1.0 - y * y).sqrt();
        DVec3::new(around * angle.cos(), y, around * angle.sin())
    }
}

/// Streets of boxes on a floor, `extent` metres across.
fn town(random: &mut Random, extent: f64) -> FitScene {
    let floor = Bounds { min: DVec3::new(-extent, 0.0, -extent), max: DVec3::new(extent, 0.0, extent) };
    let house = |i: i32, j: i32, random: &mut Random| {
        let at = DVec3::new(f64::from(i), 0.0, f64::from(j)) * (extent / 5.0);
        let half = DVec3::new(0.06, 0.0, 0.06) * extent;
        let top = DVec3::Y * extent * random.between(0.05, 0.3);
        Bounds { min: at - half, max: at + half + top }
    };
    let mut boxes = Vec::new();
    for i in -4..=4 {
        for j in -4..=4 {
            boxes.push(house(i, j, random));
        }
    }
    let casters = boxes.clone();
    boxes.push(floor);
    FitScene::new(casters, boxes)
}

fn camera_in(random: &mut Random, extent: f64) -> CameraView {
    let mut within = |share: f64| random.between(-share, share) * extent;
    let eye = DVec3::new(within(0.9), 0.0, within(0.9));
    let target = DVec3::new(within(0.9), within(0.05), within(0.9));
    let eye = eye + DVec3::Y * (0.003 + 0.3 * random.next().powi(4)) * extent;
    Camera { eye, target, fov_y_deg: random.between(20.0, 100.0), near: 1e-4 * extent, ..Camera::default() }.view(4, 3)
}

fn lights(random: &mut Random, extent: f64) -> Vec<LightShape> {
    let (direction, aim) = (random.direction(), random.direction());
    let direction = direction.with_y(-direction.y.abs() - 0.02).normalize();
    let position = DVec3::new(random.between(-1.0, 1.0), random.between(0.05, 1.0), random.between(-1.0, 1.0)) * extent;
    vec![
        LightShape::Directional { direction, angle_deg: 0.0 },
        LightShape::Point { position },
        LightShape::Spot { position, direction: aim, inner_angle_deg: 20.0, outer_angle_deg: 40.0 },
        LightShape::Spot {
            position: position * 2.0,
            direction: DVec3::NEG_Y,
            inner_angle_deg: 20.0,
            outer_angle_deg: 40.0,
        },
    ]
}

/// Some points that the camera sees of the receivers: of their boxes' corners and between them.
fn seen_points(camera: &CameraView, scene: &FitScene, random: &mut Random) -> Vec<DVec3> {
    let seen = camera.frustum();
    let points = visible(&seen, scene);
    let mut all = points.clone();
    let mut corners = Vec::new();
    for bounds in &scene.receivers {
        corners.clear();
        seen.clip_box(bounds, &mut corners);
        for _ in 0..corners.len() {
            let any = |r: &mut Random| corners[((r.next() * corners.len() as f64) as usize).min(corners.len() - 1)];
            let (a, b, c) = (any(random), any(random), any(random));
            all.push(a.lerp(b, random.next()).lerp(c, random.next()));
        }
    }
    all.into_iter().step_by(7).collect()
}

/// The layers that may hold a point.
fn covering<'a>(views: &'a [LightView], omni: Option<Omni>, light: &LightShape, p: DVec3) -> Vec<&'a LightView> {
    let layer = omni.map(|o| o.layer_of(p - light.center().truncate()));
    let inside = |v: &&LightView| {
        layer.is_none_or(|l| l == v.layer) && v.project(p).is_some_and(|n| n.truncate().abs().max_element() <= 1.0)
    };
    views.iter().filter(inside).collect()
}

#[test]
fn what_is_seen_is_covered_and_depth_falls_away_from_the_light() {
    let mut random = Random(1);
    let mut checked = 0;
    for round in 0..24 {
        let extent = [1.0, 100.0, 3000.0][round % 3];
        let scene = town(&mut random, extent);
        let camera = camera_in(&mut random, extent);
        let points = seen_points(&camera, &scene, &mut random);
        for light in lights(&mut random, extent) {
            for warp in WARPS {
                let mut views = Vec::new();
                let omni = fit_warped(&light, &camera, &scene, &warp, &FIT, &mut views);
                for view in &views {
                    assert!(!is_mirrored(view), "{round} {light:?} {warp:?}: mirrored");
                }
                for &p in &points {
                    let at = covering(&views, omni, &light, p);
                    let name = format!("{round} {light:?} {warp:?} {p}");
                    assert!(!at.is_empty(), "{name}: {:?}", views.iter().map(|v| v.project(p)).collect::<Vec<_>>());
                    for view in at {
                        check_ray(view, &light, &scene, p, &name);
                    }
                    checked += 1;
                }
            }
        }
    }
    assert!(checked > 10_000, "{checked}");
}

/// Whether a triangle that turns one way as the light sees it turns the other way in the map.
fn is_mirrored(view: &LightView) -> bool {
    let [x, y, w] = [0, 1, 3].map(|i| view.clip_from_world.row(i).truncate());
    let ahead = if w == DVec3::ZERO || view.is_warped() { -view.clip_from_world.row(2).truncate() } else { w };
    x.cross(y).dot(ahead) > 0.0
}

/// Every point of a caster between `p` and the light is at the same place of the map, farther in
/// front, and not beyond its near end.
fn check_ray(view: &LightView, light: &LightShape, scene: &FitScene, p: DVec3, name: &str) {
    let center = light.center();
    let (way, end) = match center.w {
        0.0 => (center.truncate(), f64::INFINITY),
        _ => (center.truncate() - p, 1.0 - 1e-3),
    };
    let here = view.project(p).unwrap();
    assert!(here.z >= -1e-9, "{name}: {here}");
    let mut last = here.z;
    let mut distances: Vec<f64> = scene.casters.iter().flat_map(|b| span(p, way, b)).filter(|t| *t < end).collect();
    distances.sort_by(f64::total_cmp);
    for t in distances {
        let clip = view.clip_from_world * (p + way * t).extend(1.0);
        assert!(clip.w > 0.0, "{name}: flips at {t}");
        let there = clip.truncate() / clip.w;
        assert!((there - here).truncate().length() < 1e-6, "{name}: {here} {there}");
        assert!(there.z > last - 1e-12 && there.z <= 1.0, "{name}: {last} {there}");
        last = there.z;
    }
}

/// Where a ray enters and leaves a box, if after its start.
fn span(p: DVec3, way: DVec3, bounds: &Bounds) -> Vec<f64> {
    let (a, b) = ((bounds.min - p) / way, (bounds.max - p) / way);
    let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
    if enter < leave { [enter, leave].into_iter().filter(|t| *t > 0.0).collect() } else { Vec::new() }
}

/// Mean of what texels reach on the screen, over what a grid of rays other than the fit's sees, by
/// the light that places get.
fn mean_texel(views: &[LightView], camera: &CameraView, scene: &FitScene, toward_light: DVec3) -> Option<f64> {
    let tilted =
        Camera { eye: camera.eye, target: camera.eye + camera.forward(), fov_y_deg: 50.0, ..Camera::default() };
    let tilted = CameraView { clip_from_view: tilted.clip_from_view(1.1), ..*camera };
    let places = surfaces(&tilted, &tilted.frustum(), &scene.receivers);
    let lit = places.iter().filter(|s| s.normal.dot(toward_light) > 0.0);
    let sizes = lit.filter_map(|s| {
        let weight = s.normal.dot(toward_light);
        Some((weight, weight * texel_on_screen(views, &[], camera, (512, 384), s.point, s.normal)?))
    });
    let (count, weight, sum) = sizes.fold((0, 0.0, 0.0), |(n, w, s), (weight, size)| (n + 1, w + weight, s + size));
    (count > 20).then(|| sum / weight)
}

/// Along a street, a fifth of what is seen near.
fn street(random: &mut Random) -> CameraView {
    let eye = DVec3::new(24.0, random.between(1.0, 30.0), random.between(20.0, 120.0));
    let ahead = DVec3::new(random.between(-0.4, 0.4), random.between(-0.2, 0.1), -1.0);
    Camera { eye, target: eye + ahead, fov_y_deg: 62.0, near: 0.1, ..Camera::default() }.view(4, 3)
}

#[test]
fn a_perspective_map_is_never_worse_than_a_uniform_one() {
    let mut random = Random(7);
    let scene = town(&mut random, 250.0);
    let mut camera = street(&mut random);
    let mut uniform = Vec::new();
    let mut ratios = [(); 3].map(|()| Vec::new());
    while ratios[0].len() < 200 {
        let direction = random.direction();
        let direction = direction.with_y(-direction.y.abs()).normalize();
        let light = LightShape::Directional { direction, angle_deg: 0.0 };
        fit(&light, &camera.frustum(), &scene, &FIT, &mut uniform);
        let Some(plain) = mean_texel(&uniform, &camera, &scene, -direction) else { continue };
        for (warp, ratios) in [WARPS[0], WARPS[4], WARPS[5]].iter().zip(&mut ratios) {
            let mut views = Vec::new();
            fit_warped(&light, &camera, &scene, warp, &FIT, &mut views);
            ratios.push(mean_texel(&views, &camera, &scene, -direction).unwrap() / plain);
        }
        let psm = ratios[0][ratios[0].len() - 1];
        assert!(psm <= 1.1, "{direction}: {psm} times the texels of a uniform map");
        if ratios[0].len() % 50 == 0 {
            camera = street(&mut random);
        }
    }
    let medians = ratios.map(|mut r| {
        r.sort_by(f64::total_cmp);
        println!("{:.3}, median {:.3}, {:.3}", r[0], r[100], r[199]);
        r[100]
    });
    assert!(medians[0] < 0.5 && medians[1] < 0.6 && medians[2] < 0.7, "{medians:?}");
}

#[test]
fn a_light_across_the_view_leaves_no_perspective_at_all() {
    // Then the light is parallel in post-perspective space, and the distance from the horizon is
    // that along the view.
    let mut random = Random(3);
    let scene = town(&mut random, 50.0);
    let eye = DVec3::new(5.0, 2.0, 40.0);
    let camera = Camera { eye, target: eye - DVec3::Z, ..Camera::default() }.view(4, 3);
    let light = LightShape::Directional { direction: DVec3::new(0.6, -0.8, 0.0), angle_deg: 0.0 };
    for warp in [WARPS[1], Warp::Plane { plane: Some(DVec4::Y), gives_way: false }] {
        let mut views = Vec::new();
        fit_warped(&light, &camera, &scene, &warp, &FIT, &mut views);
        let w = |distance: f64| (views[0].clip_from_world * (eye - DVec3::Z * distance).extend(1.0)).w;
        assert!(views[0].is_warped() && (w(20.0) / w(10.0) - 2.0).abs() < 1e-9, "{warp:?}: {} {}", w(20.0), w(10.0));
    }
}

#[test]
fn texels_on_the_plane_are_the_same_all_over_the_screen() {
    let mut random = Random(5);
    let scene = town(&mut random, 100.0);
    let plane = Some(DVec4::Y);
    let mut checked = 0;
    for _ in 0..20 {
        let camera = camera_in(&mut random, 100.0);
        for light in &lights(&mut random, 100.0)[..1] {
            let mut views = Vec::new();
            fit_warped(light, &camera, &scene, &Warp::Plane { plane, gives_way: false }, &FIT, &mut views);
            let points = seen_points(&camera, &scene, &mut random).into_iter().filter(|p| p.y == 0.0);
            let sizes: Vec<f64> =
                points.filter_map(|p| texel_on_screen(&views, &[], &camera, (400, 300), p, DVec3::Y)).collect();
            // What stands on the plane can ask for another horizon; then there is nothing to check.
            let Some(view) = views.first() else { continue };
            let ahead = camera.forward().extend(-camera.forward().dot(camera.eye));
            let w = view.clip_from_world.row(3);
            let light = light.center();
            let ideal = ahead * light.y - DVec4::Y * ahead.dot(light);
            if (w / w.truncate().length() - ideal / ideal.truncate().length()).length() < 1e-6 {
                let [low, high] = sizes.iter().fold([f64::INFINITY, 0.0_f64], |[l, h], s| [l.min(*s), h.max(*s)]);
                assert!(high <= low * (1.0 + 1e-5), "{low} to {high}");
                checked += usize::from(sizes.len() > 10);
            }
        }
    }
    assert!(checked >= 3, "{checked}");
}

#[test]
fn errors_of_light_space_maps_grow_by_the_root_of_the_ratio_of_distances() {
    // A light from above, a narrow view over a strip from 4 to 100 m: √25.
    let strip = Bounds { min: DVec3::new(-0.01, 0.0, -100.0), max: DVec3::new(0.01, 0.0, -4.0) };
    let scene = FitScene::new(vec![strip], vec![strip]);
    let eye = DVec3::Y * 0.001;
    let camera = Camera { eye, target: eye - DVec3::Z, ..Camera::default() }.view(4, 3);
    let light = LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 };
    for (strength, ratio) in [(0.0, 1.0), (0.5, 3.0), (1.0, 5.0)] {
        let mut views = Vec::new();
        fit_warped(&light, &camera, &scene, &Warp::LightSpace { strength }, &FIT, &mut views);
        let w = |z: f64| (views[0].clip_from_world * DVec4::new(0.0, 0.0, z, 1.0)).w;
        assert!((w(-100.0) / w(-4.0) - ratio).abs() < 1e-6, "{} for {ratio}", w(-100.0) / w(-4.0));
    }
}

#[test]
fn odd_scenes_lights_and_cameras_give_finite_views() {
    let mut random = Random(11);
    let scene = town(&mut random, 10.0);
    let point = Bounds { min: DVec3::Y, max: DVec3::Y };
    let around = FitScene::new(vec![Bounds { min: DVec3::splat(-5.0), max: DVec3::splat(5.0) }], vec![point]);
    let no_casters = FitScene::new(Vec::new(), scene.receivers.clone());
    let cameras = [DVec3::NEG_Z, DVec3::NEG_Y, DVec3::new(0.0, -1.0, -1e-9)].map(|way| {
        let eye = DVec3::new(0.5, 3.0, 0.5);
        Camera { eye, target: eye + way, ..Camera::default() }.view(4, 3)
    });
    for scene in [&scene, &around, &no_casters, &FitScene::default()] {
        for camera in &cameras {
            let forward = camera.forward();
            let sun = |direction: DVec3| LightShape::Directional { direction, angle_deg: 0.5 };
            let mut lights = [forward, -forward, DVec3::X, DVec3::Y].map(sun).to_vec();
            lights.extend([camera.eye, DVec3::Y, DVec3::ZERO].map(|position| LightShape::Point { position }));
            for light in lights {
                for warp in WARPS {
                    let mut views = Vec::new();
                    fit_warped(&light, camera, scene, &warp, &FIT, &mut views);
                    let seen = !visible(&camera.frustum(), scene).is_empty();
                    assert!(light.center().w == 1.0 || seen != views.is_empty(), "{light:?} {warp:?}");
                    assert!(views.iter().all(|v| v.clip_from_world.is_finite()), "{light:?} {warp:?}");
                }
            }
        }
    }
}

#[test]
fn a_horizon_along_the_axis_of_a_face_shows_all_places_apart() {
    // Under a lamp beside the view, the best horizon of the floor holds the axes of two faces.
    let camera = Camera { eye: DVec3::new(0.0, 3.0, 12.0), target: DVec3::ZERO, fov_y_deg: 50.0, ..Camera::default() };
    let floor = Bounds { min: DVec3::new(-30.0, 0.0, -30.0), max: DVec3::new(30.0, 0.0, 30.0) };
    let scene = FitScene::new(vec![floor], vec![floor]);
    let light = LightShape::Point { position: DVec3::new(4.0, 12.0, -3.0) };
    let warp = Warp::Plane { plane: None, gives_way: false };
    let mut views = Vec::new();
    fit_warped(&light, &camera.view(240, 180), &scene, &warp, &FIT, &mut views);
    assert!(views.len() > 2, "{}", views.len());
    for view in &views {
        let rows = [0, 1, 3].map(|i| view.clip_from_world.row(i).truncate().normalize());
        let volume = rows[0].cross(rows[1]).dot(rows[2]);
        assert!(volume.abs() > 1e-4, "layer {}: {volume}", view.layer);
    }
}

use super::*;
use crate::camera::{Camera, CameraView};
use glam::DVec2;

mod omni;

const OMNI: [Omni; 3] = [Omni::Cube, Omni::Tetrahedral, Omni::DualParaboloid];

fn floor() -> Bounds {
    Bounds { min: DVec3::new(-5.0, 0.0, -5.0), max: DVec3::new(5.0, 0.0, 5.0) }
}

fn crate_above() -> Bounds {
    Bounds { min: DVec3::new(-1.0, 1.0, -1.0), max: DVec3::new(1.0, 2.0, 1.0) }
}

fn scene() -> FitScene {
    FitScene::new(vec![crate_above()], vec![floor(), crate_above()])
}

fn fit_of(light: &LightShape, focus: Focus, omni: Omni, border_texels: f64) -> (Vec<LightView>, Option<Omni>) {
    let camera = Camera { eye: DVec3::new(0.0, 6.0, 12.0), ..Camera::default() };
    let mut views = Vec::new();
    let fit_to = Fit { focus, omni, size: 512, border_texels, border_m: 0.0 };
    let layers = fit(light, &camera.view(640, 480).frustum(), &scene(), &fit_to, &mut views);
    (views, layers)
}

fn ndc(view: &LightView, p: DVec3) -> DVec3 {
    view.project(p).unwrap_or(DVec3::INFINITY)
}

#[test]
fn a_directional_view_holds_receivers_and_reaches_back_to_casters() {
    let light = LightShape::Directional { direction: DVec3::new(0.3, -1.0, 0.2).normalize(), angle_deg: 0.0 };
    for focus in [Focus::Light, Focus::Visible] {
        let (views, layers) = fit_of(&light, focus, Omni::Cube, 4.0);
        assert!(views.len() == 1 && layers.is_none());
        let limit = 1.0 - 8.0 / 512.0 + 1e-9;
        for c in crate_above().corners() {
            let n = ndc(&views[0], c);
            assert!(n.x.abs() <= limit && n.y.abs() <= limit && (0.0..=1.0).contains(&n.z), "{focus:?} {n}");
        }
        assert!(ndc(&views[0], DVec3::new(0.0, 2.0, 0.0)).z > ndc(&views[0], DVec3::ZERO).z, "reversed depth");
    }
}

#[test]
fn faces_that_see_no_receiver_are_left_out() {
    let light = LightShape::Point { position: DVec3::new(0.0, 30.0, 0.0) };
    let (views, _) = fit_of(&light, Focus::Visible, Omni::Cube, 0.0);
    assert_eq!(views.iter().map(|v| v.layer).collect::<Vec<_>>(), [3], "only the face that looks down");
}

#[test]
fn a_spot_covers_what_is_seen_even_outside_its_cone() {
    let spot = |direction: DVec3| LightShape::Spot {
        position: DVec3::new(0.0, 20.0, 0.0),
        direction,
        inner_angle_deg: 5.0,
        outer_angle_deg: 6.0,
    };
    let (views, layers) = fit_of(&spot(DVec3::NEG_Y), Focus::Visible, Omni::Cube, 0.0);
    assert!(views.len() == 1 && layers.is_none());
    assert!(ndc(&views[0], DVec3::new(3.0, 0.0, 0.0)).truncate().abs().max_element() <= 1.0);
    for omni in OMNI {
        let (views, layers) = fit_of(&spot(DVec3::X), Focus::Visible, omni, 0.0);
        assert!(layers == Some(omni) && !views.is_empty(), "a floor below a level spot needs several views");
    }
}

#[test]
fn nothing_to_see_needs_no_view() {
    let mut views = vec![];
    let camera = Camera::default().view(4, 3);
    let fit_to = Fit { focus: Focus::Visible, omni: Omni::Cube, size: 16, border_texels: 0.0, border_m: 0.0 };
    for light in [
        LightShape::Point { position: DVec3::ZERO },
        LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 },
    ] {
        fit(&light, &camera.frustum(), &FitScene::default(), &fit_to, &mut views);
        assert!(views.is_empty());
    }
    // All of the scene is behind the camera: no room for six faces has to be made.
    let away = Camera { eye: DVec3::new(0.0, 6.0, 12.0), target: DVec3::new(0.0, 6.0, 99.0), ..Camera::default() };
    let position = DVec3::Y * 20.0;
    let spot = LightShape::Spot { position, direction: DVec3::NEG_Y, inner_angle_deg: 5.0, outer_angle_deg: 6.0 };
    for light in [LightShape::Point { position }, spot] {
        for omni in OMNI {
            let layers = fit(&light, &away.view(4, 3).frustum(), &scene(), &Fit { omni, ..fit_to }, &mut views);
            assert!(views.is_empty() && layers.is_none(), "{light:?} {omni:?}");
        }
    }
}

#[test]
fn a_texel_seen_from_the_light_itself_is_a_pixel() {
    // The camera is an orthographic light's twin: looking straight down, map and screen of the same
    // scale.
    let light = LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 };
    let (views, _) = fit_of(&light, Focus::Light, Omni::Cube, 0.0);
    let camera = CameraView {
        eye: DVec3::Y,
        view_from_world: glam::DAffine3::IDENTITY,
        clip_from_view: views[0].clip_from_world,
    };
    let reach = texel_on_screen(&views, &[], &camera, (512, 512), DVec3::ZERO, DVec3::Y).unwrap();
    assert!((reach - 1.0).abs() < 1e-9, "{reach}");
    let coarse = texel_on_screen(&views, &[], &camera, (2048, 2048), DVec3::ZERO, DVec3::Y).unwrap();
    assert!((coarse - 4.0).abs() < 1e-9, "{coarse}");
}

#[test]
fn the_distance_along_the_view_tells_which_split_counts() {
    let light = LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 };
    let (views, _) = fit_of(&light, Focus::Light, Omni::Cube, 0.0);
    let coarse = LightView { size: views[0].size / 4, layer: 1, ..views[0].clone() };
    let views = [views[0].clone(), coarse];
    // Looks down from 1 m above the floor.
    let camera = Camera { eye: DVec3::Y, target: DVec3::ZERO, up: DVec3::Z, ..Camera::default() }.view(64, 64);
    let texel = |splits: &[f64]| texel_on_screen(&views, splits, &camera, (64, 64), DVec3::ZERO, DVec3::Y);
    let fine = texel(&[]).unwrap();
    assert_eq!(texel(&[1.5]), Some(fine));
    assert!((texel(&[0.5]).unwrap() / fine - 4.0).abs() < 1e-9);
    assert_eq!(texel(&[0.2, 0.5]), None, "there is no third layer");
}

#[test]
fn a_steady_view_counts_behind_its_split_but_not_at_its_border() {
    let light = LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 };
    let (views, _) = fit_of(&light, Focus::Light, Omni::Cube, 0.0);
    let camera = Camera { eye: DVec3::Y, target: DVec3::ZERO, up: DVec3::Z, ..Camera::default() }.view(64, 64);
    let layer = |border: Option<f64>, splits: &[f64]| {
        let fine = LightView { steady_border: border, ..views[0].clone() };
        let views = [fine.clone(), LightView { layer: 1, ..fine.clone() }, LightView { layer: 2, ..fine }];
        view_at(&views, splits, &camera, DVec3::ZERO).map(|view| view.layer)
    };
    let whole = f64::from(views[0].size);
    assert_eq!(layer(None, &[0.5]), Some(1));
    assert_eq!(layer(Some(0.0), &[0.5]), Some(0));
    assert_eq!(layer(Some(whole), &[0.5]), Some(1), "all of the map is border");
    assert_eq!(layer(Some(0.0), &[0.2, 0.5]), Some(1), "the last but one at most");
}

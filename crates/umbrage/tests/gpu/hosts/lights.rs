//! Lights and cameras as hosts' arithmetic leaves them.

use super::{Host, difference};
use crate::common::scene;
use umbrage::core::glam::{DAffine3, DMat3, DMat4, DVec2, DVec3};
use umbrage::core::{CameraView, Light, LightShape, Scene};
use umbrage::{Error, techniques};

fn lit_by(shape: LightShape) -> Scene {
    Scene { lights: vec![Light::new(shape)], ..scene("tentacles", 0.3) }
}

/// Lights that have directions, made with one of any length.
const DIRECTED: [fn(DVec3) -> LightShape; 5] = [
    |direction| LightShape::Directional { direction, angle_deg: 0.0 },
    |direction| LightShape::Directional { direction, angle_deg: 4.0 },
    |direction| {
        let position = DVec3::new(-1.0, 5.0, 1.5);
        LightShape::Spot { position, direction, inner_angle_deg: 30.0, outer_angle_deg: 40.0 }
    },
    |direction| LightShape::Disc { position: DVec3::new(-1.0, 5.0, 1.5), direction, radius: 0.3 },
    |direction| {
        // Leans as far to the light's direction as its length.
        let up = DVec3::X * direction.length() + 0.2 * direction;
        let (position, size) = (DVec3::new(-1.0, 5.0, 1.5), DVec2::new(0.4, 0.6));
        LightShape::Rect { position, direction, up, size, texture: None }
    },
];

#[test]
fn directions_need_not_be_of_unit_length() {
    let unit = DVec3::new(0.3, -1.0, -0.2).normalize();
    for id in ["shadow-map", "cascaded", "volume", "wedges", "projective"] {
        let info = umbrage::find(id).unwrap();
        for light in DIRECTED.iter().filter(|light| info.supports(light(unit).kind()).is_ok()) {
            let mut host = Host::new(&lit_by(light(unit)), id, "");
            let right = host.frame();
            let mut of_length = |length: f64| {
                host.scene.lights[0].shape = light(unit * length);
                host.frame()
            };
            // `wedges` adds halves of floats, which may be off by a few of their steps.
            let double = of_length(2.0);
            let off = difference(&double, &right);
            assert!(off < 2e-3, "{id}, {:?}: off by {off}", light(unit).kind());
            // Powers of two leave the direction as it is, to the last bit.
            for length in [0.125, 32.0] {
                let off = difference(&of_length(length), &double);
                assert!(off < 2e-3, "{id}, {:?} of length {length}: off by {off}", light(unit).kind());
            }
            host.assert_quiet();
        }
    }
}

#[test]
fn lights_that_can_not_shine_are_errors_of_every_technique() {
    let (position, direction) = (DVec3::new(0.0, f64::NAN, 0.0), DVec3::NEG_Y);
    let broken = [
        (LightShape::Point { position }, "NaN"),
        (LightShape::Point { position: DVec3::INFINITY }, "inf"),
        (LightShape::Directional { direction: DVec3::ZERO, angle_deg: 0.0 }, "[0, 0, 0]"),
        (LightShape::Directional { direction: DVec3::NAN, angle_deg: 0.0 }, "NaN"),
        (LightShape::Directional { direction, angle_deg: f64::INFINITY }, "inf°"),
        (LightShape::Sphere { position: DVec3::Y, radius: f64::NAN }, "NaN m"),
        (LightShape::Sphere { position: DVec3::Y, radius: -0.5 }, "-0.5 m"),
    ];
    let mut host = Host::new(&scene("tentacles", 0.3), "none", "");
    for info in techniques() {
        host.technique = info.default_settings().make(&host.gpu).unwrap();
        for (shape, says) in broken.iter().filter(|(shape, _)| info.supports(shape.kind()).is_ok()) {
            host.scene.lights[0] = Light::new(shape.clone());
            match host.record() {
                Err(Error::Light(text)) => assert!(text.contains(says), "{}: {text} should say {says}", info.id),
                other => panic!("{}: {shape:?} gives {:?}", info.id, other.map(|_| ())),
            }
        }
    }
    host.assert_quiet();
}

#[test]
fn a_texture_that_the_view_lacks_is_an_error() {
    let rect = |direction| LightShape::Rect {
        position: DVec3::Y * 5.0,
        direction,
        up: DVec3::Z,
        size: DVec2::ONE,
        texture: Some(0),
    };
    let mut host = Host::new(&lit_by(rect(DVec3::NEG_Y)), "pcss", "");
    assert!(matches!(host.record(), Err(Error::Light(text)) if text.contains("texture 0 of 0")));
}

#[test]
fn cameras_that_see_nothing_are_errors_of_every_technique() {
    let mut host = Host::new(&scene("tentacles", 0.3), "none", "");
    let right = host.camera;
    let with_view = |view| CameraView::from_matrices(view, right.clip_from_view);
    let with_projection = |projection| CameraView::from_matrices(right.view_from_world, projection);
    let broken = [
        (with_view(DAffine3::from_translation(DVec3::NAN)), "not finite"),
        (with_view(DAffine3::from_mat3(DMat3::ZERO)), "not finite"),
        (with_view(DAffine3::from_scale(DVec3::splat(0.01))), "scales"),
        (with_projection(DMat4::ZERO), "no inverse"),
        (with_projection(DMat4::NAN), "no inverse"),
    ];
    for info in techniques() {
        host.technique = info.default_settings().make(&host.gpu).unwrap();
        for (camera, says) in broken {
            host.camera = camera;
            match host.record() {
                Err(Error::Camera(text)) => assert!(text.contains(says), "{}: {text} should say {says}", info.id),
                other => panic!("{}: {camera:?} gives {:?}", info.id, other.map(|_| ())),
            }
        }
    }
    host.assert_quiet();
}

//! What lights reach.

use crate::views::*;
use glam::DVec3;
use proptest::prelude::*;
use umbrage_core::{
    Bounds, Camera, Light, LightShape,
    shadow_hull::{may_be_reached, may_light_view, reach},
};

fn spot(position: DVec3, direction: DVec3, outer_angle_deg: f64, range: Option<f64>) -> Light {
    let inner_angle_deg = outer_angle_deg * 0.5;
    Light { range, ..Light::new(LightShape::Spot { position, direction, inner_angle_deg, outer_angle_deg }) }
}

/// Spots and points, with and without a range.
fn light(middle: DVec3) -> impl Strategy<Value = Light> {
    let range = prop_oneof![3 => (0.5..60.0).prop_map(Some), 1 => Just(None)];
    let axis = prop_oneof![3 => direction(), 1 => Just(DVec3::NEG_Y), 1 => Just(DVec3::X)];
    (vector(20.0), axis, 0.0..90.0, range, 0..3).prop_map(move |(at, axis, angle_deg, range, kind)| match kind {
        0 => Light { range, ..Light::new(LightShape::Point { position: middle + at }) },
        _ => spot(middle + at, axis, angle_deg, range),
    })
}

/// A point that a light reaches: `turn` in [0, 1]² chooses a direction in the cone, `share` the
/// distance.
fn lit(light: &Light, turn: [f64; 2], share: f64) -> DVec3 {
    let (axis, angle_deg) = match light.shape {
        LightShape::Spot { direction, outer_angle_deg, .. } => (direction, outer_angle_deg),
        _ => (DVec3::Y, 180.0),
    };
    let (a, b) = axis.any_orthonormal_pair();
    let (sin, cos) = (turn[0] * angle_deg).to_radians().sin_cos();
    let (s, c) = (turn[1] * std::f64::consts::TAU).sin_cos();
    let way = axis * cos + (a * c + b * s) * sin;
    light.shape.center().truncate() + way * (share * light.range.unwrap_or(300.0))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_000))]

    #[test]
    fn a_box_with_a_lit_point_may_be_reached(
        light in middle().prop_flat_map(light),
        turn in [0.0..=1.0, 0.0..=1.0],
        (share, half, inside) in (0.0..=1.0, vector(10.0), vector(1.0)),
    ) {
        let point = lit(&light, turn, share);
        let bounds = box_with(point, half.abs(), inside);
        prop_assert!(may_be_reached(&light, &bounds));
        let point_box = Bounds { min: point, max: point };
        prop_assert!(may_be_reached(&light, &point_box));
        if let Some(all) = reach(&light) {
            prop_assert!(point.cmpge(all.min).all() && point.cmple(all.max).all(), "{point} outside {all:?}");
        }
        prop_assert_eq!(reach(&light).is_some(), light.range.is_some());
    }

    #[test]
    fn a_point_that_is_not_lit_is_not_reached(light in light(DVec3::ZERO), point in vector(60.0)) {
        let way = point - light.shape.center().truncate();
        let beyond = light.range.is_some_and(|r| way.length() > r * 1.001);
        let aside = match light.shape {
            LightShape::Spot { direction, outer_angle_deg, .. } =>
                way.angle_between(direction).to_degrees() > outer_angle_deg + 0.1,
            _ => false,
        };
        let reached = may_be_reached(&light, &Bounds { min: point, max: point });
        prop_assert!(!(reached && (beyond || aside)), "beyond: {beyond}, aside: {aside}");
    }

    #[test]
    fn a_light_on_something_seen_lights_the_view(
        (shot, light) in middle().prop_flat_map(|m| (shot(m), light(m))),
        (at, depth, turn, share) in (ndc(), 0.0..1.0, [0.0..=1.0, 0.0..=1.0], 0.0..=1.0),
    ) {
        // The light is moved to where it lights the point.
        let moved = shot.seen(at, depth, 1e3) - lit(&light, turn, share);
        let mut light = light;
        if let LightShape::Spot { position, .. } | LightShape::Point { position } = &mut light.shape {
            *position += moved;
        }
        prop_assert!(may_light_view(&light, &shot.view));
    }
}

#[test]
fn reaches_are_tight() {
    let at = DVec3::new(1.0, 2.0, 3.0);
    let point = Light { range: Some(4.0), ..Light::new(LightShape::Point { position: at }) };
    let close = |a: Bounds, min: DVec3, max: DVec3| (a.min - min).length() < 1e-9 && (a.max - max).length() < 1e-9;
    assert!(reach(&point).is_some_and(|b| close(b, at - 4.0, at + 4.0)));
    let down = reach(&spot(at, DVec3::NEG_Y, 30.0, Some(4.0)));
    let (min, max) = (at - DVec3::new(2.0, 4.0, 2.0), at + DVec3::new(2.0, 0.0, 2.0));
    assert!(down.is_some_and(|b| close(b, min, max)), "{down:?}");
    let sphere = Light { range: Some(1.0), ..Light::new(LightShape::Sphere { position: at, radius: 3.0 }) };
    assert!(reach(&sphere).is_some_and(|b| close(b, at - 3.0, at + 3.0)), "a caster within the light matters");
}

#[test]
fn directional_lights_reach_everything() {
    let sun =
        Light { range: Some(1.0), ..Light::new(LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.5 }) };
    let there = Bounds { min: DVec3::splat(1e6), max: DVec3::splat(1e6) };
    assert!(
        reach(&sun).is_none() && may_be_reached(&sun, &there) && may_light_view(&sun, &Camera::default().view(4, 3))
    );
    assert!(!may_be_reached(&sun, &Bounds::EMPTY));
}

#[test]
fn lights_that_miss_the_view_are_told() {
    let view = Camera { eye: DVec3::ZERO, target: DVec3::NEG_Z, ..Camera::default() }.view(640, 480);
    let at = |position: DVec3, range: f64| Light { range: Some(range), ..Light::new(LightShape::Point { position }) };
    assert!(!may_light_view(&at(DVec3::Z * 5.0, 4.0), &view) && may_light_view(&at(DVec3::Z * 5.0, 6.0), &view));
    assert!(!may_light_view(&at(DVec3::new(100.0, 0.0, -5.0), 50.0), &view));
    for (direction, lights) in [(DVec3::Z, false), (DVec3::X, false), (DVec3::NEG_Z, true), (DVec3::NEG_X, true)] {
        for range in [Some(1e3), None] {
            let light = spot(DVec3::new(20.0, 0.0, -5.0), direction, 40.0, range);
            assert_eq!(may_light_view(&light, &view), lights, "{direction} {range:?}");
        }
    }
}

//! Casters that shadow something seen, the eye or the near plane are in the hulls.

use crate::views::*;
use glam::{DVec3, DVec4};
use proptest::prelude::*;
use umbrage_core::{
    Bounds, Camera,
    shadow_hull::{dark_cap_may_be_seen, occlusion_pyramid, segment_touches, shadow_hull},
};

/// A middle, what is seen of it, and a light.
fn scene() -> impl Strategy<Value = (Shot, DVec4)> {
    middle().prop_flat_map(|m| (shot(m), light(m)))
}

/// A caster: half its size, and where in it the ray to the light goes through.
fn caster() -> impl Strategy<Value = (DVec3, DVec3)> {
    (prop_oneof![4 => vector(1.0).prop_map(DVec3::abs), 1 => Just(DVec3::ZERO)], vector(1.0))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn a_caster_that_shadows_a_receiver_is_in_the_hull(
        (shot, light) in scene(),
        (at, share, size) in (ndc(), 0.0..1.0, vector(40.0)),
        (along, (half, inside)) in (0.0..1.0, caster()),
        place in vector(1.0),
    ) {
        let receiver = shot.seen(at, share, 1e3);
        let receivers = box_with(receiver, size.abs(), place);
        let caster = box_with(on_the_way(receiver, light, along), half, inside);
        let hull = shadow_hull(&shot.view, &receivers, light);
        prop_assert!(hull.is_some(), "a receiver is seen");
        prop_assert!(hull.is_some_and(|h| h.may_touch(&caster)), "{caster:?} shadows {receiver}");
    }

    #[test]
    fn a_box_that_touches_the_hull_could_shadow_something(
        (shot, light) in scene(),
        (at, share, size) in (ndc(), 0.0..1.0, vector(40.0)),
        (along, offset) in (0.0..1.0, vector(5.0)),
    ) {
        let receiver = shot.seen(at, share, 1e3);
        let receivers = box_with(receiver, size.abs(), DVec3::ZERO);
        let Some(hull) = shadow_hull(&shot.view, &receivers, light) else { return Ok(()) };
        let p = on_the_way(receiver, light, along) + offset;
        if !hull.may_touch(&Bounds { min: p, max: p }) {
            return Ok(());
        }
        // On the ray from the light through the point there is something seen, at a receiver's
        // distance.
        let away = (p * light.w - light.truncate()).normalize();
        let forward = shot.camera.axes()[2];
        let depths = receivers.corners().map(|c| forward.dot(c - shot.camera.eye));
        let range = depths.iter().fold([f64::INFINITY, 0.0_f64], |[a, b], d| [a.min(*d), b.max(*d)]);
        // How far outside a point is, is a convex function along the ray.
        let outside = |t: f64| shot.outside(p + away * t, range);
        let (mut low, mut high) = (0.0, 1e7);
        for _ in 0..200 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if outside(a) < outside(b) { high = b } else { low = a }
        }
        prop_assert!(outside(low) < 0.05, "all is seen {} m away from the ray at {p}", outside(low));
    }

    #[test]
    fn a_caster_before_the_near_plane_or_the_eye_is_in_the_pyramid(
        (shot, light) in scene(),
        at in ndc(),
        (along, (half, inside)) in (0.0..1.0, caster()),
        between in 0.0..=1.0,
    ) {
        let point = shot.on_near(at).lerp(shot.camera.eye, between);
        let caster = box_with(on_the_way(point, light, along), half, inside);
        prop_assert!(occlusion_pyramid(&shot.view, light).may_touch(&caster), "{caster:?} shadows {point}");
    }

    #[test]
    fn a_segment_touches_what_it_goes_through_and_nothing_else(
        (shot, light) in scene(),
        (along, (half, inside)) in (0.0..1.0, caster()),
        (offset, margin) in (vector(3.0), 0.0..0.5),
    ) {
        let eye = shot.camera.eye;
        let through = on_the_way(eye, light, along);
        let rounding = 1e-15 * (through.abs().max_element() + light.truncate().abs().max_element());
        prop_assert!(segment_touches(eye, light, &box_with(through, half, inside), 4.0 * rounding));
        let aside = box_with(through + offset, half, inside);
        let grown = aside.grown(margin);
        let steps = 4_000;
        let distance = (0..=steps).map(|k| {
            let p = on_the_way(eye, light, 4.0 * f64::from(k) / f64::from(steps));
            let p = if light.w == 0.0 || k <= steps / 4 { p } else { on_the_way(eye, light, 1.0) };
            p.distance(p.clamp(grown.min, grown.max))
        });
        let nearest = distance.fold(f64::INFINITY, f64::min);
        let step = (on_the_way(eye, light, 1.0) - eye).length() * 4.0 / f64::from(steps);
        match segment_touches(eye, light, &aside, margin) {
            true => prop_assert!(nearest <= step + rounding, "touches, though {nearest} away"),
            false => prop_assert!(nearest > 0.0, "misses what it goes through"),
        }
    }

    #[test]
    fn a_dark_cap_in_the_view_may_be_seen(
        (shot, light) in scene(),
        at in ndc(),
        (along, (half, inside), place) in (0.0..50.0, caster(), vector(50.0)),
    ) {
        let away = shot.away(at);
        let caster = match light.w {
            0.0 => box_with(shot.camera.eye + place, half, inside),
            _ => box_with(light.truncate() + away * along, half, inside),
        };
        let light = if light.w == 0.0 { (-away).extend(0.0) } else { light };
        prop_assert!(dark_cap_may_be_seen(&shot.view, &caster, light));
        let behind = shot.camera.axes()[2].extend(0.0);
        prop_assert!(!dark_cap_may_be_seen(&shot.view, &caster, behind), "light from ahead ends behind the eye");
    }
}

fn street() -> (Camera, Bounds) {
    let camera = Camera { eye: DVec3::new(0.0, 2.0, 0.0), target: DVec3::new(0.0, 2.0, -10.0), ..Camera::default() };
    (camera, Bounds { min: DVec3::new(-50.0, 0.0, -50.0), max: DVec3::new(50.0, 0.0, 50.0) })
}

/// Boxes of a metre on a grid around the street, and how many of them a test keeps.
fn kept(keep: impl Fn(&Bounds) -> bool) -> (usize, usize) {
    let places = (0..40_usize.pow(2) * 10).map(|i| (i % 40, i / 40 % 40, i / 1_600));
    let boxes = places.map(|(x, z, y)| DVec3::new(x as f64 - 20.0, y as f64 / 2.0, z as f64 - 20.0) * 5.0);
    let boxes: Vec<_> = boxes.map(|c| Bounds { min: c - 0.5, max: c + 0.5 }).collect();
    (boxes.iter().filter(|b| keep(b)).count(), boxes.len())
}

#[test]
fn most_of_what_is_far_off_is_left_out() {
    let (camera, ground) = street();
    let view = camera.view(640, 480);
    for light in [DVec4::new(1.0, 20.0, -10.0, 1.0), DVec3::new(0.3, 1.0, 0.2).normalize().extend(0.0)] {
        let hull = shadow_hull(&view, &ground, light).expect("the ground is seen");
        assert!(hull.planes().len() < 40, "{} planes", hull.planes().len());
        let (in_hull, all) = kept(|b| hull.may_touch(b));
        assert!(in_hull > 0 && in_hull * 6 < all, "{in_hull} of {all} in the hull, light {light}");
        let pyramid = occlusion_pyramid(&view, light);
        let (in_pyramid, _) = kept(|b| pyramid.may_touch(b));
        assert!(in_pyramid < 12, "{in_pyramid} in the pyramid, light {light}");
        let (crossed, _) = kept(|b| segment_touches(camera.eye, light, b, 0.0));
        assert!(crossed <= in_pyramid, "{crossed} before the eye, {in_pyramid} in the pyramid");
        let (caps, _) = kept(|b| dark_cap_may_be_seen(&view, b, light));
        assert!(caps * 3 < all, "{caps} of {all} dark caps, light {light}");
    }
}

#[test]
fn nothing_matters_where_no_receiver_is_seen() {
    let (camera, ground) = street();
    let up = Camera { target: DVec3::new(0.0, 12.0, -1.0), ..camera };
    for light in [DVec4::new(1.0, 20.0, -10.0, 1.0), DVec4::Y] {
        assert_eq!(shadow_hull(&up.view(4, 3), &ground, light), None);
        assert_eq!(shadow_hull(&up.view(4, 3), &Bounds::EMPTY, light), None);
    }
}

#[test]
fn a_light_in_the_box_may_throw_its_dark_cap_anywhere() {
    let (camera, _) = street();
    let light = DVec4::new(0.0, 0.0, 30.0, 1.0);
    let around = Bounds { min: DVec3::new(-1.0, -1.0, 29.0), max: DVec3::new(1.0, 1.0, 31.0) };
    assert!(dark_cap_may_be_seen(&camera.view(4, 3), &around, light));
    let behind = Bounds { min: DVec3::new(-1.0, -1.0, 32.0), max: DVec3::new(1.0, 1.0, 33.0) };
    assert!(!dark_cap_may_be_seen(&camera.view(4, 3), &behind, light));
    assert!(!dark_cap_may_be_seen(&camera.view(4, 3), &Bounds::EMPTY, light));
    assert!(!segment_touches(camera.eye, light, &Bounds::EMPTY, 1e9));
}

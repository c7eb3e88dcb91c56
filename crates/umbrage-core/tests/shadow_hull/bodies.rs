//! Convex hulls, most of them of degenerate points.

use crate::views::vector;
use glam::{DVec3, DVec4};
use proptest::prelude::*;
use umbrage_core::{
    Bounds,
    scene_tree::{Side, Volume},
    shadow_hull::Convex,
};

fn dot(p: DVec3) -> Bounds {
    Bounds { min: p, max: p }
}

/// Points of a small grid, so that many coincide or are in line, and some directions.
fn points() -> impl Strategy<Value = Vec<DVec4>> {
    let coordinate = || prop_oneof![Just(-1.0), Just(0.0), Just(1.0)];
    let on_grid = (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| DVec3::new(x, y, z));
    let anywhere = vector(1.0);
    let point = prop_oneof![3 => on_grid, 1 => anywhere];
    prop::collection::vec((point, prop_oneof![3 => Just(1.0), 1 => Just(0.0)]), 1..11)
        .prop_map(|points| points.into_iter().map(|(p, w)| p.extend(w)).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_000))]

    #[test]
    fn a_hull_holds_all_between_its_points(
        points in points(),
        weights in prop::collection::vec(0.0..1.0, 11),
        (scale, offset, reach) in (-3..6, prop_oneof![Just(DVec3::ZERO), vector(1e7)], 0.0..1e4),
    ) {
        let scale = 10_f64.powi(scale);
        let placed: Vec<_> = points.iter().map(|p| (p.truncate() * scale + offset * p.w).extend(p.w)).collect();
        let hull = Convex::hull(&placed);
        let finite: Vec<_> = placed.iter().zip(&weights).filter(|(p, _)| p.w == 1.0).collect();
        let whole: f64 = finite.iter().map(|(_, weight)| **weight + 1e-9).sum();
        let between: DVec3 = finite.iter().map(|(p, weight)| p.truncate() * ((**weight + 1e-9) / whole)).sum();
        let out = points.iter().zip(&weights).filter(|(p, _)| p.w == 0.0).map(|(p, weight)| p.truncate() * *weight);
        let inner = between + out.sum::<DVec3>() * (scale * reach);
        for p in placed.iter().filter(|p| p.w == 1.0).map(|p| p.truncate()).chain([inner]) {
            prop_assert!(hull.may_touch(&dot(p)), "{p} is outside {hull:?}");
        }
        prop_assert!(hull.planes().iter().all(|p| (p.truncate().length() - 1.0).abs() < 1e-12));
    }

    #[test]
    fn a_segment_misses_what_is_beside_it(a in vector(10.0), b in vector(10.0), center in vector(10.0), half in vector(3.0)) {
        let bounds = Bounds { min: center - half.abs(), max: center + half.abs() };
        let points: Vec<_> = (0..=2_000).map(|k| a.lerp(b, f64::from(k) / 2_000.0)).collect();
        let nearest = points.iter().map(|p| p.distance(p.clamp(bounds.min, bounds.max))).fold(f64::INFINITY, f64::min);
        let touches = Convex::hull(&[a.extend(1.0), b.extend(1.0)]).may_touch(&bounds);
        prop_assert!(if touches { nearest < 0.02 } else { nearest > 0.0 }, "{nearest}");
    }
}

#[test]
fn a_cube_is_its_own_hull() {
    let cube = Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };
    let hull = Convex::hull(&cube.corners().map(|c| c.extend(1.0)));
    assert_eq!(hull.planes().len(), 6, "{hull:?}");
    for (bounds, side) in [
        (cube.grown(-0.1), Side::Inside),
        (cube.grown(0.1), Side::Partly),
        (Bounds { min: DVec3::splat(1.001), max: DVec3::splat(2.0) }, Side::Outside),
        (Bounds { min: DVec3::new(-1.0, -1.0, 1.001), max: DVec3::splat(2.0) }, Side::Outside),
        (Bounds::EMPTY, Side::Outside),
    ] {
        assert_eq!(hull.side(&bounds), side, "{bounds:?}");
    }
}

#[test]
fn hulls_without_thickness_are_thin() {
    let square = [DVec3::ZERO, DVec3::X, DVec3::Z, DVec3::new(1.0, 0.0, 1.0)].map(|p| p.extend(1.0));
    let (flat, point) = (Convex::hull(&square), Convex::hull(&[DVec4::ONE]));
    let beam = Convex::hull(&[DVec4::W, DVec4::Y]);
    let line = Convex::hull(&[DVec4::W, DVec4::Y, DVec4::NEG_Y]);
    for (body, inside, outside) in [
        (&flat, DVec3::new(0.5, 0.0, 0.5), DVec3::new(0.5, 1e-3, 0.5)),
        (&flat, DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.001, 0.0, 0.0)),
        (&point, DVec3::ONE, DVec3::new(1.0, 1.0, 1.001)),
        (&beam, DVec3::Y * 1e9, DVec3::Y * -1e-3),
        (&beam, DVec3::Y, DVec3::new(1e-3, 1.0, 0.0)),
        (&line, DVec3::Y * -1e9, DVec3::new(1e-3, -1e3, 0.0)),
    ] {
        assert!(body.may_touch(&dot(inside)), "{inside} {body:?}");
        assert!(!body.may_touch(&dot(outside)), "{outside} {body:?}");
    }
}

#[test]
fn a_hull_that_is_not_known_is_everything() {
    for points in [&[][..], &[DVec4::X, DVec4::Y], &[DVec4::W, DVec4::NAN], &[DVec4::W, DVec4::INFINITY]] {
        let hull = Convex::hull(points);
        assert!(hull.planes().is_empty() && hull.may_touch(&dot(DVec3::splat(1e9))), "{points:?}");
    }
}

//! Sums of terms against areas found by clipping triangles.

use super::double::{chord, is_left, term};
use super::{Face, TexturedTable, single};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

const FACES: [Face; 2] = [Face::Disc, Face::Square];

pub(super) type Flat = [f64; 2];
type Solid = [f64; 3];

fn cross(a: Flat, b: Flat) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The face as a polygon, counter-clockwise. The disc's is as large as the disc.
fn outline(face: Face) -> Vec<Flat> {
    match face {
        Face::Square => vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]],
        Face::Disc => {
            let n = 1024.0;
            let radius = (TAU / n / (TAU / n).sin()).sqrt();
            (0..1024).map(|i| TAU * f64::from(i) / n).map(|a| [radius * a.cos(), radius * a.sin()]).collect()
        }
    }
}

/// Cuts a polygon where `side` is negative.
fn cut<P: Copy>(polygon: &[P], side: impl Fn(P) -> f64, mix: impl Fn(P, P, f64) -> P) -> Vec<P> {
    let mut kept = Vec::new();
    for (i, &b) in polygon.iter().enumerate() {
        let a = polygon[(i + polygon.len() - 1) % polygon.len()];
        let (sa, sb) = (side(a), side(b));
        if (sa < 0.0) != (sb < 0.0) {
            kept.push(mix(a, b, sa / (sa - sb)));
        }
        if sb >= 0.0 {
            kept.push(b);
        }
    }
    kept
}

fn mix<const N: usize>(a: [f64; N], b: [f64; N], t: f64) -> [f64; N] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

/// The area that a loop winds around within the face, as a share of the face: a fan of triangles,
/// each clipped.
fn share_by_clipping(face: Face, polygon: &[Flat]) -> f64 {
    share_within(&outline(face), polygon) / if face == Face::Disc { PI } else { 4.0 }
}

/// The area that a loop winds around within a convex outline.
pub(super) fn share_within(outline: &[Flat], polygon: &[Flat]) -> f64 {
    let area = |p: &[Flat]| (0..p.len()).map(|i| cross(p[i], p[(i + 1) % p.len()])).sum::<f64>() / 2.0;
    let mut sum = 0.0;
    for i in 1..polygon.len().saturating_sub(1) {
        let mut part = vec![polygon[0], polygon[i], polygon[i + 1]];
        for (k, &a) in outline.iter().enumerate() {
            let b = outline[(k + 1) % outline.len()];
            let way = [b[0] - a[0], b[1] - a[1]];
            part = cut(&part, |p| cross(way, [p[0] - a[0], p[1] - a[1]]), mix);
        }
        sum += area(&part);
    }
    sum
}

pub(super) fn mix_flat(a: Flat, b: Flat, t: f64) -> Flat {
    mix(a, b, t)
}

/// How often a loop winds around a point.
pub(super) fn winding_about(point: Flat, polygon: &[Flat]) -> f64 {
    let moved: Vec<Flat> = polygon.iter().map(|p| [p[0] - point[0], p[1] - point[1]]).collect();
    winding(&moved)
}

/// How often a loop winds around the origin.
fn winding(polygon: &[Flat]) -> f64 {
    let angle = |a: Flat, b: Flat| cross(a, b).atan2(a[0] * b[0] + a[1] * b[1]);
    let sum: f64 = (0..polygon.len()).map(|i| angle(polygon[i], polygon[(i + 1) % polygon.len()])).sum();
    (sum / TAU).round()
}

fn sum_of_terms(face: Face, polygon: &[Solid]) -> f64 {
    (0..polygon.len()).map(|i| term(face, polygon[i], polygon[(i + 1) % polygon.len()])).sum()
}

fn check(face: Face, polygon: &[Solid], seen: &[Flat]) -> Result<(), TestCaseError> {
    let got = winding(seen) + sum_of_terms(face, polygon);
    let want = share_by_clipping(face, seen);
    prop_assert!((got - want).abs() < 1e-5, "{face:?} {polygon:?}: {got}, not {want}");
    Ok(())
}

/// Vertices in the light's coordinates and how far away each is, 0…1.
fn loops() -> impl Strategy<Value = Vec<(Flat, f64)>> {
    let vertex = (prop::array::uniform2(-2.5..2.5f64), 0.05..1.0f64);
    prop::collection::vec(vertex, 3..9)
}

fn solid((seen, w): &(Flat, f64)) -> Solid {
    [seen[0] * w, seen[1] * w, *w]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn terms_of_any_loop_add_up_to_its_area(polygon in loops()) {
        let seen: Vec<Flat> = polygon.iter().map(|v| v.0).collect();
        let solid: Vec<Solid> = polygon.iter().map(solid).collect();
        for face in FACES {
            check(face, &solid, &seen)?;
        }
    }

    #[test]
    fn what_is_behind_the_observer_or_beyond_the_light_does_not_count(
        polygon in prop::collection::vec((prop::array::uniform2(-2.0..2.0f64), -1.5..2.0f64), 3..4),
    ) {
        let solid: Vec<Solid> = polygon.iter().map(|([x, y], w)| [*x, *y, *w]).collect();
        // Near enough to the observer, everything that is seen is outside of the face.
        let ahead = cut(&solid, |p| p[2] - 1e-4, mix);
        let before = cut(&ahead, |p| 1.0 - p[2], mix);
        let seen: Vec<Flat> = before.iter().map(|[x, y, w]| [x / w, y / w]).collect();
        // A caster that runs through the light itself has no share of it that is behind.
        let near_plane = |p: &Solid| (p[2] - 1.0).abs() < 1e-9;
        let ends: Vec<Flat> = before.iter().filter(|p| near_plane(p)).map(|[x, y, _]| [*x, *y]).collect();
        let through = |face| ends.len() == 2 && chord(face, [ends[0][0], ends[0][1], 1.0], [ends[1][0], ends[1][1], 1.0]).is_some();
        let near_observer = before.iter().any(|p| (p[2] - 1e-4).abs() < 1e-9 && p[0].hypot(p[1]) < 1e-2);
        let through_centre = (0..seen.len()).any(|i| {
            let (a, b) = (seen[i], seen[(i + 1) % seen.len()]);
            cross(a, b).abs() < 1e-6 * (a[0] - b[0]).hypot(a[1] - b[1])
        });
        for face in FACES {
            if seen.len() >= 3 && !through_centre && !through(Face::Square) && !near_observer {
                check(face, &solid, &seen)?;
            }
        }
    }

    #[test]
    fn single_precision_agrees(polygon in loops()) {
        for face in FACES {
            for i in 0..polygon.len() {
                let ends = [&polygon[i], &polygon[(i + 1) % polygon.len()]].map(solid);
                let [a, b] = ends.map(|p| p.map(|c| c as f32));
                let wide = |p: [f32; 3]| p.map(f64::from);
                // Next to the centre the sign is a matter of rounding, for `hard` too.
                if chord(face, wide(a), wide(b)).is_some_and(|c| c.is_left == single::is_left(a, b)) {
                    let (got, want) = (f64::from(single::term(face, a, b)), term(face, wide(a), wide(b)));
                    prop_assert!((got - want).abs() < 2e-4, "{face:?} {a:?} {b:?}: {got}, not {want}");
                }
            }
        }
    }
}

#[test]
fn half_of_the_face_is_half_covered() {
    for face in FACES {
        // The left half plane, its border through the centre, which is on the left of it and so
        // covered.
        let border = term(face, [0.0, -5.0, 0.5], [0.0, 5.0, 0.5]);
        assert!(is_left([0.0, -5.0, 0.5], [0.0, 5.0, 0.5]));
        assert!((1.0 + border - 0.5).abs() < 1e-12, "{face:?} {border}");
    }
}

#[test]
fn a_small_hole_over_the_centre_has_its_own_area() {
    let seen = [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]];
    let solid = seen.map(|[x, y]: Flat| [x * 0.3, y * 0.3, 0.3]);
    let share = 1.0 + sum_of_terms(Face::Square, &solid);
    assert!((share - 0.01).abs() < 1e-12, "{share}");
    let share = 1.0 + sum_of_terms(Face::Disc, &solid);
    assert!((share - 0.04 / PI).abs() < 1e-12, "{share}");
}

#[test]
fn edges_outside_add_nothing_and_terms_do_not_jump_at_the_border() {
    for face in FACES {
        assert_eq!(term(face, [1.5, -3.0, 1.0], [1.5, 3.0, 1.0]), 0.0);
        assert_eq!(term(face, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]), 0.0);
        assert!(term(face, [0.9999, -3.0, 1.0], [0.9999, 3.0, 1.0]).abs() < 1e-3);
        assert_eq!(term(face, [f64::NAN, 0.0, 1.0], [0.0, 1.0, 1.0]).abs().max(0.0), 0.0, "{face:?}");
    }
}

#[test]
fn across_the_centre_a_term_jumps_by_one() {
    for face in FACES {
        let at = |x: f64| term(face, [x, -2.0, 1.0], [x, 2.0, 1.0]);
        // With the centre on the left the loop covers it: `hard` is 1 there.
        let jump = at(1e-9) - at(-1e-9);
        assert!((jump.abs() - 1.0).abs() < 1e-6, "{face:?} {jump}");
        assert!((1.0 + at(-1e-9) - 0.5).abs() < 1e-6 || (1.0 + at(1e-9) - 0.5).abs() < 1e-6);
    }
}

#[test]
fn a_textured_square_of_one_weight_is_a_square() {
    let table = TexturedTable::new(|_, _| 3.0, 16).expect("it gives light");
    let mut worst: f64 = 0.0;
    for i in 0..2000 {
        let at = |k: usize| ((i * 5 + k) as f64 * 0.754_877_666_f64 * (k + 1) as f64).fract() * 3.0 - 1.5;
        if let Some(chord) = chord(Face::Square, [at(0), at(1), 1.0], [at(2), at(3), 1.0]) {
            worst = worst.max((table.term(&chord) - chord.on_square()).abs());
        }
    }
    assert!(worst < 3e-3, "{worst}");
}

#[test]
fn a_textured_square_counts_where_its_weight_is() {
    // All of the light comes from the left half; a caster covers x > 0 and so nothing of it.
    let table = TexturedTable::new(|_, high| if high[0] <= 0.0 { 1.0 } else { 0.0 }, 16).expect("it gives light");
    let polygon = [[0.02, -2.0, 0.5], [2.0, -2.0, 0.5], [2.0, 2.0, 0.5], [0.02, 2.0, 0.5]];
    let sum = |polygon: &[Solid]| -> f64 {
        let edges = (0..polygon.len()).map(|i| (polygon[i], polygon[(i + 1) % polygon.len()]));
        edges.filter_map(|(a, b)| chord(Face::Square, a, b)).map(|c| table.term(&c)).sum()
    };
    assert!(sum(&polygon).abs() < 0.02, "{}", sum(&polygon));
    let mirrored = [[-2.0, -2.0, 0.5], [-0.02, -2.0, 0.5], [-0.02, 2.0, 0.5], [-2.0, 2.0, 0.5]];
    assert!((sum(&mirrored) - 0.96).abs() < 0.01, "{}", sum(&mirrored));
    assert!(TexturedTable::new(|_, _| 0.0, 8).is_none());
}

/// A dot in the corner where the way around the square starts: chords that cut it off pass over the
/// start.
#[test]
fn a_sector_over_the_start_of_the_way_around_has_its_light() {
    let dot = |low: Flat, _: Flat| if low[0] > 0.9 && low[1] < -0.9 { 1.0 } else { 0.0 };
    let table = TexturedTable::new(dot, 16).expect("it gives light");
    // The corner is on the right, the centre on the left: what the centre counts for is taken back.
    let cut = chord(Face::Square, [0.0, -1.5, 1.0], [1.5, 0.0, 1.0]).expect("it is on the square");
    assert!((table.term(&cut) + 1.0).abs() < 0.03, "{}", table.term(&cut));
}

/// The share of a picture left of a line through the square, by points.
fn share_by_points(picture: &impl Fn(f64, f64) -> f64, from: Flat, to: Flat) -> f64 {
    let at = |i: usize| (2.0 * i as f64 + 1.0) / 400.0 - 1.0;
    let way = [to[0] - from[0], to[1] - from[1]];
    let (mut left, mut all) = (0.0, 0.0);
    for (x, y) in (0..160_000).map(|i| (at(i % 400), at(i / 400))) {
        let w = picture(x, y);
        all += w;
        left += if cross(way, [x - from[0], y - from[1]]) > 0.0 { w } else { 0.0 };
    }
    left / all
}

#[test]
fn how_far_tables_of_pictures_are_off() {
    let tiles = |x: f64, y: f64| f64::from((((x + 1.0) * 2.0) as u32 + ((y + 1.0) * 2.0) as u32) % 2);
    let dot = |x: f64, y: f64| if (x - 0.5).hypot(y - 0.25) < 0.3 { 1.0 } else { 0.0 };
    let bars = |x: f64, _: f64| f64::from(((x + 1.0) * 3.5) as u32 % 2);
    type Weight<'a> = &'a dyn Fn(f64, f64) -> f64;
    let pictures: [(&str, Weight<'_>); 3] = [("tiles", &tiles), ("dot", &dot), ("bars", &bars)];
    for side in [16, 24, 32] {
        for (name, picture) in pictures {
            let middle = |a: Flat, b: Flat| picture(0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]));
            let table = TexturedTable::new(middle, side).expect("it gives light");
            let (mut worst, mut sum) = (0.0f64, 0.0);
            for i in 0..200 {
                let angle = i as f64 * 2.4;
                let d = 0.9 * (i as f64 * 0.618_034).fract();
                let (n, t) = ([angle.cos(), angle.sin()], [-angle.sin(), angle.cos()]);
                let p = |s: f64| [n[0] * d + t[0] * s, n[1] * d + t[1] * s];
                let (from, to) = (p(-4.0), p(4.0));
                let c = chord(Face::Square, [from[0], from[1], 1.0], [to[0], to[1], 1.0]).expect("it crosses");
                let got = f64::from(u8::from(c.is_left)) + table.term(&c);
                let off = (got - share_by_points(&picture, from, to)).abs();
                worst = worst.max(off);
                sum += off / 200.0;
            }
            println!("{name} {side}: worst {worst:.4} mean {sum:.5}");
            assert!(side != 24 || (worst < 0.015 && sum < 0.002), "{name}: worst {worst}, mean {sum}");
        }
    }
}

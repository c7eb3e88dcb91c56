//! Straight ways through triangles, both with corners at infinity: homogeneous points (x, y, z, w)
//! with w ≥ 0.

use umbrage_core::glam::{DMat4, DVec4};

/// What is nearer than this to being otherwise is not decided. Facing is computed in single
/// precision, so this must be well above its rounding.
const MARGIN: f64 = 1e-6;

/// A triangle that is crossed more than once at once.
#[derive(Clone, Copy, Debug)]
pub struct Sheet {
    /// Counter-clockwise seen from outside.
    pub corners: [DVec4; 3],
    /// How many lie upon one another.
    pub times: i32,
}

/// How often the way from `from` to `to` leaves a body through `sheets`, less how often it enters;
/// `None` where it passes within [`MARGIN`] of the rim of a sheet, or where a sheet it would meet
/// is that near to either end.
///
/// A sheet all at infinity is met by ways that go there without end, at the very end.
pub fn crossings(from: DVec4, to: DVec4, sheets: &[Sheet]) -> Option<i32> {
    sheets.iter().map(|sheet| crossing(from, to, &sheet.corners).map(|out| out * sheet.times)).sum()
}

/// +1 where the way leaves through the triangle, −1 where it enters, 0 where it does not meet it.
fn crossing(from: DVec4, to: DVec4, &[a, b, c]: &[DVec4; 3]) -> Option<i32> {
    let plane = plane([a, b, c]);
    if plane.length() < 1e-9 * a.length() * b.length() * c.length() {
        return Some(0); // No area.
    }
    let plane = plane.normalize();
    let start = plane.dot(from);
    // Along a way that meets the triangle, these have the sign of `start`. They come from writing a
    // point of the way, α from + β to, as a sum of the corners, by Cramer's rule, and asking that
    // all five weights be positive.
    let to_sides = [(a, b), (b, c), (c, a)].map(|(a, b)| side(from, to, a, b));
    let is_at_infinity = to.w == 0.0 && a.w + b.w + c.w == 0.0;
    let beyond = if is_at_infinity { start } else { -plane.dot(to) };
    let [u, v, w] = to_sides;
    let signs = [start, beyond, u, v, w];
    if signs.iter().any(|s| *s > MARGIN) && signs.iter().any(|s| *s < -MARGIN) {
        return Some(0);
    }
    signs.iter().all(|s| s.abs() > MARGIN).then_some(if start < 0.0 { 1 } else { -1 })
}

/// N with N · x positive in front of the triangle.
fn plane([a, b, c]: [DVec4; 3]) -> DVec4 {
    -DVec4::from([DVec4::X, DVec4::Y, DVec4::Z, DVec4::W].map(|x| DMat4::from_cols(a, b, c, x).determinant()))
}

/// On which side the line from `a` to `b` passes that from `from` to `to`; about the sine of what
/// is between.
fn side(from: DVec4, to: DVec4, a: DVec4, b: DVec4) -> f64 {
    let extent = |a: DVec4, b: DVec4| (a.length_squared() * b.length_squared() - a.dot(b).powi(2)).sqrt();
    DMat4::from_cols(from, to, a, b).determinant() / (extent(from, to) * extent(a, b))
}

#[test]
fn ways_leave_enter_and_miss() {
    let triangle = [DVec4::W, DVec4::X + DVec4::W, DVec4::Y + DVec4::W];
    let at = |x: f64, y: f64, z: f64| DVec4::new(x, y, z, 1.0);
    let below = at(0.2, 0.3, -1.0);
    assert_eq!(crossing(below, at(0.2, 0.3, 1.0), &triangle), Some(1));
    assert_eq!(crossing(at(0.2, 0.3, 1.0), below, &triangle), Some(-1));
    assert_eq!(crossing(below, DVec4::Z, &triangle), Some(1), "without end");
    assert_eq!(crossing(below, DVec4::NEG_Z, &triangle), Some(0), "the other way");
    assert_eq!(crossing(below, at(0.2, 0.3, -0.5), &triangle), Some(0), "too short");
    assert_eq!(crossing(below, at(2.0, 0.3, 1.0), &triangle), Some(0), "beside");
    assert_eq!(crossing(below, at(0.2, -0.3, 1.0), &triangle), None, "through an edge");
    assert_eq!(crossing(below, at(0.2, 0.3, 0.0), &triangle), None, "up to it");
    assert_eq!(crossing(below, DVec4::Z, &[triangle[0], triangle[1], triangle[1]]), Some(0), "no area");
}

#[test]
fn triangles_reach_to_infinity_and_lie_there() {
    // The quarter of the plane z = 0 between the axes, and the eighth of the sky between all three.
    let quarter = [DVec4::W, DVec4::X, DVec4::Y];
    let sky = [DVec4::X, DVec4::Y, DVec4::Z];
    let below = DVec4::new(9.0, 7.0, -1.0, 1.0);
    assert_eq!(crossing(below, DVec4::Z, &quarter), Some(1));
    assert_eq!(crossing(below, DVec4::NEG_Z, &quarter), Some(0));
    assert_eq!(crossing(DVec4::new(-9.0, 7.0, -1.0, 1.0), DVec4::Z, &quarter), Some(0));
    let up = DVec4::new(1.0, 2.0, 3.0, 0.0);
    assert_eq!((crossing(below, up, &sky), crossing(below, -up, &sky)), (Some(1), Some(0)));
    let inwards = [sky[2], sky[1], sky[0]];
    assert_eq!((crossing(below, up, &inwards), crossing(below, -up, &inwards)), (Some(-1), Some(0)));
    assert_eq!(crossing(below, DVec4::new(1.0, 2.0, 3.0, 1e-3), &sky), Some(0), "far, but not there");
}

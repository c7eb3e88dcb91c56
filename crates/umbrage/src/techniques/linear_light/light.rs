//! The points of a light that have maps.

use umbrage_core::LightShape;
use umbrage_core::glam::DVec3;

/// The line that stands for a light; `None` for lights of other kinds, and where it has no length.
/// A rectangle's is its longer axis.
fn axis(shape: &LightShape) -> Option<[DVec3; 2]> {
    let [from, to] = match *shape {
        LightShape::Line { from, to } => [from, to],
        LightShape::Rect { position, direction, up, size, .. } => {
            let right = up.cross(direction);
            let half = if size.x > size.y { right * (size.x * 0.5) } else { up * (size.y * 0.5) };
            [position - half, position + half]
        }
        _ => return None,
    };
    let length = from.distance(to);
    (length > 0.0 && length.is_finite()).then_some([from, to])
}

/// Replaces what is in `points` by `count` points from one end of the light to the other; the light
/// itself, to be taken from its centre, where it has no ends. Returns the way from a point to the
/// next one, metres.
pub(super) fn points(shape: &LightShape, count: u32, points: &mut Vec<LightShape>) -> f64 {
    points.clear();
    let Some([from, to]) = axis(shape) else {
        points.push(shape.clone());
        return 0.0;
    };
    let pieces = f64::from(count.max(2) - 1);
    points.extend((0..count.max(2)).map(|i| LightShape::Point { position: from.lerp(to, f64::from(i) / pieces) }));
    from.distance(to) / pieces
}

/// Half floats hold a share of the light to 11 bits: weights in whole numbers of these add up to 1
/// without rounding.
const STEPS: f64 = 2048.0;

/// The weight of piece number `i` of `count`.
pub(super) fn weight(i: usize, count: usize) -> f64 {
    let until = |i: usize| (i as f64 / count as f64 * STEPS).round() / STEPS;
    until(i + 1) - until(i)
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::glam::DVec2;

    #[test]
    fn points_go_from_end_to_end() {
        let mut found = Vec::new();
        let line = LightShape::Line { from: DVec3::ZERO, to: DVec3::X * 6.0 };
        assert_eq!(points(&line, 4, &mut found), 2.0);
        let want: Vec<_> = [0.0, 2.0, 4.0, 6.0].map(|x| LightShape::Point { position: DVec3::X * x }).into();
        assert_eq!(found, want);
    }

    #[test]
    fn a_rectangle_is_its_longer_axis() {
        let mut found = Vec::new();
        for size in [DVec2::new(3.0, 1.0), DVec2::new(1.0, 3.0)] {
            let rect =
                LightShape::Rect { position: DVec3::Y, direction: DVec3::NEG_Y, up: DVec3::Z, size, texture: None };
            assert_eq!(points(&rect, 2, &mut found), 3.0, "{size}");
            assert_eq!(found.len(), 2);
        }
    }

    #[test]
    fn what_has_no_ends_is_one_point() {
        let mut found = Vec::new();
        let short = LightShape::Line { from: DVec3::ONE, to: DVec3::ONE };
        let round = LightShape::Sphere { position: DVec3::ONE, radius: 1.0 };
        for shape in [short, round] {
            assert_eq!(points(&shape, 5, &mut found), 0.0);
            assert_eq!(found, [shape]);
        }
    }

    #[test]
    fn weights_add_up_and_are_nearly_alike() {
        for count in 1..64 {
            let all: Vec<f64> = (0..count).map(|i| weight(i, count)).collect();
            assert_eq!(all.iter().sum::<f64>(), 1.0, "{count}");
            let off = all.iter().map(|w| (w - 1.0 / count as f64).abs()).fold(0.0, f64::max);
            assert!(off <= 1.0 / STEPS, "{count}: {all:?}");
        }
    }
}

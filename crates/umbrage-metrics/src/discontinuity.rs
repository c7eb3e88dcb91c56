//! Where neighbouring pixels show different surfaces.

use umbrage_core::Image;

/// A step is a second difference of 1 / depth over this share of 1 / depth.
const STEP: f64 = 0.005;

/// True where a pixel lies beside a discontinuity: there a rasteriser and a ray tracer may see
/// different surfaces.
///
/// Two of eight neighbours are across one when one of them shows nothing, or they show different
/// models, or the depth has a step: the second difference of 1 / depth, which is zero on any plane,
/// is over 0.5 % of 1 / depth. Both pixels are then marked. `depth` is measured along the view
/// direction, in any unit, 0 = nothing; `model` is any number that differs from one model to the
/// next. Pixels outside `model` count as a model of their own.
pub fn discontinuities(depth: &Image<f32>, model: &Image<i32>) -> Image<bool> {
    let (width, height) = (i64::from(depth.width), i64::from(depth.height));
    let inverse = depth.map(|&d| if d > 0.0 { 1.0 / f64::from(d) } else { 0.0 });
    let mut edge = Image::filled(depth.width, depth.height, false);
    let at = |x: i64, y: i64| inverse.get(x, y).copied();
    for (dx, dy) in [(1, 0), (0, 1), (1, 1), (-1, 1)] {
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let (Some(here), Some(next)) = (at(x, y), at(x + dx, y + dy)) else { continue };
            let mut mark = |steps: i64| edge[((x + steps * dx) as u32, (y + steps * dy) as u32)] = true;
            if (here > 0.0) != (next > 0.0) || model.get(x, y) != model.get(x + dx, y + dy) {
                mark(0);
                mark(1);
            }
            // Three in a row: the step is on the side of the larger change.
            let Some(after) = at(x + 2 * dx, y + 2 * dy) else { continue };
            if (here - 2.0 * next + after).abs() > STEP * next {
                mark(1);
                mark(if (here - next).abs() > (after - next).abs() { 0 } else { 2 });
            }
        }
    }
    edge
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_marks_both_its_sides_and_no_more() {
        let depth = Image::from_fn(50, 40, |x, _| if x < 25 { 5.0 } else { 6.0 });
        let edge = discontinuities(&depth, &Image::filled(50, 40, 0));
        for y in 0..40 {
            for x in 0..50 {
                assert_eq!(edge[(x, y)], x == 24 || x == 25, "at {x}, {y}");
            }
        }
    }

    #[test]
    fn another_model_at_the_same_depth_is_an_edge() {
        let model = Image::from_fn(50, 40, |x, y| i32::from(x < 10 && y < 20));
        let edge = discontinuities(&Image::filled(50, 40, 5.0), &model);
        assert!((0..10).all(|x| edge[(x, 19)] && edge[(x, 20)]));
        assert!((0..20).all(|y| edge[(9, y)] && edge[(10, y)]));
        assert!(!edge[(8, 18)] && !edge[(11, 5)] && !edge[(5, 21)]);
    }

    #[test]
    fn a_slanted_plane_has_no_edge_and_its_border_to_nothing_has_one() {
        let plane = |x: u32, y: u32| (1.0 / (0.1 + 0.003 * f64::from(x) + 0.01 * f64::from(y))) as f32;
        let whole = discontinuities(&Image::from_fn(50, 40, plane), &Image::filled(50, 40, 0));
        assert!(whole.data.iter().all(|e| !e));
        let cut = Image::from_fn(50, 40, |x, y| if y < 7 { 0.0 } else { plane(x, y) });
        let edge = discontinuities(&cut, &Image::filled(50, 40, 0));
        assert!((0..50).all(|x| edge[(x, 6)] && edge[(x, 7)] && !edge[(x, 9)]));
    }
}

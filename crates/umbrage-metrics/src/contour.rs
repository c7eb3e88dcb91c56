//! How far the outlines of shadows lie from the reference's.

use crate::score::percentile;
use umbrage_core::{Image, glam::DVec2};

/// Where visibility is this, a shadow has its outline.
const OUTLINE: f32 = 0.5;

/// Outlines farther apart than this, pixels, count as so far apart.
const FARTHEST: f64 = 32.0;

/// Distances between the outlines of two pictures, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeOffset {
    /// Half of the points of outlines are no farther from the other picture's outline.
    pub p50: f64,
    /// 99 of 100 points are no farther.
    pub p99: f64,
}

/// How far the outlines of shadows lie from the reference's, and the reference's from them; `None`
/// where neither has one.
///
/// An outline is where visibility, interpolated linearly between two scored pixels side by side,
/// is 0.5. An outline may end, and its counterpart may lie, where no pixel is scored; so a point
/// counts as no farther off than the nearest pixel that is not scored, nor farther than 32 pixels.
/// What is not finite counts as light.
pub(crate) fn edge_offset(produced: &Image<f32>, reference: &Image<f32>, mask: &Image<bool>) -> Option<EdgeOffset> {
    let finite = produced.map(|v| if v.is_finite() { *v } else { 1.0 });
    let (ours, theirs) = (Outline::of(&finite, mask), Outline::of(reference, mask));
    let unscored = Places::new(mask.size(), unscored(mask));
    let to = |from: &Outline, other: &Outline| -> Vec<f64> {
        let nearest = |at: &DVec2| other.places.nearest(*at).min(unscored.nearest(*at));
        from.points.iter().map(nearest).collect()
    };
    let mut distances = to(&ours, &theirs);
    distances.append(&mut to(&theirs, &ours));
    distances.sort_by(f64::total_cmp);
    let of = |share| percentile(&distances, share);
    (!distances.is_empty()).then(|| EdgeOffset { p50: of(0.5), p99: of(0.99) })
}

/// Points where a picture crosses one half.
struct Outline {
    points: Vec<DVec2>,
    places: Places,
}

impl Outline {
    fn of(picture: &Image<f32>, mask: &Image<bool>) -> Self {
        let mut points = Vec::new();
        for (x, y) in (0..picture.height).flat_map(|y| (0..picture.width).map(move |x| (x, y))) {
            for (i, j) in [(1, 0), (0, 1)] {
                let next = (x + i, y + j);
                let scored = |(x, y): (u32, u32)| mask.get(x.into(), y.into()) == Some(&true);
                if !scored((x, y)) || !scored(next) {
                    continue;
                }
                let (here, there) = (picture[(x, y)] - OUTLINE, picture[next] - OUTLINE);
                if (here < 0.0) != (there < 0.0) {
                    let share = f64::from(here / (here - there));
                    points.push(DVec2::new(x.into(), y.into()) + DVec2::new(i.into(), j.into()) * share);
                }
            }
        }
        Self { places: Places::new(picture.size(), points.clone()), points }
    }
}

/// Pixels that are not scored, beside scored ones; those around the picture are not.
fn unscored(mask: &Image<bool>) -> Vec<DVec2> {
    let (width, height) = (i64::from(mask.width), i64::from(mask.height));
    let scored = |x: i64, y: i64| mask.get(x, y) == Some(&true);
    let beside = |&(x, y): &(i64, i64)| {
        !scored(x, y) && [(1, 0), (-1, 0), (0, 1), (0, -1)].iter().any(|(i, j)| scored(x + i, y + j))
    };
    let all = (-1..=height).flat_map(|y| (-1..=width).map(move |x| (x, y)));
    all.filter(beside).map(|(x, y)| DVec2::new(x as f64, y as f64)).collect()
}

/// Points sorted into cells, to find the nearest one.
struct Places {
    cells: Image<Vec<DVec2>>,
}

/// Pixels across and down.
const CELL: f64 = 4.0;

impl Places {
    fn new((width, height): (u32, u32), points: Vec<DVec2>) -> Self {
        let cells = |pixels: u32| (f64::from(pixels) / CELL) as u32 + 1;
        let mut places = Self { cells: Image::filled(cells(width), cells(height), Vec::new()) };
        for point in points {
            let (x, y) = Self::cell(point);
            let inside = |at: i64, cells: u32| at.clamp(0, i64::from(cells) - 1) as u32;
            let at = (inside(x, places.cells.width), inside(y, places.cells.height));
            places.cells[at].push(point);
        }
        places
    }

    fn cell(point: DVec2) -> (i64, i64) {
        let cell = (point / CELL).floor();
        (cell.x as i64, cell.y as i64)
    }

    /// How far the nearest of them is, pixels, at most [`FARTHEST`].
    fn nearest(&self, from: DVec2) -> f64 {
        let (x, y) = Self::cell(from);
        let mut best = FARTHEST;
        // Points of ring `ring` are at least ring − 1 cells away; those before the picture's first
        // row and column lie a pixel out of their cell, towards nobody.
        for ring in 0..=(FARTHEST / CELL) as i64 + 1 {
            if (ring - 1) as f64 * CELL > best {
                break;
            }
            let on_ring = move |i: &i64, j: &i64| i.abs().max(j.abs()) == ring;
            for (i, j) in
                (-ring..=ring).flat_map(|j| (-ring..=ring).map(move |i| (i, j))).filter(|(i, j)| on_ring(i, j))
            {
                let points = self.cells.get(x + i, y + j).into_iter().flatten();
                best = points.map(|point| point.distance(from)).fold(best, f64::min);
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (120, 90);

    fn picture(of: impl Fn(f64, f64) -> f64) -> Image<f32> {
        Image::from_fn(SIZE.0, SIZE.1, |x, y| of(x.into(), y.into()) as f32)
    }

    fn all() -> Image<bool> {
        Image::filled(SIZE.0, SIZE.1, true)
    }

    /// A round shadow of a radius with a soft rim, in the middle.
    fn disc(radius: f64) -> Image<f32> {
        picture(move |x, y| (0.5 + ((x - 60.0).hypot(y - 45.0) - radius) / 8.0).clamp(0.0, 1.0))
    }

    #[test]
    fn a_shadow_equals_itself_and_none_has_no_outline() {
        assert_eq!(edge_offset(&disc(20.0), &disc(20.0), &all()), Some(EdgeOffset { p50: 0.0, p99: 0.0 }));
        assert_eq!(edge_offset(&picture(|_, _| 1.0), &picture(|_, _| 0.7), &all()), None);
    }

    #[test]
    fn a_larger_shadow_is_off_by_the_difference_of_radii() {
        for (radius, off) in [(20.25, 0.25), (23.0, 3.0), (27.5, 7.5)] {
            let found = edge_offset(&disc(radius), &disc(20.0), &all()).expect("outlines");
            // Points lie a pixel apart at most, so the nearest may be half a pixel aside.
            assert!((found.p50 - off).abs() < 0.15 && (found.p99 - off).abs() < 0.3, "{found:?} for {off}");
        }
    }

    #[test]
    fn a_stripe_of_light_that_is_not_there_shows_in_the_last_hundredths() {
        let shadow = picture(|x, _| if x < 60.0 { 0.0 } else { 1.0 });
        let striped = picture(|x, _| if x < 60.0 && x != 40.0 { 0.0 } else { 1.0 });
        let found = edge_offset(&striped, &shadow, &all()).expect("outlines");
        assert!(found.p50 <= 20.0 && (found.p99 - 20.0).abs() < 0.01, "{found:?}");
        let missing = edge_offset(&picture(|_, _| 1.0), &shadow, &all()).expect("an outline");
        assert!((missing.p99 - FARTHEST).abs() < 1e-9 && missing.p50 < FARTHEST, "the border is nearer to some");
    }

    #[test]
    fn what_may_be_hidden_is_not_held_against() {
        let shadow = picture(|x, _| if x < 60.0 { 0.0 } else { 1.0 });
        let mask = Image::from_fn(SIZE.0, SIZE.1, |x, _| x < 62);
        let found = edge_offset(&picture(|_, _| 0.0), &shadow, &mask).expect("an outline");
        assert!((found.p99 - 2.5).abs() < 1e-9, "the nearest pixel that is not scored is 2.5 away: {found:?}");
    }

    #[test]
    fn the_nearest_place_is_that_of_a_plain_search() {
        let random = |n: u32| f64::from((n.wrapping_mul(2_654_435_769) >> 8) % 10_000) / 10_000.0;
        let point = |n: u32| DVec2::new(random(n) * 121.0 - 1.0, random(n + 7_777) * 91.0 - 1.0);
        let points: Vec<DVec2> = (0..40).map(point).collect();
        let places = Places::new(SIZE, points.clone());
        for from in (100..400).map(point) {
            let plain = points.iter().map(|p| p.distance(from)).fold(FARTHEST, f64::min);
            assert_eq!(places.nearest(from), plain, "from {from}");
        }
    }
}

//! Errors around the borders between maps, set against those elsewhere.

use crate::error::{Error, same_size};
use crate::score::difference;
use umbrage_core::glam::DVec2;
use umbrage_core::light_view::{LightView, view_at};
use umbrage_core::{Camera, Image};

/// A border reaches over this share of its distance, before and behind it.
const BAND: f64 = 0.05;

/// Shadow edges shorter than this, in pixels, on either side say nothing.
const SHORTEST: f64 = 16.0;

/// The pixels around borders: those for which another view counts somewhat nearer or farther on the
/// same ray. `views` and `splits` are those of [`view_at`]; without splits there are no borders.
/// `depth` is along the view direction, metres, 0 where nothing is.
pub fn around_borders(views: &[LightView], splits: &[f64], camera: &Camera, depth: &Image<f32>) -> Image<bool> {
    let (width, height) = depth.size();
    let view = camera.view(width, height);
    Image::from_fn(width, height, |x, y| {
        let pixel = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
        let ray = camera.ray(pixel, width, height) * f64::from(depth[(x, y)]);
        let start = camera.start(pixel, width, height);
        let layer = |share: f64| view_at(views, splits, &view, start + ray * share).map(|v| v.layer);
        let [nearer, farther] = [layer(1.0 / (1.0 + BAND)), layer(1.0 / (1.0 - BAND))];
        depth[(x, y)] > 0.0 && !splits.is_empty() && nearer.zip(farther).is_some_and(|(a, b)| a != b)
    })
}

/// How many times as far off shadow edges are around borders as elsewhere; 1 where a border can't
/// be told.
///
/// Pixels `around` them are those of [`around_borders`]. On either side the sum of |produced −
/// reference| over the scored pixels is divided by the length of the shadow edges there: the sum of
/// the reference's change from pixel to pixel. That is how many pixels an edge is off, for hard
/// edges and for penumbras, however many of them there are; what is wrong where no edge is counts
/// with it.
///
/// `None` without borders, where a side has next to no edges, and where there is no error
/// elsewhere.
///
/// # Errors
/// Pictures of different sizes.
pub fn seam(
    produced: &Image<f32>,
    reference: &Image<f32>,
    mask: &Image<bool>,
    around: &Image<bool>,
) -> Result<Option<f64>, Error> {
    same_size("produced", produced, reference)?;
    same_size("mask", mask, reference)?;
    same_size("around", around, reference)?;
    let (mut near, mut elsewhere) = (Side::default(), Side::default());
    for (x, y) in (0..reference.height).flat_map(|y| (0..reference.width).map(move |x| (x, y))) {
        if !mask[(x, y)] {
            continue;
        }
        let side = if around[(x, y)] { &mut near } else { &mut elsewhere };
        side.error += difference(produced[(x, y)], reference[(x, y)]).abs();
        side.edges += change(reference, mask, x, y);
    }
    Ok(near.offset().zip(elsewhere.offset()).filter(|(_, elsewhere)| *elsewhere > 0.0).map(|(a, e)| a / e))
}

/// Sums over some pixels.
#[derive(Default)]
struct Side {
    error: f64,
    /// Length of shadow edges, pixels.
    edges: f64,
}

impl Side {
    /// How far edges are off, pixels.
    fn offset(&self) -> Option<f64> {
        (self.edges >= SHORTEST).then(|| self.error / self.edges)
    }
}

/// How much the reference changes from this pixel to the next ones in x and y, as far as these are
/// scored.
fn change(reference: &Image<f32>, mask: &Image<bool>, x: u32, y: u32) -> f64 {
    let to = |dx: u32, dy: u32| {
        let next = (i64::from(x + dx), i64::from(y + dy));
        let is_scored = mask.get(next.0, next.1) == Some(&true);
        let value = reference.get(next.0, next.1).filter(|_| is_scored).unwrap_or(&reference[(x, y)]);
        f64::from(value - reference[(x, y)])
    };
    to(1, 0).hypot(to(0, 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::glam::{DMat4, DVec3};

    const SIZE: (u32, u32) = (200, 100);

    fn picture(of: impl Fn(u32, u32) -> f32) -> Image<f32> {
        Image::from_fn(SIZE.0, SIZE.1, of)
    }

    /// Floors seen from above: depth grows with y, from 10 to 20.
    fn depth() -> Image<f32> {
        picture(|_, y| 10.0 + 0.1 * y as f32)
    }

    /// Shadows with edges every so many columns, at most `soft` columns wide.
    fn stripes(every: u32, soft: f32) -> impl Fn(u32, u32) -> f32 {
        move |x, _| (0.5 + ((x % every) as f32 - every as f32 / 2.0) / soft.max(1e-3)).clamp(0.0, 1.0)
    }

    /// Around borders at these distances.
    fn around(distances: &[f64]) -> Image<bool> {
        let layers = 0..=distances.len() as u32;
        let views: Vec<LightView> =
            layers.map(|layer| LightView::of(DMat4::from_scale(DVec3::ZERO), 8, layer)).collect();
        around_borders(&views, distances, &Camera::default(), &depth())
    }

    fn found(produced: &Image<f32>, reference: &Image<f32>, distances: &[f64]) -> Option<f64> {
        seam(produced, reference, &Image::filled(SIZE.0, SIZE.1, true), &around(distances))
            .expect("pictures of one size")
    }

    /// Moves a picture to the right by as many pixels as `by` says for each row.
    fn moved(of: &dyn Fn(u32, u32) -> f32, by: impl Fn(u32) -> u32) -> Image<f32> {
        picture(|x, y| of(x.saturating_sub(by(y)), y))
    }

    #[test]
    fn edges_off_three_times_as_far_around_a_border_are_a_seam_of_three() {
        // The border at 15 reaches from row 42.5 to 57.5.
        let is_near = |y: u32| (43..=57).contains(&y);
        for (every, soft) in [(20, 0.0), (50, 8.0)] {
            let shadows = stripes(every, soft);
            let seam = found(&moved(&shadows, |y| if is_near(y) { 6 } else { 2 }), &picture(&shadows), &[15.0]);
            assert!(seam.is_some_and(|seam| (seam - 3.0).abs() < 0.02), "{seam:?} of stripes {soft} wide");
        }
    }

    #[test]
    fn how_many_shadows_there_are_does_not_decide() {
        let (few, many) = (stripes(50, 0.0), stripes(10, 0.0));
        let shadows = |x: u32, y: u32| if (43..=57).contains(&y) { many(x, y) } else { few(x, y) };
        let seam = found(&moved(&shadows, |_| 2), &picture(shadows), &[15.0]).expect("a seam");
        assert!((seam - 1.0).abs() < 0.1, "{seam}");
    }

    #[test]
    fn a_hole_at_the_border_is_a_seam() {
        let shadows = stripes(50, 0.0);
        let mut holed = moved(&shadows, |_| 1);
        let whole = found(&holed, &picture(&shadows), &[15.0]).expect("a seam");
        (0..SIZE.0).for_each(|x| holed[(x, 50)] = 1.0);
        let seam = found(&holed, &picture(&shadows), &[15.0]).expect("a seam");
        assert!((whole - 1.0).abs() < 0.02 && seam > 1.5, "{whole} {seam}");
    }

    #[test]
    fn what_says_nothing_has_no_seam() {
        let shadows = stripes(20, 0.0);
        let (right, off) = (picture(&shadows), moved(&shadows, |_| 2));
        assert_eq!(found(&off, &right, &[]), None, "no border");
        assert_eq!(found(&off, &right, &[50.0]), None, "nothing is there");
        assert_eq!(found(&right, &right, &[15.0]), None, "no error");
        assert_eq!(found(&picture(|_, _| 0.9), &picture(|_, _| 1.0), &[15.0]), None, "no shadow");
        let small = Image::filled(4, 4, true);
        let mask = Image::filled(SIZE.0, SIZE.1, true);
        let wrong = seam(&right, &right, &mask, &small);
        assert!(matches!(wrong, Err(Error::Size { name: "around", .. })), "{wrong:?}");
    }
}

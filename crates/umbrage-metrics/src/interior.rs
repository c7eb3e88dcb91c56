//! Pixels far from every shadow edge.

use umbrage_core::Image;

/// How far from a change of the reference a pixel must be at least to count as interior, pixels.
pub const REACH_PIXELS: f32 = 3.0;

/// Visibility that varies by no more than this counts as constant.
const CONSTANT: f32 = 1e-3;

/// True for scored pixels farther than a reach from any change of the reference among scored
/// pixels: where the reference is constant over the whole square around them.
///
/// `reach` gives each pixel a reach in pixels, rounded up; it is raised to [`REACH_PIXELS`], which
/// `None` means everywhere. For techniques with a map it is two map texels as seen on the screen,
/// so that a coarse map is not judged here for its resolution. Pixels outside a smaller `mask` are
/// not scored.
pub fn interior(reference: &Image<f32>, mask: &Image<bool>, reach: Option<&Image<f32>>) -> Image<bool> {
    let largest = reference.width.max(reference.height);
    let radius = |x: u32, y: u32| {
        let pixels = reach.and_then(|r| r.get(x.into(), y.into())).map_or(REACH_PIXELS, |r| r.max(REACH_PIXELS));
        (pixels.ceil() as u32).min(largest.max(REACH_PIXELS as u32))
    };
    let scored = |x: u32, y: u32| mask.get(x.into(), y.into()) == Some(&true);
    let (width, height) = reference.size();
    let mut inside = Image::filled(width, height, false);
    // Ranges of the reference over squares of radius `known`, doubled until every pixel's own
    // square was built of them.
    let mut known = 1;
    let mut ranges =
        Image::from_fn(width, height, |x, y| if scored(x, y) { Range::of(reference[(x, y)]) } else { Range::EMPTY });
    ranges = square(&ranges, &[-1, 0, 1]);
    loop {
        let mut larger = false;
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|&(x, y)| scored(x, y)) {
            let r = radius(x, y);
            larger |= r > 2 * known;
            if r > known && r <= 2 * known {
                let step = i64::from(r - known);
                inside[(x, y)] = around(&ranges, x, y, &[-step, step]).is_constant();
            }
        }
        if !larger {
            return inside;
        }
        ranges = square(&ranges, &[-i64::from(known), i64::from(known)]);
        known *= 2;
    }
}

/// Smallest and largest value among some pixels.
#[derive(Clone, Copy)]
struct Range {
    low: f32,
    high: f32,
}

impl Range {
    const EMPTY: Self = Self { low: f32::INFINITY, high: f32::NEG_INFINITY };

    fn of(value: f32) -> Self {
        Self { low: value, high: value }
    }

    fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn is_constant(self) -> bool {
        self.high - self.low <= CONSTANT
    }
}

/// The union of ranges at all combinations of `steps` in x and y from (x, y), moved into the
/// picture: squares around the moved centres stay within the whole square and still reach its part
/// of the picture.
fn around(ranges: &Image<Range>, x: u32, y: u32, steps: &[i64]) -> Range {
    let column = |step: i64| (i64::from(x) + step).clamp(0, i64::from(ranges.width) - 1) as u32;
    let row = |step: i64| (i64::from(y) + step).clamp(0, i64::from(ranges.height) - 1) as u32;
    let pairs = steps.iter().flat_map(|&i| steps.iter().map(move |&j| (i, j)));
    pairs.fold(Range::EMPTY, |range, (i, j)| range.union(ranges[(column(i), row(j))]))
}

fn square(ranges: &Image<Range>, steps: &[i64]) -> Image<Range> {
    Image::from_fn(ranges.width, ranges.height, |x, y| around(ranges, x, y, steps))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn three_pixels_on_either_side_of_an_edge_are_left_out() {
        let flat = Image::from_fn(20, 20, |x, _| if x < 10 { 1.0 } else { 0.0 });
        let inside = interior(&flat, &Image::filled(20, 20, true), None);
        for x in 0..20 {
            assert_eq!(inside[(x, 9)], !(7..13).contains(&x), "column {x}");
        }
    }

    /// By the definition, pixel by pixel.
    fn plain(reference: &Image<f32>, mask: &Image<bool>, reach: &Image<f32>) -> Image<bool> {
        Image::from_fn(reference.width, reference.height, |x, y| {
            let r = reach[(x, y)].max(3.0).ceil() as i64;
            let mut range = Range::EMPTY;
            for j in i64::from(y) - r..=i64::from(y) + r {
                for i in i64::from(x) - r..=i64::from(x) + r {
                    if mask.get(i, j) == Some(&true) {
                        range = range.union(Range::of(reference[(i as u32, j as u32)]));
                    }
                }
            }
            mask[(x, y)] && range.is_constant()
        })
    }

    proptest! {
        #[test]
        fn equals_its_definition(seed: u64, width in 1_u32..40, height in 1_u32..40, spots in 0_u32..6) {
            let random = |x: u32, y: u32, k: u64| {
                let mut h = seed ^ (u64::from(x) << 40) ^ (u64::from(y) << 20) ^ k;
                for _ in 0..3 {
                    h = (h ^ (h >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
                }
                (h >> 40) as f32 / (1 << 24) as f32
            };
            let spot = |x, y| random(x, y, 1) < spots as f32 / 300.0;
            let reference = Image::from_fn(width, height, |x, y| if spot(x, y) { 0.5 } else { 1.0 });
            let mask = Image::from_fn(width, height, |x, y| random(x, y, 2) < 0.9);
            let reach = Image::from_fn(width, height, |x, y| random(x, y, 3) * 20.0);
            prop_assert_eq!(interior(&reference, &mask, Some(&reach)), plain(&reference, &mask, &reach));
        }
    }

    #[test]
    fn an_infinite_reach_looks_at_the_whole_picture() {
        let mut picture = Image::filled(30, 20, 1.0);
        let (mask, reach) = (Image::filled(30, 20, true), Image::filled(30, 20, f32::INFINITY));
        assert!(interior(&picture, &mask, Some(&reach)).data.iter().all(|i| *i));
        picture[(29, 19)] = 0.0;
        assert!(interior(&picture, &mask, Some(&reach)).data.iter().all(|i| !i));
    }
}

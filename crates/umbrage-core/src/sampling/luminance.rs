//! A picture as a distribution: points where it is bright.

use crate::material::Texture;
use glam::DVec2;

/// The brightness of a picture as a piecewise-constant density over the square [0, 1]², ready to be
/// sampled by inverting its marginal and conditional distributions (Pharr, Jakob, Humphreys,
/// "Physically Based Rendering", 2023, A.4).
#[derive(Debug)]
pub struct Luminance {
    /// The rows' shares, summed up: `height + 1` numbers from 0 to 1.
    rows: Vec<f64>,
    /// Within each row the pixels' shares, summed up: `width + 1` numbers from 0 to 1 a row.
    columns: Vec<f64>,
}

impl Luminance {
    /// The linear luminance (Rec. 709) of the picture's colour; alpha counts for nothing. `None`
    /// where nothing is bright or the picture holds fewer pixels than it should.
    pub fn of(texture: &Texture) -> Option<Self> {
        let width = texture.width as usize;
        if width == 0 || texture.rgba.len() != width * texture.height as usize {
            return None;
        }
        let linear: [f64; 256] = std::array::from_fn(|i| linear_from_srgb(i as f64 / 255.0));
        let of = |p: &[u8; 4]| {
            let [r, g, b] = [p[0], p[1], p[2]].map(|c| linear[usize::from(c)]);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let mut columns = Vec::with_capacity((width + 1) * texture.height as usize);
        let mut totals = Vec::with_capacity(texture.height as usize);
        for row in texture.rgba.chunks_exact(width) {
            let (sums, total) = cumulative(row.iter().map(of));
            columns.extend(sums);
            totals.push(total);
        }
        let (rows, total) = cumulative(totals.into_iter());
        (total > 0.0).then_some(Self { rows, columns })
    }

    /// Takes evenly spread points to points as dense as the picture is bright; x along a row, y
    /// down from row 0.
    pub fn sample(&self, u: DVec2) -> DVec2 {
        let (row, y) = invert(&self.rows, u.y);
        let width = self.columns.len() / (self.rows.len() - 1);
        let (_, x) = invert(&self.columns[row * width..(row + 1) * width], u.x);
        DVec2::new(x, y)
    }

    /// The share of the whole brightness within a rectangle of the square, x along a row, y down
    /// from row 0.
    pub fn within(&self, low: DVec2, high: DVec2) -> f64 {
        let width = self.columns.len() / (self.rows.len() - 1);
        let up_to = |row: usize, x: f64| interpolate(&self.columns[row * width..(row + 1) * width], x);
        let height = (self.rows.len() - 1) as f64;
        let first = (low.y.clamp(0.0, 1.0) * height) as usize;
        let last = (high.y.clamp(0.0, 1.0) * height).ceil() as usize;
        let of_row = |row: usize| {
            let part = (high.y * height).min((row + 1) as f64) - (low.y * height).max(row as f64);
            let share = (self.rows[row + 1] - self.rows[row]) * part.max(0.0);
            share * (up_to(row, high.x) - up_to(row, low.x))
        };
        (first..last).map(of_row).sum()
    }
}

/// A running sum at a place in [0, 1] over all cells.
fn interpolate(sums: &[f64], at: f64) -> f64 {
    let scaled = at.clamp(0.0, 1.0) * (sums.len() - 1) as f64;
    let cell = (scaled as usize).min(sums.len() - 2);
    sums[cell] + (sums[cell + 1] - sums[cell]) * (scaled - cell as f64)
}

/// Running sums of `weights` from 0 to 1, and the total before that scaling. Zeros only: all 0.
fn cumulative(weights: impl Iterator<Item = f64>) -> (Vec<f64>, f64) {
    let mut sums = vec![0.0];
    let mut total = 0.0;
    for w in weights {
        total += w;
        sums.push(total);
    }
    if total > 0.0 {
        sums.iter_mut().for_each(|s| *s /= total);
    }
    (sums, total)
}

/// The cell of the running sums that `u` falls into, never an empty one, and the place in [0, 1]
/// over all cells.
fn invert(sums: &[f64], u: f64) -> (usize, f64) {
    let cells = sums.len() - 1;
    // Past the last sum that is not above `u`: cells without weight repeat their sum and are passed
    // over.
    let u = u.clamp(0.0, 1.0 - f64::EPSILON);
    let cell = sums.partition_point(|s| *s <= u).clamp(1, cells) - 1;
    let weight = sums[cell + 1] - sums[cell];
    let within = if weight > 0.0 { (u - sums[cell]) / weight } else { 0.5 };
    (cell, (cell as f64 + within) / cells as f64)
}

fn linear_from_srgb(c: f64) -> f64 {
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::lattice;

    fn texture(width: u32, height: u32, grey: &[u8]) -> Texture {
        let rgba = grey.iter().map(|&g| [g, g, g, 255]).collect();
        Texture { name: "test".into(), width, height, rgba, sampling: Default::default() }
    }

    #[test]
    fn points_follow_the_linear_brightness() {
        // sRGB 188 is half of white in linear light; sRGB 0 must get nothing.
        let t = texture(3, 2, &[255, 0, 188, 0, 188, 0]);
        let half = linear_from_srgb(188.0 / 255.0);
        let want = [1.0, 0.0, half, 0.0, half, 0.0].map(|w| w / (1.0 + 2.0 * half));
        let luminance = Luminance::of(&t).unwrap();
        let mut counts = [0.0; 6];
        for u in lattice(10_000) {
            let p = luminance.sample(u);
            counts[(p.y * 2.0) as usize * 3 + (p.x * 3.0) as usize] += 1e-4;
        }
        for (i, (got, want)) in counts.into_iter().zip(want).enumerate() {
            assert!((got - want).abs() < 2e-3, "pixel {i}: share {got} instead of {want}");
        }
    }

    #[test]
    fn a_flat_picture_leaves_points_where_they_are() {
        let luminance = Luminance::of(&texture(4, 3, &[77; 12])).unwrap();
        for u in lattice(100) {
            assert!((luminance.sample(u) - u).length() < 1e-12);
        }
    }

    #[test]
    fn rectangles_hold_their_pixels() {
        let luminance = Luminance::of(&texture(2, 2, &[255, 255, 0, 255])).unwrap();
        let within = |x: [f64; 2], y: [f64; 2]| luminance.within(DVec2::new(x[0], y[0]), DVec2::new(x[1], y[1]));
        assert!((within([0.0, 1.0], [0.0, 1.0]) - 1.0).abs() < 1e-12);
        assert!((within([0.0, 0.5], [0.5, 1.0])).abs() < 1e-12);
        assert!((within([0.25, 0.75], [0.0, 1.0]) - 0.5).abs() < 1e-12);
        assert!((within([0.5, 1.0], [0.25, 0.75]) - 1.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn black_or_truncated_pictures_are_no_distribution() {
        assert!(Luminance::of(&texture(2, 2, &[0; 4])).is_none());
        assert!(Luminance::of(&texture(2, 2, &[255; 3])).is_none());
        assert!(Luminance::of(&texture(0, 0, &[])).is_none());
    }

    #[test]
    fn the_ends_of_the_square_stay_on_bright_pixels() {
        let luminance = Luminance::of(&texture(4, 1, &[0, 200, 100, 0])).unwrap();
        for x in [0.0, 1.0 - 1e-17, 1.0] {
            let p = luminance.sample(DVec2::new(x, x));
            assert!(p.x >= 0.25 && p.x <= 0.75 && p.y <= 1.0, "{p}");
        }
    }
}

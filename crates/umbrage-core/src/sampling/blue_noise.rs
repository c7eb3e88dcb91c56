//! An order of pixels in which any number of the first ones is spread evenly.

use super::points::shift;

/// Standard deviation of the Gaussian that crowding is measured by, pixels: the value of the paper.
const SIGMA: f64 = 1.5;

/// How far from a pixel that Gaussian is summed, pixels. At the next one it has fallen to 7·10⁻⁷.
const REACH: i32 = 7;

/// A tile of blue noise, `size` × `size` pixels, row by row: each pixel's rank, a permutation of 0
/// to size² − 1.
///
/// For any `n` the pixels of a rank below `n` are as far apart as `n` pixels can be, also across
/// the borders of repeated tiles, so neighbours get very different ranks. Void and cluster:
/// Ulichney, "The void-and-cluster method for dither array generation", 1993. The time goes by
/// size⁴; 32 × 32 take milliseconds, 256 × 256 minutes.
pub fn blue_noise(size: u32) -> Vec<u32> {
    let pixels = (size * size) as usize;
    let mut ranks = vec![0; pixels];
    let mut first = spread_evenly(size, pixels.div_ceil(10));
    // The method's third phase, in which the unset pixels are the minority and the tightest cluster
    // of them is set, is the second gone on: energies of set and unset pixels add up to the same
    // sum everywhere.
    let mut tile = first.clone();
    for rank in first.count..pixels {
        let void = tile.largest_void();
        tile.set(void, true);
        ranks[void] = rank as u32;
    }
    for rank in (0..first.count).rev() {
        let cluster = first.tightest_cluster();
        first.set(cluster, false);
        ranks[cluster] = rank as u32;
    }
    ranks
}

/// `count` pixels of a tile, moved from where they are crowded to where there are none until that
/// helps no more.
fn spread_evenly(size: u32, count: usize) -> Tile {
    let mut tile = Tile::new(size);
    let mut by_chance: Vec<usize> = (0..tile.is_set.len()).collect();
    by_chance.sort_by_key(|&pixel| tile.chance[pixel]);
    for &pixel in &by_chance[..count] {
        tile.set(pixel, true);
    }
    while tile.count > 0 {
        let cluster = tile.tightest_cluster();
        tile.set(cluster, false);
        let void = tile.largest_void();
        tile.set(void, true);
        if void == cluster {
            break;
        }
    }
    tile
}

/// Pixels on a torus, some of them set.
#[derive(Clone)]
struct Tile {
    size: i32,
    is_set: Vec<bool>,
    count: usize,
    /// Sum of the Gaussians around all set pixels. Whole numbers, so that what is added can be
    /// taken off again.
    energy: Vec<u64>,
    /// Decides among pixels of the same energy.
    chance: Vec<u32>,
    /// The Gaussian by offset, row by row.
    gaussian: Vec<u64>,
}

impl Tile {
    fn new(size: u32) -> Self {
        let pixels = (size * size) as usize;
        let bell = |x: i32| (-0.5 * (f64::from(x) / SIGMA).powi(2)).exp();
        let offsets = -REACH..=REACH;
        let value = |x, y| (bell(x) * bell(y) * f64::from(1 << 30)).round() as u64;
        Self {
            size: size as i32,
            is_set: vec![false; pixels],
            count: 0,
            energy: vec![0; pixels],
            chance: (0..size * size).map(|pixel| (shift(pixel).x * f64::from(u32::MAX)) as u32).collect(),
            gaussian: offsets.clone().flat_map(|y| offsets.clone().map(move |x| value(x, y))).collect(),
        }
    }

    /// Sets a pixel that is not set, or the other way round.
    fn set(&mut self, pixel: usize, on: bool) {
        self.is_set[pixel] = on;
        self.count = if on { self.count + 1 } else { self.count - 1 };
        let (x, y) = (pixel as i32 % self.size, pixel as i32 / self.size);
        let columns: Vec<usize> = (-REACH..=REACH).map(|dx| (x + dx).rem_euclid(self.size) as usize).collect();
        for (dy, bells) in (-REACH..=REACH).zip(self.gaussian.chunks(columns.len())) {
            let row = ((y + dy).rem_euclid(self.size) * self.size) as usize;
            for (column, bell) in columns.iter().zip(bells) {
                let energy = &mut self.energy[row + column];
                *energy = if on { *energy + bell } else { *energy - bell };
            }
        }
    }

    /// The set pixel with the most set pixels around. Called where there is one.
    fn tightest_cluster(&self) -> usize {
        self.pixels(true).max_by_key(|&pixel| (self.energy[pixel], self.chance[pixel])).unwrap_or_default()
    }

    /// The pixel not set that has the fewest set pixels around. Called where there is one.
    fn largest_void(&self) -> usize {
        self.pixels(false).min_by_key(|&pixel| (self.energy[pixel], self.chance[pixel])).unwrap_or_default()
    }

    fn pixels(&self, set: bool) -> impl Iterator<Item = usize> + '_ {
        (0..self.is_set.len()).filter(move |&pixel| self.is_set[pixel] == set)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Mean power of a tile's frequencies up to `highest` cycles along either axis, the mean left
    /// out.
    fn low_power(tile: &[f64], size: usize, highest: i32) -> f64 {
        let frequencies = (-highest..=highest).flat_map(|u| (-highest..=highest).map(move |v| (u, v)));
        let powers: Vec<f64> = frequencies
            .filter(|&frequency| frequency != (0, 0))
            .map(|(u, v)| {
                let (mut real, mut imaginary) = (0.0, 0.0);
                for (pixel, value) in tile.iter().enumerate() {
                    let (x, y) = ((pixel % size) as f64, (pixel / size) as f64);
                    let (sin, cos) = (TAU * (f64::from(u) * x + f64::from(v) * y) / size as f64).sin_cos();
                    real += value * cos;
                    imaginary += value * sin;
                }
                real * real + imaginary * imaginary
            })
            .collect();
        powers.iter().sum::<f64>() / powers.len() as f64
    }

    #[test]
    fn every_rank_comes_once() {
        for size in [0, 1, 2, 3, 5, 16, 32] {
            let mut ranks = blue_noise(size);
            ranks.sort_unstable();
            assert!(ranks.into_iter().eq(0..size * size), "{size}");
        }
    }

    #[test]
    fn low_frequencies_are_far_below_those_of_white_noise() {
        let (size, pixels) = (32, 1024.0);
        let ranks = blue_noise(size as u32);
        // The ranks themselves, against numbers of variance 1/12, whose power is pixels / 12 at
        // every frequency.
        let values: Vec<f64> = ranks.iter().map(|&rank| (f64::from(rank) + 0.5) / pixels - 0.5).collect();
        let share = low_power(&values, size, 4) / (pixels / 12.0);
        assert!(share < 0.02, "ranks: {share} of white noise");
        // The first ranks alone, against as many points at random.
        for first in [32, 64, 128, 256, 512, 900] {
            let filled = f64::from(first) / pixels;
            let values: Vec<f64> = ranks.iter().map(|&rank| f64::from(u8::from(rank < first)) - filled).collect();
            let share = low_power(&values, size, 2) / (pixels * filled * (1.0 - filled));
            assert!(share < 0.1, "the first {first}: {share} of white noise");
        }
    }

    #[test]
    fn the_first_pixels_are_far_apart_across_borders() {
        let (size, first) = (32, 64);
        let ranks = blue_noise(32);
        let places: Vec<i32> = (0..size * size).filter(|&pixel| ranks[pixel as usize] < first).collect();
        let around = |d: i32| d.rem_euclid(size).min((-d).rem_euclid(size));
        for (i, a) in places.iter().enumerate() {
            for b in &places[..i] {
                let (x, y) = (around(a % size - b % size), around(a / size - b / size));
                // One in 16 pixels: a square grid would have them 4 apart.
                assert!(x * x + y * y >= 5, "{a} and {b} are too close");
            }
        }
    }
}

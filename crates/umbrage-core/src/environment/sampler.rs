//! Directions where the sky is bright.

use super::{Environment, Sky, Sun, direction_of, place_of, place_of_pixel, solid_angle};
use glam::{DMat3, DVec2, DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// Draws directions about as densely as an environment is bright, and tells how densely (Pharr,
/// Jakob, Humphreys, "Physically Based Rendering", 2023, 12.5).
///
/// The density is that of a grid of at most 1024 × 512 cells, even in solid angle within each, so
/// that a picture of any size takes no more than some megabytes; a sun that is apart is drawn
/// apart.
pub struct EnvironmentSampler {
    world_from_sky: DMat3,
    cells: Cells,
    sun: Option<Sun>,
    /// The share of directions that go to the sun.
    sun_share: f64,
    is_even: bool,
}

/// Finer grids gain nothing: within a cell other directions make up for it.
const MOST_ROWS: u32 = 512;

/// Rows of the grid for skies that are no pictures.
const ROWS: u32 = 64;

struct Cells {
    width: u32,
    height: u32,
    /// The rows' shares, summed up: `height + 1` numbers from 0 to 1.
    rows: Vec<f64>,
    /// Within each row the cells' shares, summed up: `width + 1` numbers a row.
    columns: Vec<f64>,
}

impl EnvironmentSampler {
    /// Of an environment as it is turned.
    pub fn new(environment: &Environment) -> Self {
        let (width, height) = match &environment.sky {
            Sky::Constant(_) => (1, 1),
            Sky::Gradient(_) | Sky::Daylight(_) => (2 * ROWS, ROWS),
            Sky::Picture(picture) => {
                let (width, height) = picture.image().size();
                (width.min(2 * MOST_ROWS), height.min(MOST_ROWS))
            }
        };
        let weights = weights(&environment.sky, width, height);
        let sky_power: f64 = weights.iter().sum();
        let sun = environment.sky.sun().copied();
        let sun_power = sun.map_or(0.0, |sun| luminance(sun.radiance) * sun.solid_angle());
        let sun_share = if sun_power > 0.0 { sun_power / (sun_power + sky_power) } else { 0.0 };
        Self {
            world_from_sky: environment.world_from_sky(),
            is_even: matches!(environment.sky, Sky::Constant(_)) || sky_power + sun_power <= 0.0,
            cells: Cells::new(width, height, &weights),
            sun,
            sun_share,
        }
    }

    /// True where no direction is brighter than another: there is nothing to gain from this.
    pub fn is_even(&self) -> bool {
        self.is_even
    }

    /// The direction, a unit vector, that belongs to `u` in [0, 1)², and its
    /// [density](Self::density).
    pub fn sample(&self, u: DVec2) -> (DVec3, f64) {
        let direction = match &self.sun {
            Some(sun) if u.x < self.sun_share => sun.sample(DVec2::new(u.x / self.sun_share, u.y)),
            _ => self.cells.sample(DVec2::new((u.x - self.sun_share) / (1.0 - self.sun_share), u.y)),
        };
        (self.world_from_sky * direction, self.density_in_sky(direction))
    }

    /// How densely directions are drawn there, a steradian.
    pub fn density(&self, direction: DVec3) -> f64 {
        self.density_in_sky(self.world_from_sky.transpose() * direction)
    }

    fn density_in_sky(&self, direction: DVec3) -> f64 {
        let of_sun = self.sun.filter(|sun| sun.holds(direction)).map_or(0.0, |sun| 1.0 / sun.solid_angle());
        self.sun_share * of_sun + (1.0 - self.sun_share) * self.cells.density(direction)
    }
}

impl Cells {
    fn new(width: u32, height: u32, weights: &[f64]) -> Self {
        let mut columns = Vec::with_capacity((width as usize + 1) * height as usize);
        let mut totals = Vec::with_capacity(height as usize);
        for (y, row) in (0..height).zip(weights.chunks_exact(width as usize)) {
            totals.push(sum_up(row.iter().copied(), &mut columns));
            // A row without light is even, for rounding's sake: it is never chosen.
            if totals.last() == Some(&0.0) {
                let start = y as usize * (width as usize + 1);
                (0..=width as usize).for_each(|x| columns[start + x] = x as f64 / f64::from(width));
            }
        }
        let mut rows = Vec::with_capacity(height as usize + 1);
        if sum_up(totals.into_iter(), &mut rows) == 0.0 {
            rows.clear();
            sum_up((0..height).map(|y| solid_angle(1, height, y)), &mut rows);
        }
        Self { width, height, rows, columns }
    }

    fn row(&self, y: usize) -> &[f64] {
        let width = self.width as usize + 1;
        &self.columns[y * width..(y + 1) * width]
    }

    fn sample(&self, u: DVec2) -> DVec3 {
        let (y, down) = invert(&self.rows, u.y);
        let (x, right) = invert(self.row(y), u.x);
        let cos = |y: usize| (PI * y as f64 / f64::from(self.height)).cos();
        let cos_theta = cos(y) + (cos(y + 1) - cos(y)) * down;
        let phi = TAU * ((x as f64 + right) / f64::from(self.width) - 0.5);
        let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
        DVec3::new(sin_theta * phi.sin(), cos_theta, -sin_theta * phi.cos())
    }

    fn density(&self, direction: DVec3) -> f64 {
        let place = place_of(direction) * DVec2::new(self.width.into(), self.height.into());
        let (x, y) = ((place.x as u32).min(self.width - 1), (place.y as u32).min(self.height - 1));
        let (row, i) = (self.row(y as usize), x as usize);
        let share = (row[i + 1] - row[i]) * (self.rows[y as usize + 1] - self.rows[y as usize]);
        share / solid_angle(self.width, self.height, y)
    }
}

/// Luminance × solid angle of each cell, row by row.
fn weights(sky: &Sky, width: u32, height: u32) -> Vec<f64> {
    let mut weights = vec![0.0; width as usize * height as usize];
    let Sky::Picture(picture) = sky else {
        let size = DVec2::new(width.into(), height.into());
        for (i, weight) in weights.iter_mut().enumerate() {
            let (x, y) = (i as u32 % width, i as u32 / width);
            let direction = direction_of(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / size);
            *weight = luminance(sky.radiance_without_sun(direction)) * solid_angle(width, height, y);
        }
        return weights;
    };
    // Each pixel is spread about as interpolation spreads it.
    let image = picture.image();
    let pixel = DVec2::new(image.width.into(), image.height.saturating_sub(1).max(1).into()).recip();
    for (i, color) in image.data.iter().enumerate() {
        let place = place_of_pixel(image.size(), i as u32 % image.width, i as u32 / image.width);
        let light = luminance(Vec3::from(*color));
        for ((down, of_row), (right, of_column)) in
            SPREAD.into_iter().flat_map(|row| SPREAD.map(|column| (row, column)))
        {
            let near = place + DVec2::new(right, down) * pixel;
            if !(0.0..=1.0).contains(&near.y) {
                continue;
            }
            let x = (near.x.rem_euclid(1.0) * f64::from(width)) as u32;
            let y = (near.y * f64::from(height)) as u32;
            let cell = y.min(height - 1) * width + x.min(width - 1);
            // At the poles themselves a row has no extent, and beside them it has.
            let extent = (PI * near.y).sin().max(0.1 * pixel.y);
            weights[cell as usize] += light * of_row * of_column * extent * pixel.x * pixel.y * TAU * PI;
        }
    }
    weights
}

/// Places around a pixel, in pixels, and the shares of it there.
const SPREAD: [(f64, f64); 5] = [(-0.8, 0.1), (-0.4, 0.2), (0.0, 0.4), (0.4, 0.2), (0.8, 0.1)];

fn luminance(color: Vec3) -> f64 {
    color.as_dvec3().dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

/// Appends running sums from 0 to 1 of `weights`, and gives back the total before that.
fn sum_up(weights: impl Iterator<Item = f64>, sums: &mut Vec<f64>) -> f64 {
    let start = sums.len();
    let mut total = 0.0;
    sums.push(0.0);
    for weight in weights {
        total += weight;
        sums.push(total);
    }
    if total > 0.0 {
        sums[start..].iter_mut().for_each(|sum| *sum /= total);
    }
    total
}

/// The cell that `u` falls into, never one without weight, and the place in it from 0 to 1.
fn invert(sums: &[f64], u: f64) -> (usize, f64) {
    let u = u.clamp(0.0, 1.0 - f64::EPSILON);
    let cell = sums.partition_point(|sum| *sum <= u).clamp(1, sums.len() - 1) - 1;
    let weight = sums[cell + 1] - sums[cell];
    (cell, if weight > 0.0 { ((u - sums[cell]) / weight).clamp(0.0, 1.0) } else { 0.5 })
}

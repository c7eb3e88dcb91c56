//! Paths from a surface to the sky.

use super::RadianceOptions;
use super::surfaces::{Point, Surfaces};
use crate::tracer::{CLEARANCE, Tracer};
use crate::triangle::Ray;
use std::f64::consts::FRAC_1_PI;
use umbrage_core::Environment;
use umbrage_core::environment::EnvironmentSampler;
use umbrage_core::glam::{DVec2, DVec3};
use umbrage_core::sampling::{lattice, rotated, shift, square_to_disc};

/// The sky, ready to be drawn from.
pub(super) struct Light<'a> {
    environment: &'a Environment,
    sampler: EnvironmentSampler,
}

/// What traces the paths of one row of pixels.
pub(super) struct Paths<'a> {
    tracer: &'a Tracer,
    surfaces: &'a Surfaces<'a>,
    light: &'a Light<'a>,
    bounces: u32,
    points: Vec<DVec2>,
    pub rays: u64,
}

impl<'a> Light<'a> {
    pub fn new(environment: &'a Environment) -> Self {
        Self { environment, sampler: EnvironmentSampler::new(environment) }
    }

    fn radiance(&self, direction: DVec3) -> DVec3 {
        self.environment.radiance(direction).as_dvec3()
    }

    /// How densely a direction is drawn in all: by the cosine and, unless the sky is even, by its
    /// brightness.
    fn density(&self, cosine: f64, direction: DVec3) -> f64 {
        let of_sky = if self.sampler.is_even() { 0.0 } else { self.sampler.density(direction) };
        cosine * FRAC_1_PI + of_sky
    }
}

impl<'a> Paths<'a> {
    pub fn new(
        tracer: &'a Tracer,
        surfaces: &'a Surfaces<'a>,
        light: &'a Light<'a>,
        options: &RadianceOptions,
        per_round: u32,
    ) -> Self {
        let bounces = options.bounces;
        Self { tracer, surfaces, light, bounces, points: lattice(per_round as usize), rays: 0 }
    }

    /// The mean of the samples of one round of a pixel.
    pub fn round(&mut self, point: &Point, pixel: u32, round: u32) -> DVec3 {
        // The multiplier is odd: a pixel gets the same points in no two rounds.
        let seed = pixel.wrapping_add(round.wrapping_mul(0x9e37_79b9));
        let mut random = Random::new(pixel, round);
        let count = self.points.len();
        let mut sum = DVec3::ZERO;
        for i in 0..count {
            let u = self.points[i];
            let first = [rotated(u, shift(seed)), rotated(u, shift(!seed))];
            sum += self.path(*point, first, &mut random);
        }
        sum / count as f64
    }

    /// What one path brings; `first` are the numbers that its first directions are drawn by.
    fn path(&mut self, mut point: Point, first: [DVec2; 2], random: &mut Random) -> DVec3 {
        let (mut light, mut share) = (DVec3::ZERO, point.albedo);
        let mut numbers = first;
        for left in (0..=self.bounces).rev() {
            light += share * self.sky_light(&point, numbers[0]);
            let Some((direction, cosine)) = cosine_direction(point.normal, numbers[1]) else { break };
            // Of both ways to draw a direction, this one's weight is that of its density; the
            // cosine and π cancel out.
            let weight = cosine * FRAC_1_PI / self.light.density(cosine, direction);
            let ray = self.ray(&point, direction);
            self.rays += 1;
            let Some((triangle, t)) = self.tracer.casting().first(&ray, point.triangle, &self.tracer.cutouts) else {
                light += share * self.light.radiance(direction) * weight;
                break;
            };
            if left == 0 {
                break;
            }
            point = self.surfaces.met(triangle, point.position + direction * t, direction);
            share *= point.albedo;
            numbers = [random.point(), random.point()];
        }
        light
    }

    /// The share of the sky's light that is drawn by where the sky is bright.
    fn sky_light(&mut self, point: &Point, u: DVec2) -> DVec3 {
        if self.light.sampler.is_even() {
            return DVec3::ZERO;
        }
        let (direction, _) = self.light.sampler.sample(u);
        let cosine = point.normal.dot(direction);
        if cosine <= 0.0 {
            return DVec3::ZERO;
        }
        let radiance = self.light.radiance(direction);
        let found = radiance * (cosine * FRAC_1_PI / self.light.density(cosine, direction));
        let ray = self.ray(point, direction);
        self.rays += 1;
        let blocked = self.tracer.casting().is_blocked(&ray, point.triangle, &self.tracer.cutouts);
        if blocked { DVec3::ZERO } else { found }
    }

    /// Starts clear of the surface, in its own direction, as rays to lights do.
    fn ray(&self, point: &Point, direction: DVec3) -> Ray {
        let t_min = CLEARANCE * self.tracer.scale / point.plane.dot(direction).abs().max(f64::MIN_POSITIVE);
        Ray { origin: point.position, direction, t_min, t_max: f64::INFINITY }
    }
}

/// A direction as dense as its cosine with the normal, and that cosine; `None` along the surface.
fn cosine_direction(normal: DVec3, u: DVec2) -> Option<(DVec3, f64)> {
    let disc = square_to_disc(u);
    let cosine = (1.0 - disc.length_squared()).max(0.0).sqrt();
    let (a, b) = normal.any_orthonormal_pair();
    (cosine > 0.0).then(|| (a * disc.x + b * disc.y + normal * cosine, cosine))
}

/// Numbers for all but the first directions: SplitMix64 (Steele, Lea, Flood, "Fast Splittable
/// Pseudorandom Number Generators", 2014).
struct Random(u64);

impl Random {
    fn new(pixel: u32, round: u32) -> Self {
        Self((u64::from(pixel) << 32 | u64::from(round)).wrapping_mul(0xd1b5_4a32_d192_ed03))
    }

    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn point(&mut self) -> DVec2 {
        DVec2::new(self.next(), self.next())
    }
}

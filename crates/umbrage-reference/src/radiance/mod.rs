//! The light that an environment makes surfaces send to the eye: direct, and reflected again.

mod path;
mod surfaces;

use crate::geometry::Geometry;
use crate::tracer::Tracer;
use path::{Light, Paths};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use surfaces::Surfaces;
use umbrage_core::glam::{DVec2, DVec3};
use umbrage_core::{Camera, Environment, Image, Scene};

/// How to trace radiance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RadianceOptions {
    /// Paths for every pixel, at least two; rounded up to whole rounds.
    pub samples: u32,
    /// How often light is reflected before the surface that is seen reflects it: with 0 it comes
    /// from the environment alone. At most [`Self::MOST_BOUNCES`].
    pub bounces: u32,
}

impl RadianceOptions {
    /// More bounces are refused: what is left after so many is dark, or never ends.
    pub const MOST_BOUNCES: u32 = 64;
}

impl Default for RadianceOptions {
    /// 256 paths, no bounce.
    fn default() -> Self {
        Self { samples: 256, bounces: 0 }
    }
}

/// The true radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct RadianceTruth {
    /// What each pixel's surface sends to the eye, linear RGB; black where the pixel is not scored.
    pub radiance: Image<[f32; 3]>,
    /// Standard error of each pixel's luminance, from how the rounds of its samples differ.
    pub error: Image<f32>,
    /// True where the pixel shows a receiving surface.
    pub scored: Image<bool>,
    /// Paths that each pixel got.
    pub samples: u32,
    /// Rays that were traced.
    pub rays: u64,
}

impl RadianceTruth {
    /// Mean standard error of a pixel's luminance over the mean luminance, of the scored pixels; 0
    /// where all is black.
    pub fn relative_error(&self) -> f64 {
        let luminance = |p: &[f32; 3]| f64::from(p[0]) * 0.2126 + f64::from(p[1]) * 0.7152 + f64::from(p[2]) * 0.0722;
        // What is not scored is 0 in both.
        let light: f64 = self.radiance.data.iter().map(luminance).sum();
        let error: f64 = self.error.data.iter().copied().map(f64::from).sum();
        if light > 0.0 { error / light } else { 0.0 }
    }
}

/// Traces radiance through a scene under its environment.
///
/// L(p) = base colour / π · ∫ L_i(ω) max(n·ω, 0) dω, with L_i the environment where the ray meets
/// nothing, and else, while bounces are left, L of what it meets. Surfaces reflect on both sides,
/// and n, the shading normal, is turned to where the light goes: that of the vertices,
/// interpolated, or the triangle's own where they have none. The integral is drawn at once by
/// the cosine and by the brightness of the sky, weighed by the balance heuristic (Veach, Guibas,
/// "Optimally Combining Sampling Techniques for Monte Carlo Rendering", 1995), which has no bias.
///
/// ```
/// # use umbrage_core::{glam::Vec3, scenes, Environment, Sky};
/// # use umbrage_reference::{PathTracer, RadianceOptions, Tracer};
/// let mut scene = (scenes::find("contact").unwrap().build)(0.2); scene.environment =
/// Some(Environment::new(Sky::Constant(Vec3::ONE))); let tracer = Tracer::new(&scene); let geometry
/// = tracer.geometry(&scene.camera, 8, 6); let options = RadianceOptions { samples: 16, bounces: 1
/// }; let truth = PathTracer::new(&tracer, &scene)?.radiance((&geometry, &scene.camera), &options,
/// &|_, _| ())?; println!("{} %", 100.0 * truth.relative_error());
/// # Ok::<(), String>(())
/// ```
pub struct PathTracer<'a> {
    tracer: &'a Tracer,
    surfaces: Surfaces<'a>,
    light: Light<'a>,
}

/// Rounds that a pixel's samples are divided into: each is spread evenly, and is independent of the
/// others.
const ROUNDS: u32 = 16;

impl<'a> PathTracer<'a> {
    /// Of a scene and the tracer that was made of it.
    ///
    /// # Errors
    /// What is wrong, and the remedy: a scene without an environment, or with one that can't shine;
    /// a material that reflects more light than falls on it.
    pub fn new(tracer: &'a Tracer, scene: &'a Scene) -> Result<Self, String> {
        let environment = scene.environment.as_ref().ok_or_else(|| {
            format!(
                "the scene `{}` has no environment; add [environment] to it, such as `color = [1, 1, 1]`",
                scene.name
            )
        })?;
        Self::under(tracer, scene, environment)
    }

    /// The same under another environment than the scene's.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn under(tracer: &'a Tracer, scene: &'a Scene, environment: &'a Environment) -> Result<Self, String> {
        environment.check()?;
        Ok(Self { tracer, surfaces: Surfaces::new(tracer, scene)?, light: Light::new(environment) })
    }

    /// Traces what `geometry` shows to `camera`. All threads of the current rayon pool take part.
    /// `progress` is told, from any of them, how many of how many pixels are done.
    ///
    /// # Errors
    /// Too many bounces.
    pub fn radiance(
        &self,
        (geometry, camera): (&Geometry, &Camera),
        options: &RadianceOptions,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<RadianceTruth, String> {
        let most = RadianceOptions::MOST_BOUNCES;
        if options.bounces > most {
            return Err(format!("{} bounces are too many; take 0 to {most}", options.bounces));
        }
        let (width, height) = geometry.depth.size();
        let total = u64::from(width) * u64::from(height);
        let rounds = ROUNDS.min(options.samples).max(2);
        let per_round = options.samples.div_ceil(rounds).max(1);
        let (done, rays) = (AtomicU64::new(0), AtomicU64::new(0));
        let rows = (0..height).into_par_iter().flat_map_iter(|y| {
            let mut paths = Paths::new(self.tracer, &self.surfaces, &self.light, options, per_round);
            let row: Vec<Option<Pixel>> = (0..width)
                .map(|x| {
                    let surface = geometry.surface(x, y).filter(|_| geometry.receives[(x, y)])?;
                    let pixel = DVec2::new(x.into(), y.into()) + 0.5;
                    let to_eye = -camera.ray(pixel, width, height);
                    let point = self.surfaces.seen(surface, to_eye);
                    let seed = y.wrapping_mul(width).wrapping_add(x);
                    Some(Pixel::of((0..rounds).map(|round| paths.round(&point, seed, round))))
                })
                .collect();
            rays.fetch_add(paths.rays, Ordering::Relaxed);
            progress(done.fetch_add(width.into(), Ordering::Relaxed) + u64::from(width), total);
            row
        });
        let pixels = Image { width, height, data: rows.collect::<Vec<Option<Pixel>>>() };
        Ok(RadianceTruth {
            radiance: pixels.map(|p| p.map_or([0.0; 3], |p| p.radiance.as_vec3().to_array())),
            error: pixels.map(|p| p.map_or(0.0, |p| p.error as f32)),
            scored: pixels.map(Option::is_some),
            samples: rounds * per_round,
            rays: rays.into_inner(),
        })
    }
}

/// What is found for a pixel.
#[derive(Clone, Copy)]
struct Pixel {
    radiance: DVec3,
    /// Of the luminance.
    error: f64,
}

impl Pixel {
    /// Of the means of rounds, at least two.
    fn of(rounds: impl Iterator<Item = DVec3>) -> Self {
        let luminance = |c: DVec3| c.dot(DVec3::new(0.2126, 0.7152, 0.0722));
        let means: Vec<DVec3> = rounds.collect();
        let count = means.len().max(2) as f64;
        let radiance = means.iter().sum::<DVec3>() / count;
        let off = |m: &DVec3| (luminance(*m) - luminance(radiance)).powi(2);
        let variance = means.iter().map(off).sum::<f64>() / (count - 1.0);
        Self { radiance, error: (variance / count).sqrt() }
    }
}

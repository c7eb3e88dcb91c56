//! The share of a light that every pixel sees.

use crate::geometry::{Geometry, Surface};
use crate::light_view::{LightView, Tally};
use crate::tracer::Tracer;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use umbrage_core::{Image, Light, Texture};

/// How to trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Points of the light for every pixel. 1 (or 0) is the one ray to the light's centre: the
    /// perfect hard shadow, which lights without extent get anyway.
    pub samples: u32,
    /// Gathers the casters that can lie between a pixel and the light once, and tests samples
    /// against them alone. The result is the same to the last bit; without it every sample goes
    /// through the whole hierarchy.
    pub gather: bool,
    /// All pixels use the same points of the light: what differs between two points of a surface is
    /// then what is in the way alone. Without it noise takes the place of bands.
    pub same_points: bool,
}

impl Default for Options {
    /// 1024 samples, gathered, other ones for each pixel.
    fn default() -> Self {
        Self { samples: 1024, gather: true, same_points: false }
    }
}

/// The true visibility of one light.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Share of the light that each pixel sees, 0…1; 0 where the pixel is not scored.
    pub visibility: Image<f32>,
    /// True where the pixel shows a receiving surface whose normal faces the light's centre, by a
    /// cosine over 1e-6: surfaces whose plane goes through the centre have no light, and rounding
    /// must not choose some of their pixels.
    pub scored: Image<bool>,
    /// Samples that were tested against triangles; those that cannot meet any are not among them.
    pub rays: u64,
}

impl Tracer {
    /// Traces the visibility of `light` for what `geometry` shows; `textures` are the scene's. All
    /// threads of the current rayon pool take part. `progress` is told, from any of them, how many
    /// of how many pixels are done.
    pub fn visibility(
        &self,
        geometry: &Geometry,
        light: &Light,
        textures: &[Texture],
        options: &Options,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Truth {
        let view = LightView::new(light, textures, options);
        let (width, height) = geometry.depth.size();
        let total = u64::from(width) * u64::from(height);
        let (done, rays) = (AtomicU64::new(0), AtomicU64::new(0));
        let rows = (0..height).into_par_iter().flat_map_iter(|y| {
            let mut tally = Tally::default();
            let mut row = Vec::with_capacity(width as usize);
            for x in 0..width {
                let surface = geometry.surface(x, y).filter(|s| geometry.receives[(x, y)] && view.is_faced_by(s));
                let seed = if options.same_points { 0 } else { y.wrapping_mul(width).wrapping_add(x) };
                row.push(surface.map(|s| view.visibility(self, s, seed, &mut tally)));
            }
            rays.fetch_add(tally.rays, Ordering::Relaxed);
            progress(done.fetch_add(width.into(), Ordering::Relaxed) + u64::from(width), total);
            row
        });
        let row_by_row = Image { width, height, data: rows.collect::<Vec<Option<f64>>>() };
        Truth {
            visibility: row_by_row.map(|v| v.unwrap_or(0.0) as f32),
            scored: row_by_row.map(Option::is_some),
            rays: rays.into_inner(),
        }
    }

    /// The visibility of `light`, 0…1, for one point of a surface. `seed` chooses among the sets of
    /// samples, as a pixel's index does.
    pub fn visibility_at(
        &self,
        surface: &Surface,
        light: &Light,
        textures: &[Texture],
        options: &Options,
        seed: u32,
    ) -> f64 {
        LightView::new(light, textures, options).visibility(self, surface, seed, &mut Tally::default())
    }
}

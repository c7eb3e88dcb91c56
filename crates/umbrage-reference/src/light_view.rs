//! One light as the points of surfaces see it.

use crate::geometry::Surface;
use crate::shaft::Shaft;
use crate::tracer::{CLEARANCE, Tracer};
use crate::triangle::{Ray, SeenTriangle};
use crate::visibility::Options;
use glam::{DVec2, DVec3, DVec4};
use std::f64::consts::TAU;
use umbrage_core::sampling::{LightSampler, lattice, rotated, shift};
use umbrage_core::{Light, LightShape, Texture};

/// Up to this many gathered triangles are tested one by one; with more, the hierarchy is faster.
const MOST_GATHERED: usize = 48;

/// Least cosine between a scored surface's normal and the way to the light's centre. The centre is
/// in the plane of what has less, as far as rounding can tell, and no light falls on that.
pub(crate) const LEAST_COSINE: f64 = 1e-6;

/// A light, ready for any surface.
pub(crate) struct LightView {
    light: Light,
    sampler: LightSampler,
    /// Points of the unit square; none for the one ray to the centre.
    samples: Vec<DVec2>,
    /// Radius of a sphere around the centre that contains the light, or the sine of a sun's half
    /// angle.
    radius: f64,
    gather: bool,
}

/// Room to work in, and what the work was.
#[derive(Default)]
pub(crate) struct Tally {
    /// Samples that were tested against triangles.
    pub rays: u64,
    gathered: Vec<u32>,
    seen: Vec<(u32, SeenTriangle)>,
    /// True where the last visibility depends on no samples: others would give the same.
    pub is_exact: bool,
}

/// What can lie between a surface point and the light.
enum Between {
    Nothing,
    /// The triangles of [`Tally::seen`].
    Gathered,
    Anything,
}

impl LightView {
    pub fn new(light: &Light, textures: &[Texture], options: &Options) -> Self {
        let soft = light.shape.kind().is_soft() && light.shape.radius() > 0.0 && options.samples > 1;
        let radius = match light.shape {
            // Beyond a right angle the sine falls again.
            LightShape::Directional { angle_deg, .. } if angle_deg > 180.0 => f64::INFINITY,
            _ => light.shape.radius() * (1.0 + 1e-6),
        };
        Self {
            light: light.clone(),
            sampler: LightSampler::new(&light.shape, textures),
            samples: lattice(if soft { options.samples as usize } else { 0 }),
            radius,
            gather: options.gather,
        }
    }

    /// Changes how many points of the light every pixel gets, at least one; lights without extent
    /// keep their one ray.
    pub fn set_samples(&mut self, samples: u32) {
        if !self.samples.is_empty() {
            self.samples = lattice(samples.max(1) as usize);
        }
    }

    /// How many points of the light every pixel gets.
    pub fn samples(&self) -> u32 {
        self.samples.len().max(1) as u32
    }

    /// True where the surface's normal faces the light's centre, by more than [`LEAST_COSINE`].
    pub fn is_faced_by(&self, surface: &Surface) -> bool {
        let way = self.light.shape.to_center(surface.position);
        surface.normal.dot(way) > LEAST_COSINE * way.length()
    }

    /// The share of the light that the surface sees.
    pub fn visibility(&self, tracer: &Tracer, surface: &Surface, seed: u32, tally: &mut Tally) -> f64 {
        tally.is_exact = true;
        if !self.light.casts {
            return 1.0;
        }
        let rays = Rays::new(tracer, surface, &self.light.shape, self.radius);
        if self.samples.is_empty() {
            tally.rays += 1;
            let blocked = rays.is_blocked(self.light.shape.center(), &mut None);
            return if blocked { 0.0 } else { 1.0 };
        }
        let between = if self.gather { self.gather(&rays, tally) } else { Between::Anything };
        if matches!(between, Between::Nothing) && (!surface.casts || self.is_above(surface)) {
            return 1.0;
        }
        tally.is_exact = false;
        let from = self.sampler.at(surface.position).turned(shift(!seed).x * TAU);
        let samples = self.samples.iter().map(|&u| from.sample(rotated(u, shift(seed))));
        let blocked = match between {
            Between::Nothing => samples.filter(|&q| rays.is_below(q)).count(),
            Between::Gathered => samples.filter(|&q| rays.is_blocked_by(q, &mut tally.seen)).count(),
            Between::Anything => {
                let mut last = None;
                samples.filter(|&q| rays.is_blocked(q, &mut last)).count()
            }
        };
        if !matches!(between, Between::Nothing) {
            tally.rays += self.samples.len() as u64;
        }
        (self.samples.len() - blocked) as f64 / self.samples.len() as f64
    }

    /// True only where the whole light is above the tangent plane.
    fn is_above(&self, surface: &Surface) -> bool {
        let to_center = self.light.shape.to_center(surface.position);
        surface.normal.dot(to_center) > self.radius + 1e-9 * to_center.length()
    }

    /// Finds the casters that any ray from the surface to the light can meet.
    fn gather(&self, rays: &Rays<'_>, tally: &mut Tally) -> Between {
        let center = self.light.shape.center();
        let to_center = self.light.shape.to_center(rays.surface.position);
        let shaft = if center.w == 0.0 {
            Shaft::to_cone(rays.origin, to_center, self.radius, rays.tracer.scale)
        } else {
            let scale = rays.tracer.scale.max(to_center.length());
            Shaft::to_ball(rays.origin, rays.origin + to_center, self.radius, scale)
        };
        let Some(shaft) = shaft else { return Between::Anything };
        let casting = rays.tracer.casting();
        if casting.within(&shaft, MOST_GATHERED, &mut tally.gathered).is_none() {
            return Between::Anything;
        }
        tally.seen.clear();
        let others = tally.gathered.iter().filter(|&&i| Some(casting.triangle(i).id) != rays.surface.triangle);
        tally.seen.extend(others.map(|&i| (i, casting.triangle(i).seen_from(rays.origin))));
        if tally.seen.is_empty() { Between::Nothing } else { Between::Gathered }
    }
}

/// The rays from one surface point to one light.
struct Rays<'a> {
    tracer: &'a Tracer,
    surface: &'a Surface,
    /// The surface point relative to the scene's centre.
    origin: DVec3,
    t_max: f64,
}

impl<'a> Rays<'a> {
    fn new(tracer: &'a Tracer, surface: &'a Surface, shape: &LightShape, radius: f64) -> Self {
        let distance = shape.to_center(surface.position).length().max(radius);
        let is_far = shape.center().w == 0.0;
        let t_max = if is_far { f64::INFINITY } else { 1.0 - CLEARANCE * tracer.scale / distance };
        Self { tracer, surface, origin: surface.position - tracer.center, t_max }
    }

    fn direction(&self, q: DVec4) -> DVec3 {
        q.truncate() - self.surface.position * q.w
    }

    /// Where the ray to a light sample starts: clear of the surface, in its own direction, so that
    /// the shadow does not move.
    fn t_min(&self, direction: DVec3) -> f64 {
        CLEARANCE * self.tracer.scale / self.surface.normal.dot(direction).abs()
    }

    /// True where the surface itself is in the way to a light sample.
    fn is_below(&self, q: DVec4) -> bool {
        self.surface.casts && self.surface.normal.dot(self.direction(q)) < 0.0
    }

    /// Tests everything. `last` is a triangle to try first, since neighbouring samples are often
    /// blocked by the same.
    fn is_blocked(&self, q: DVec4, last: &mut Option<usize>) -> bool {
        if self.is_below(q) {
            return true;
        }
        let direction = self.direction(q);
        let ray = Ray { origin: self.origin, direction, t_min: self.t_min(direction), t_max: self.t_max };
        let (bvh, own, cutouts) = (self.tracer.casting(), self.surface.triangle, &self.tracer.cutouts);
        if last.is_some_and(|i| bvh.stops(i, &ray, own, cutouts)) {
            return true;
        }
        let blocker = bvh.blocker(&ray, own, cutouts);
        *last = blocker.or(*last);
        blocker.is_some()
    }

    /// Tests the gathered triangles; the one that blocks moves to the front, since it often blocks
    /// the next sample too.
    fn is_blocked_by(&self, q: DVec4, seen: &mut [(u32, SeenTriangle)]) -> bool {
        if self.is_below(q) {
            return true;
        }
        let direction = self.direction(q);
        let (t_min, bvh) = (self.t_min(direction), self.tracer.casting());
        let blocker = seen.iter().position(|(i, triangle)| {
            triangle.is_hit(direction, t_min, self.t_max)
                && crate::bvh::Opacity::stops(&self.tracer.cutouts, bvh.triangle(*i), triangle, direction)
        });
        if let Some(k) = blocker {
            seen.swap(0, k);
        }
        blocker.is_some()
    }
}

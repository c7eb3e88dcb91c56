//! The integral at one point.

use crate::albedo::albedo;
use crate::rays::Rays;
use crate::surface::{Point, Surface};
use umbrage_core::harmonics::{Order, evaluate, unshadowed};
use umbrage_core::sampling::shift;
use umbrage_reference::{Hit, Tracer};

/// What all points have in common.
pub(crate) struct Gather<'a> {
    pub surface: &'a Surface,
    pub tracer: &'a Tracer,
    pub rays: &'a Rays,
    pub order: Order,
}

impl Gather<'_> {
    /// T of a point that nothing shadows.
    pub fn unshadowed(&self, point: &Point, into: &mut [f32]) {
        let mut exact = [0.0; 100];
        unshadowed(self.order, point.normal, &mut exact);
        into.iter_mut().zip(exact).for_each(|(into, value)| *into = value as f32);
    }

    /// T⁰ of a point: what comes straight from the sky.
    ///
    /// The mean over rays is that of the functions where the sky is seen. Rays that see it and
    /// those that do not together estimate a known number, the transfer without shadows; what they
    /// are off is divided between both by their counts, so that a point that sees all of the sky is
    /// exact, and one that sees none is black.
    pub fn direct(&self, number: usize, point: &Point, into: &mut [f32]) {
        let n = self.order.functions();
        let (mut exact, mut basis, mut free, mut blocked) = ([0.0; 100], [0.0; 100], [0.0; 100], [0.0; 100]);
        let mut seen = 0.0;
        for (direction, u) in self.rays.around(point.normal, shift(number as u32)) {
            evaluate(self.order, direction, &mut basis);
            let is_blocked = self.tracer.blocked(self.surface.start(point, u), direction.extend(0.0));
            seen += if is_blocked { 0.0 } else { 1.0 };
            let sums = if is_blocked { &mut blocked } else { &mut free };
            sums[..n].iter_mut().zip(&basis).for_each(|(sum, y)| *sum += y);
        }
        unshadowed(self.order, point.normal, &mut exact);
        let (count, share) = (self.rays.count(), seen / self.rays.count());
        for (i, into) in into.iter_mut().enumerate().take(n) {
            let (free, blocked) = (free[i] / count, blocked[i] / count);
            *into = (free + share * (exact[i] - free - blocked)) as f32;
        }
    }

    /// T^b of a point for three colours from T^(b−1) of all points, `before`, which has `channels`
    /// colours.
    pub fn reflected(&self, seed: u32, point: &Point, before: &[f32], channels: usize, into: &mut [f32]) {
        let n = self.order.functions();
        let mut sums = [0.0_f64; 300];
        for (direction, u) in self.rays.around(point.normal, shift(seed)) {
            let hit = self.tracer.hit(self.surface.start(point, u), direction);
            let Some((hit, offset)) = hit.and_then(|hit| Some((hit, self.first_point(&hit)?))) else { continue };
            let instance = hit.instance as usize;
            let indices = &self.surface.scene.meshes[instance].indices;
            let corners = [0, 1, 2].map(|k| indices[3 * hit.triangle as usize + k]);
            let reflectance = albedo(&self.surface.scene, instance, corners, hit.barycentric).as_dvec3();
            for (channel, rho) in reflectance.to_array().into_iter().enumerate() {
                let sums = &mut sums[channel * n..(channel + 1) * n];
                for (corner, share) in corners.iter().zip(hit.barycentric) {
                    let start = ((offset + *corner as usize) * channels + channel.min(channels - 1)) * n;
                    let vector = before.get(start..start + n).unwrap_or_default();
                    sums.iter_mut().zip(vector).for_each(|(sum, t)| *sum += rho * share * f64::from(*t));
                }
            }
        }
        into.iter_mut().zip(sums).for_each(|(into, sum)| *into = (sum / self.rays.count()) as f32);
    }

    /// Number of the first point on the side of a mesh that is hit; `None` on the inside of a
    /// closed one, which is black.
    fn first_point(&self, hit: &Hit) -> Option<usize> {
        let instance = hit.instance as usize;
        let part = self.surface.parts.get(instance)?;
        let side = usize::from(hit.is_front == part.is_mirrored);
        let vertices = self.surface.scene.meshes[instance].positions.len();
        (side < part.sides.count()).then_some(part.first + side * vertices)
    }
}

//! A bake as work that can be stopped and continued.

use crate::gather::Gather;
use crate::rays::Rays;
use crate::surface::Surface;
use crate::{Error, Settings};
use rayon::prelude::*;
use std::ops::ControlFlow;
use umbrage_core::Scene;
use umbrage_core::transfer::{BakedMesh, Kind, Points, Stored, Transfer};
use umbrage_reference::Tracer;

/// Is told how many points are done, of how many; breaks to stop the bake.
pub type Watch<'a> = &'a (dyn Fn(u64, u64) -> ControlFlow<()> + Sync);

/// Rays that all cores trace together before anyone is told, a second's work at most.
const BATCH_RAYS: usize = 1 << 18;

/// How far a bake is. The same work from any state ends in the same transfer.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct State {
    /// Passes that are done: straight light, then one for each bounce.
    pub passes: u32,
    /// Points of the present pass that are done.
    pub points: usize,
    /// T^(b−1) of all points.
    pub before: Vec<f32>,
    /// T^b of those that are done, zeros for the others.
    pub present: Vec<f32>,
    /// The sum of T⁰ to T^(b−1).
    pub sum: Vec<f32>,
}

/// Bakes a scene as its animations stand.
///
/// # Errors
/// Settings or a scene that can't be baked, and [`Error::Stopped`] where `watch` breaks.
pub fn bake(scene: &Scene, settings: &Settings, watch: Watch<'_>) -> Result<Transfer, Error> {
    settings.check(scene)?;
    let work = Work::new(scene, settings);
    let mut state = State::default();
    work.run(&mut state, watch, &mut |_| Ok(()))?;
    Ok(work.finished(state))
}

/// A scene ready to be baked.
pub(crate) struct Work {
    settings: Settings,
    surface: Surface,
    tracer: Tracer,
    rays: Rays,
}

impl Work {
    pub fn new(scene: &Scene, settings: &Settings) -> Self {
        let surface = Surface::new(scene, settings);
        let tracer = Tracer::new(&surface.scene);
        Self { settings: *settings, surface, tracer, rays: Rays::new(settings.rays) }
    }

    fn passes(&self) -> u32 {
        match self.settings.kind {
            Kind::Interreflected { bounces } => 1 + bounces,
            _ => 1,
        }
    }

    /// Colours of the vectors of a pass.
    fn channels(pass: u32) -> usize {
        if pass == 0 { 1 } else { 3 }
    }

    /// True where a state can have come from this work.
    pub fn fits(&self, state: &State) -> bool {
        let (points, n) = (self.surface.point_count(), self.settings.order.functions());
        let len = |pass: Option<u32>| pass.map_or(0, |pass| points * n * Self::channels(pass));
        state.passes < self.passes()
            && state.points <= points
            && state.before.len() == len(state.passes.checked_sub(1))
            && state.sum.len() == len(state.passes.checked_sub(1))
            && state.present.len() == len(Some(state.passes))
    }

    /// Works from `state` to the end; `keep` is called between batches.
    pub fn run(
        &self,
        state: &mut State,
        watch: Watch<'_>,
        keep: &mut dyn FnMut(&State) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let points = self.surface.point_count();
        let rays = self.settings.rays as usize;
        let (most, least) = ((BATCH_RAYS / rays).clamp(32, 1024), (2048 / rays).clamp(1, 8));
        let all = points as u64 * u64::from(self.passes());
        while state.passes < self.passes() {
            let len = self.settings.order.functions() * Self::channels(state.passes);
            state.present.resize(points * len, 0.0);
            while state.points < points {
                let batch = state.points..(state.points + most).min(points);
                let (pass, before) = (state.passes, &state.before);
                let into = &mut state.present[batch.start * len..batch.end * len];
                into.par_chunks_mut(len).zip(batch.clone()).with_min_len(least).for_each(|(vector, number)| {
                    self.point(pass, number, before, vector);
                });
                state.points = batch.end;
                let done = state.points as u64 + points as u64 * u64::from(state.passes);
                if watch(done, all).is_break() {
                    return Err(Error::Stopped);
                }
                keep(state)?;
            }
            self.end_pass(state);
        }
        Ok(())
    }

    fn point(&self, pass: u32, number: usize, before: &[f32], into: &mut [f32]) {
        let Some(point) = self.surface.point(number) else { return };
        let (surface, tracer, rays, order) = (&self.surface, &self.tracer, &self.rays, self.settings.order);
        let gather = Gather { surface, tracer, rays, order };
        match (self.settings.kind, pass) {
            (Kind::Unshadowed, _) => gather.unshadowed(&point, into),
            (_, 0) => gather.direct(number, &point, into),
            _ => {
                // Other rays in every pass.
                let seed = (number as u32).wrapping_add(pass.wrapping_mul(0x9e37_79b9));
                gather.reflected(seed, &point, before, Self::channels(pass - 1), into);
            }
        }
    }

    fn end_pass(&self, state: &mut State) {
        let n = self.settings.order.functions();
        if state.passes == 1 {
            // From one colour to three.
            state.sum =
                state.sum.chunks_exact(n).flat_map(|vector| [vector; 3].into_iter().flatten().copied()).collect();
        }
        state.sum.resize(state.present.len(), 0.0);
        state.sum.iter_mut().zip(&state.present).for_each(|(sum, present)| *sum += present);
        state.before = std::mem::take(&mut state.present);
        state.passes += 1;
        state.points = 0;
    }

    /// The transfer of a state that was worked to its end.
    pub fn finished(self, state: State) -> Transfer {
        let Settings { order, kind, .. } = self.settings;
        let channels = kind.channels();
        let len = channels * order.functions();
        let sum = state.sum;
        let instances = self.surface.scene.meshes.into_iter().zip(self.surface.parts).enumerate();
        let meshes = instances.filter(|(_, (mesh, _))| !mesh.indices.is_empty()).map(|(instance, (mesh, part))| {
            let count = part.sides.count() * mesh.positions.len();
            let values = sum.get(part.first * len..(part.first + count) * len).unwrap_or_default();
            let stored = Stored::Full(values.to_vec());
            BakedMesh { instance, mesh, points: Points::Vertices, sides: part.sides, channels, stored }
        });
        Transfer { order, kind, meshes: meshes.collect() }
    }
}

//! One technique or baseline under measurement.

use crate::{
    bench::{
        baseline::{Baseline, Maps},
        record::{BenchCost, BenchResult},
    },
    choice::Choice,
    error::Error,
    measure::Frames,
    status::Status,
};
use std::collections::BTreeMap;
use umbrage::Gpu;
use umbrage_core::Camera;
use umbrage_renderer::Renderer;

/// One technique or baseline under measurement; the first error ends its part.
pub(crate) struct Runner<'a> {
    pub baseline: Option<Baseline>,
    pub choice: Option<&'a Choice>,
    pub renderer: Result<Renderer, Error>,
    pub overlay: bool,
    /// Nothing of earlier frames is used again.
    pub anew: bool,
    /// How many there are.
    pub lights: usize,
    pub frames: Frames,
}

impl Runner<'_> {
    pub(crate) fn frame(&mut self, gpu: &Gpu, camera: &Camera, counts: bool) {
        let Ok(renderer) = &mut self.renderer else { return };
        let mut unused = Frames::default();
        let frames = if counts { &mut self.frames } else { &mut unused };
        if self.anew {
            renderer.forget();
        }
        if let Err(error) = gpu.catch(|| frames.add(renderer, camera)) {
            self.renderer = Err(error.into());
        }
    }

    pub(crate) fn cost(&self) -> Option<BenchCost> {
        let renderer = self.renderer.as_ref().ok()?;
        let stats: Vec<_> = (0..self.lights).map(|pass| renderer.stats(pass)).collect();
        Some(BenchCost::new(&self.frames, &stats, added((0..self.lights).flat_map(|pass| renderer.counts(pass)))))
    }

    pub(crate) fn result(&self, cost: Option<BenchCost>, all: &[(Option<Baseline>, Option<BenchCost>)]) -> BenchResult {
        let own = self.choice.map_or(Maps::USUAL, Maps::of);
        let over = |baseline: Baseline| {
            let (_, other) = all.iter().find(|(b, _)| *b == Some(baseline))?;
            Some(cost.as_ref()?.added_ms()? / other.as_ref()?.added_ms()?)
        };
        let (technique, settings) = match (self.baseline, self.choice) {
            (_, Some(choice)) => {
                let overlay = self.overlay.then(|| ("overlay".to_string(), "on".to_string()));
                (choice.info.id.to_string(), choice.changed().clone().into_iter().chain(overlay).collect())
            }
            (Some(Baseline::BareMinimum(maps)), _) => ("bare-minimum".into(), maps.settings()),
            _ => ("floor".into(), BTreeMap::new()),
        };
        let (status, reason) = match &self.renderer {
            Ok(_) => (Status::Ok, None),
            Err(error) => {
                let (status, reason) = Status::of(error);
                (status, Some(reason))
            }
        };
        BenchResult {
            technique,
            settings,
            light_samples: self.choice.and_then(|c| c.light_samples),
            status,
            reason,
            vs_floor: over(Baseline::Floor),
            vs_bare_minimum: over(Baseline::BareMinimum(own)),
            cost,
            flicker: None,
            flicker_ratio: None,
        }
    }
}

/// Counts of several lights, added up by name.
fn added(counts: impl Iterator<Item = (&'static str, u64)>) -> Vec<(&'static str, u64)> {
    let mut sums: Vec<(&'static str, u64)> = Vec::new();
    for (name, count) in counts {
        match sums.iter_mut().find(|(other, _)| *other == name) {
            Some((_, sum)) => *sum += count,
            None => sums.push((name, count)),
        }
    }
    sums
}

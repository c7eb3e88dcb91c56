//! One technique or baseline under measurement.

use crate::{
    bench::{
        baseline::Baseline,
        record::{BenchCost, BenchResult, BenchTraffic},
    },
    choice::Choice,
    churn::Churn,
    error::Error,
    maps::Maps,
    measure::Frames,
    status::Status,
};
use std::collections::BTreeMap;
use umbrage::{Gpu, Owner, PassFragments, Recorder};
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
    /// What was counted, if it was.
    pub traffic: Option<Vec<BenchTraffic>>,
    /// Instances that come and go.
    pub churn: Option<Churn>,
}

impl Runner<'_> {
    /// Has instances come and go, before a frame.
    pub(crate) fn churn(&mut self) -> Result<(), Error> {
        if let (Ok(renderer), Some(churn)) = (&mut self.renderer, &mut self.churn) {
            self.frames.changed_ms = Some(churn.apply(renderer.casters_mut())?);
        }
        Ok(())
    }

    pub(crate) fn frame(&mut self, gpu: &Gpu, camera: &Camera, counts: bool) {
        let Ok(renderer) = &mut self.renderer else { return };
        let mut unused = Frames::default();
        unused.changed_ms = self.frames.changed_ms;
        let frames = if counts { &mut self.frames } else { &mut unused };
        if self.anew {
            renderer.forget();
        }
        if let Err(error) = gpu.catch(|| frames.add(renderer, camera)) {
            self.renderer = Err(error.into());
        }
    }

    /// Counts fragments in one more frame, which does all of the work.
    pub(crate) fn count(&mut self, gpu: &Gpu, camera: &Camera, counting: &mut Recorder) {
        let Ok(renderer) = &mut self.renderer else { return };
        renderer.forget();
        renderer.swap_recorder(counting);
        let drawn = gpu.catch(|| Ok(renderer.frame(camera).and_then(|()| renderer.wait())?));
        renderer.swap_recorder(counting);
        if let Err(error) = drawn {
            self.renderer = Err(error);
            return;
        }
        let counted = counting.fragments();
        // A frame with more passes than can be counted has no counts at all.
        if counted.is_empty() {
            return;
        }
        let mut traffic: Vec<BenchTraffic> = Vec::new();
        for PassFragments { owner, pass, fragments, attachment_bytes } in counted {
            let Owner::Light(_) = owner else { continue };
            // All lights have the same technique.
            let reads = renderer.technique(0).and_then(|technique| technique.inside().reads(&pass));
            // Who draws nothing reads nothing.
            let reads = reads.or((fragments == 0).then_some(0));
            let bytes = reads.map(|reads| attachment_bytes + reads * fragments);
            match traffic.iter_mut().find(|other| other.pass == pass) {
                Some(other) => {
                    other.fragments += fragments;
                    other.bytes = other.bytes.zip(bytes).map(|(one, other)| one + other);
                }
                None => traffic.push(BenchTraffic { pass, fragments, bytes }),
            }
        }
        self.traffic = Some(traffic);
    }

    pub(crate) fn cost(&self) -> Option<BenchCost> {
        let renderer = self.renderer.as_ref().ok()?;
        let stats: Vec<_> = (0..self.lights).map(|pass| renderer.stats(pass)).collect();
        let traffic = self.traffic.clone();
        Some(BenchCost::new(
            &self.frames,
            &stats,
            traffic,
            added((0..self.lights).flat_map(|pass| renderer.counts(pass))),
        ))
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
            change_error: None,
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

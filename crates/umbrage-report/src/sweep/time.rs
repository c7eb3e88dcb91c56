//! Times of many settings on one light: measured by `bench`, as many at once as fit into memory.

use crate::{
    bench::{Bench, BenchCost, BenchResult},
    choice::Choice,
    error::Error,
    motion::Moving,
    progress::Progress,
    record::Status,
    source::Source,
    spread::Spread,
    sweep::record::{Clock, Yardsticks},
};
use umbrage::Gpu;

/// GPU memory of the settings that take turns: little enough for any adapter. One that needs more is measured alone with the yardsticks.
const BATCH_BYTES: u64 = 1 << 30;

/// Targets of a renderer for each pixel, what it holds of a triangle, and its pipelines, roughly.
const PIXEL_BYTES: u64 = 48;
const TRIANGLE_BYTES: u64 = 256;
const PIPELINE_BYTES: u64 = 8 << 20;

/// Map size of the bare minimum that others are set against.
const USUAL_MAP: f64 = 1024.0;

/// One light at one size.
pub(crate) struct Timing<'a> {
    pub gpu: &'a Gpu,
    pub source: &'a Source,
    pub light: usize,
    pub size: (u32, u32),
    pub frames: u32,
}

/// What a setting took.
#[derive(Clone, Debug)]
pub(crate) struct Timed {
    pub status: Status,
    pub reason: Option<String>,
    pub cost: Option<BenchCost>,
    pub over_floor_ms: Option<f64>,
}

impl Timing<'_> {
    /// Times `choices`, each with the memory that it holds, in their order. What fails is in its place.
    ///
    /// # Errors
    /// As [`Bench::run`].
    pub(crate) fn run(
        &self,
        choices: &[(Choice, u64)],
        progress: &dyn Progress,
    ) -> Result<(Vec<Timed>, Yardsticks), Error> {
        let (width, height) = self.size;
        let pixels = u64::from(width) * u64::from(height);
        let own = PIPELINE_BYTES + PIXEL_BYTES * pixels + TRIANGLE_BYTES * self.source.scene.triangle_count() as u64;
        let bytes: Vec<u64> = choices.iter().map(|(_, bytes)| bytes + own).collect();
        let mut baselines = Vec::new();
        let mut timed: Vec<(usize, Timed)> = Vec::new();
        for batch in batches(&bytes, BATCH_BYTES) {
            let asked = batch.iter().map(|&number| choices[number].0.clone()).collect();
            let mut results = self.batch(asked, progress)?;
            let techniques = results.split_off(results.len() - batch.len());
            let clock = clock(&results);
            let floor = results.first().and_then(|floor| cost_ms(floor, clock));
            timed.extend(batch.into_iter().zip(techniques.into_iter().map(|result| {
                let over_floor_ms = cost_ms(&result, clock).zip(floor).map(|(cost, floor)| cost - floor);
                let BenchResult { status, reason, cost, .. } = result;
                Timed { status, reason, cost, over_floor_ms }
            })));
            baselines.push(results);
        }
        timed.sort_by_key(|(number, _)| *number);
        Ok((timed.into_iter().map(|(_, timed)| timed).collect(), yardsticks(&baselines)))
    }

    /// The floor, the bare minimums, and `choices`.
    fn batch(&self, choices: Vec<Choice>, progress: &dyn Progress) -> Result<Vec<BenchResult>, Error> {
        let bench = Bench {
            scenes: vec![(self.source.clone(), vec![self.light])],
            choices,
            size: self.size,
            frames: self.frames,
            moving: Moving::None,
            path: None,
            samples: 1,
            together: false,
            overlay: false,
            command: Vec::new(),
        };
        let report = bench.run(self.gpu, progress)?;
        Ok(report.scenes.into_iter().flat_map(|s| s.lights).flat_map(|l| l.results).collect())
    }
}

/// Numbers of the settings that go together. Small ones come first: most of all techniques then take turns with each other, and what is
/// apart is what is larger.
fn batches(bytes: &[u64], limit: u64) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..bytes.len()).collect();
    order.sort_by_key(|&number| bytes[number]);
    let mut batches: Vec<Vec<usize>> = Vec::new();
    let mut held = 0u64;
    for number in order {
        let more = held.saturating_add(bytes[number]);
        match batches.last_mut() {
            Some(batch) if more <= limit => {
                batch.push(number);
                held = more;
            }
            _ => {
                batches.push(vec![number]);
                held = bytes[number];
            }
        }
    }
    batches
}

/// The floor knows whether the adapter keeps time.
fn clock(baselines: &[BenchResult]) -> Clock {
    let timed = baselines.first().and_then(|floor| floor.cost.as_ref()?.added_ms());
    if timed.is_some() { Clock::Gpu } else { Clock::Frame }
}

fn cost_ms(result: &BenchResult, clock: Clock) -> Option<f64> {
    let cost = result.cost.as_ref()?;
    match clock {
        Clock::Gpu => cost.added_ms(),
        Clock::Frame => Some(cost.frame_ms.median),
    }
}

/// From the baselines of each batch: the floor first, then bare minimums.
fn yardsticks(batches: &[Vec<BenchResult>]) -> Yardsticks {
    let Some(clock) = batches.first().map(|batch| clock(batch)) else { return Yardsticks::default() };
    let spread = |values: Vec<f64>| (!values.is_empty()).then(|| Spread::of(values));
    let mut floors = Vec::new();
    let mut bares: Vec<(u32, f64)> = Vec::new();
    for batch in batches {
        let mut costs = batch.iter().filter_map(|result| Some((result, cost_ms(result, clock)?)));
        let Some((_, floor)) = costs.next() else { continue };
        floors.push(floor);
        // Those of one map: the others are for techniques with splits.
        let costs = costs.filter(|(result, _)| !result.settings.contains_key("splits"));
        bares.extend(costs.filter_map(|(result, ms)| Some((result.settings.get("size")?.parse().ok()?, ms - floor))));
    }
    let distance = |size: u32| (f64::from(size) / USUAL_MAP).ln().abs();
    let size = bares.iter().map(|(size, _)| *size).min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
    let of_size = bares.iter().filter(|(s, _)| Some(*s) == size).map(|(_, ms)| *ms).collect();
    Yardsticks {
        clock,
        floor_ms: spread(floors),
        bare_minimum_size: size,
        bare_minimum_over_floor_ms: spread(of_size).filter(|ms| ms.median > 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::record::cost;
    use std::collections::BTreeMap;

    #[test]
    fn batches_hold_no_more_than_the_limit_unless_alone() {
        assert_eq!(batches(&[3, 3, 4, 1, 20, 5, 5], 10), [vec![3, 0, 1], vec![2, 5], vec![6], vec![4]]);
        assert!(batches(&[], 10).is_empty());
    }

    /// A baseline that takes `gpu_ms` and half a millisecond to prepare, in a frame of 20.
    fn baseline(size: Option<u32>, gpu_ms: Option<f64>) -> BenchResult {
        let frame_ms = 20.0 + f64::from(size.unwrap_or_default()) / 1000.0;
        BenchResult {
            technique: "baseline".into(),
            settings: size.map(|s| ("size".to_string(), s.to_string())).into_iter().collect::<BTreeMap<_, _>>(),
            light_samples: None,
            status: Status::Ok,
            reason: None,
            cost: Some(cost(gpu_ms, 0.5, frame_ms)),
            vs_floor: None,
            vs_bare_minimum: None,
            flicker: None,
            flicker_ratio: None,
        }
    }

    #[test]
    fn yardsticks_are_medians_and_the_usual_map_counts() {
        let batch = |floor, bare| {
            vec![
                baseline(None, Some(floor)),
                baseline(Some(512), Some(9.0)),
                baseline(Some(1024), Some(bare)),
                baseline(Some(4096), Some(99.0)),
            ]
        };
        let found = yardsticks(&[batch(1.0, 4.0), batch(3.0, 6.0), batch(1.5, 9.0)]);
        let wanted = Yardsticks {
            clock: Clock::Gpu,
            floor_ms: Some(Spread { median: 2.0, min: 1.5, max: 3.5 }),
            bare_minimum_size: Some(1024),
            bare_minimum_over_floor_ms: Some(Spread { median: 3.0, min: 3.0, max: 7.5 }),
        };
        assert_eq!(found, wanted);
        assert_eq!(yardsticks(&[]), Yardsticks::default());
    }

    #[test]
    fn frames_stand_in_where_the_adapter_keeps_no_time() {
        let found = yardsticks(&[vec![baseline(None, None), baseline(Some(500), None), baseline(Some(2000), None)]]);
        assert_eq!((found.clock, found.bare_minimum_size), (Clock::Frame, Some(2000)));
        assert_eq!(found.floor_ms, Some(Spread::of([20.0])));
        assert!((found.bare_minimum_over_floor_ms.unwrap().median - 2.0).abs() < 1e-9);
    }

    #[test]
    fn a_bare_minimum_below_the_floor_is_none() {
        let found = yardsticks(&[vec![baseline(None, Some(2.0)), baseline(Some(1024), Some(1.9))]]);
        assert_eq!((found.bare_minimum_size, found.bare_minimum_over_floor_ms), (Some(1024), None));
    }
}

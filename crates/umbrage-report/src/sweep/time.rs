//! Times of many settings on one light: as many as fit into memory take turns frame by frame, so
//! that a drift of the machine hits all of them alike.

use crate::{
    bench::record::BenchCost,
    cell::TIME_LIMIT,
    choice::Choice,
    error::Error,
    maps::Maps,
    measure::Frames,
    spread::Spread,
    stage::{Actor, Stage},
    sweep::record::{Clock, Yardsticks},
};
use umbrage::{Stats, baseline};
use umbrage_core::Camera;

/// GPU memory of the settings that wait for their turns: little enough for any adapter. The one
/// that goes beyond it is the last of its batch.
const BATCH_BYTES: u64 = 1 << 29;

/// The pipelines of a setting, roughly.
const PIPELINE_BYTES: u64 = 8 << 20;

/// Map size of the bare minimum that others are set against.
const USUAL_MAP: f64 = 1024.0;

/// The size of the bare minimum's map: of those of the choices the one nearest to the usual.
pub(crate) fn bare_size<'a>(choices: impl Iterator<Item = &'a Choice>) -> u32 {
    let distance = |size: u32| (f64::from(size) / USUAL_MAP).ln().abs();
    let sizes = choices.map(|choice| Maps::of(choice).size);
    sizes.min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(Maps::USUAL.size)
}

/// What a setting took.
#[derive(Debug)]
pub(crate) struct Timed {
    pub frames: u32,
    pub cost: Result<BenchCost, Error>,
    pub over_floor_ms: Option<f64>,
}

/// One light whose settings are timed.
pub(crate) struct Timing<'a> {
    camera: &'a Camera,
    light: usize,
    /// What yardsticks are measured under.
    yardstick_light: usize,
    frames: u32,
    bare_size: u32,
    /// Those that take turns next, by their numbers, and the memory that they hold.
    waiting: Vec<(usize, Runner)>,
    held: u64,
    batches: Vec<Batch>,
    timed: Vec<(usize, Timed)>,
}

/// Costs of the yardsticks in one batch, milliseconds.
#[derive(Clone, Copy, Debug)]
struct Batch {
    clock: Clock,
    floor_ms: Option<f64>,
    bare_ms: Option<f64>,
}

impl<'a> Timing<'a> {
    /// For up to `frames` of each setting, with a bare minimum of this size.
    /// The second light is that of the yardsticks.
    pub(crate) fn new(
        camera: &'a Camera,
        (light, yardstick_light): (usize, usize),
        frames: u32,
        bare_size: u32,
    ) -> Self {
        let (waiting, batches, timed) = (Vec::new(), Vec::new(), Vec::new());
        Self { camera, light, yardstick_light, frames, bare_size, waiting, held: 0, batches, timed }
    }

    /// A setting that has drawn already and holds so many bytes. Those that are too many to wait
    /// take their turns.
    ///
    /// # Errors
    /// Yardsticks that can't be made here.
    pub(crate) fn add(&mut self, stage: &mut Stage<'_>, number: usize, actor: Actor, bytes: u64) -> Result<(), Error> {
        self.waiting.push((number, Runner::new(actor)));
        self.held += bytes + PIPELINE_BYTES;
        if self.held >= BATCH_BYTES { self.take_turns(stage) } else { Ok(()) }
    }

    /// What each setting took, by its number, and what they are set against.
    ///
    /// # Errors
    /// As [`Timing::add`].
    pub(crate) fn finish(mut self, stage: &mut Stage<'_>) -> Result<(Vec<(usize, Timed)>, Yardsticks), Error> {
        if !self.waiting.is_empty() {
            self.take_turns(stage)?;
        }
        Ok((self.timed, yardsticks(&self.batches, self.bare_size)))
    }

    fn take_turns(&mut self, stage: &mut Stage<'_>) -> Result<(), Error> {
        let gpu = stage.gpu();
        let mut floor = Runner::new(Actor::new(gpu, baseline::floor(gpu)));
        let mut bare = Runner::new(Actor::new(gpu, baseline::bare_minimum(gpu, self.bare_size, 1)?));
        let light = self.yardstick_light;
        floor.warm_up(stage, light, self.camera);
        bare.warm_up(stage, light, self.camera);
        for _ in 0..self.frames {
            for yardstick in [&mut floor, &mut bare] {
                yardstick.turn(stage, light, self.camera);
            }
            for (_, runner) in &mut self.waiting {
                runner.turn(stage, self.light, self.camera);
            }
        }
        let (floor, bare) = (floor.cost(), bare.cost());
        let timed = floor.as_ref().is_some_and(|cost| cost.added_ms().is_some());
        let clock = if timed { Clock::Gpu } else { Clock::Frame };
        let floor_ms = floor.and_then(|cost| cost_ms(&cost, clock));
        self.batches.push(Batch { clock, floor_ms, bare_ms: bare.and_then(|cost| cost_ms(&cost, clock)) });
        let timed = self.waiting.drain(..).map(|(number, runner)| (number, runner.timed(clock, floor_ms)));
        self.timed.extend(timed);
        self.held = 0;
        Ok(())
    }
}

/// A technique that takes turns; the first error ends its part.
struct Runner {
    actor: Result<Actor, Error>,
    frames: Frames,
    stats: Stats,
    counts: Vec<(&'static str, u64)>,
}

impl Runner {
    fn new(actor: Actor) -> Self {
        Self { actor: Ok(actor), frames: Frames::default(), stats: Stats::default(), counts: Vec::new() }
    }

    /// A frame that does all of the work, unless its frames have taken the time that a setting may
    /// take.
    fn turn(&mut self, stage: &mut Stage<'_>, light: usize, camera: &Camera) {
        if self.frames.spent() >= TIME_LIMIT {
            return;
        }
        let away = || Err(Error::Name("its turn has not ended".into()));
        let Ok(actor) = std::mem::replace(&mut self.actor, away()) else { return };
        let frames = &mut self.frames;
        let acted = stage.act(light, actor, |renderer| {
            renderer.forget();
            frames.add(renderer, camera)?;
            Ok((renderer.stats(0), renderer.counts(0)))
        });
        self.actor = acted.map(|(actor, drawn)| {
            (self.stats, self.counts) = drawn;
            actor
        });
    }

    /// Frames that do not count.
    fn warm_up(&mut self, stage: &mut Stage<'_>, light: usize, camera: &Camera) {
        self.turn(stage, light, camera);
        self.turn(stage, light, camera);
        self.frames = Frames::default();
    }

    fn cost(&self) -> Option<BenchCost> {
        self.actor.as_ref().ok().map(|_| BenchCost::new(&self.frames, &[self.stats], None, self.counts.clone()))
    }

    fn timed(self, clock: Clock, floor_ms: Option<f64>) -> Timed {
        let Self { actor, frames, stats, counts } = self;
        let cost = actor.map(|_| BenchCost::new(&frames, &[stats], None, counts));
        let own_ms = cost.as_ref().ok().and_then(|cost| cost_ms(cost, clock));
        Timed { frames: frames.count(), over_floor_ms: own_ms.zip(floor_ms).map(|(own, floor)| own - floor), cost }
    }
}

fn cost_ms(cost: &BenchCost, clock: Clock) -> Option<f64> {
    match clock {
        Clock::Gpu => cost.added_ms(),
        Clock::Frame => Some(cost.frame_ms.median),
    }
}

/// Spreads over the batches.
fn yardsticks(batches: &[Batch], bare_size: u32) -> Yardsticks {
    let Some(Batch { clock, .. }) = batches.first().copied() else { return Yardsticks::default() };
    let spread = |values: Vec<f64>| (!values.is_empty()).then(|| Spread::of(values));
    let bares: Vec<f64> = batches.iter().filter_map(|batch| Some(batch.bare_ms? - batch.floor_ms?)).collect();
    Yardsticks {
        clock,
        floor_ms: spread(batches.iter().filter_map(|batch| batch.floor_ms).collect()),
        bare_minimum_size: (!bares.is_empty()).then_some(bare_size),
        bare_minimum_over_floor_ms: spread(bares).filter(|ms| ms.median > 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::fixture::cost;

    fn batch(clock: Clock, floor_ms: f64, bare_ms: f64) -> Batch {
        Batch { clock, floor_ms: Some(floor_ms), bare_ms: Some(bare_ms) }
    }

    #[test]
    fn yardsticks_are_medians_over_the_batches() {
        let found =
            yardsticks(&[batch(Clock::Gpu, 1.5, 4.5), batch(Clock::Gpu, 3.5, 6.5), batch(Clock::Gpu, 2.0, 9.5)], 1024);
        let wanted = Yardsticks {
            clock: Clock::Gpu,
            floor_ms: Some(Spread { median: 2.0, min: 1.5, max: 3.5 }),
            bare_minimum_size: Some(1024),
            bare_minimum_over_floor_ms: Some(Spread { median: 3.0, min: 3.0, max: 7.5 }),
        };
        assert_eq!(found, wanted);
        assert_eq!(yardsticks(&[], 1024), Yardsticks::default());
    }

    #[test]
    fn frames_stand_in_where_the_adapter_keeps_no_time() {
        let (timed, untimed) = (cost(Some(3.0), 0.5, 20.0), cost(None, 0.5, 20.0));
        assert_eq!((cost_ms(&timed, Clock::Gpu), cost_ms(&timed, Clock::Frame)), (Some(3.5), Some(20.0)));
        assert_eq!((cost_ms(&untimed, Clock::Gpu), cost_ms(&untimed, Clock::Frame)), (None, Some(20.0)));
    }

    #[test]
    fn a_bare_minimum_below_the_floor_is_none() {
        let found = yardsticks(&[batch(Clock::Gpu, 2.0, 1.9)], 1024);
        assert_eq!((found.bare_minimum_size, found.bare_minimum_over_floor_ms), (Some(1024), None));
    }

    #[test]
    fn the_bare_minimum_has_the_usual_size_or_the_nearest() {
        let size = |labels: &[&str]| {
            let choices: Vec<_> =
                labels.iter().map(|label| Choice::parse(&umbrage::Registry::default(), label, &[]).unwrap()).collect();
            bare_size(choices.iter())
        };
        assert_eq!(size(&["shadow-map:size=500", "pcf:size=2000", "pcf:size=64"]), 2000);
        assert_eq!(size(&["shadow-map:size=64", "none"]), 1024);
        assert_eq!(size(&[]), 1024);
    }
}

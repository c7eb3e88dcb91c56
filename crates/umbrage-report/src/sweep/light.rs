//! A light under all settings. Each is made once: it is scored, then takes turns with others until
//! its time is known.

use crate::{
    bounced::bounces,
    cell::{Cell, Found, Scored},
    choice::Choice,
    error::Error,
    pictures::Pictures,
    progress::Progress,
    record::CostRecord,
    source::Source,
    stage::{Actor, Stage},
    status::Status,
    sweep::{
        answers::answers,
        curve::Curve,
        measures::{errors, radiance_errors},
        plan::Plan,
        record::{Skipped, SweepCurve, SweepLight, SweepResult},
        time::{Timed, Timing, bare_size},
    },
    truth::{Tracing, Truth},
};
use std::collections::BTreeMap;
use umbrage::Gpu;
use umbrage_renderer::Renderer;

pub(crate) struct LightRun<'a> {
    pub gpu: &'a Gpu,
    pub source: &'a Source,
    pub light: usize,
    pub frames: u32,
    pub tracing: &'a Tracing,
    /// With as many bounces as settings have.
    pub truths: &'a [(u32, Truth)],
    pub progress: &'a dyn Progress,
}

impl LightRun<'_> {
    /// Scores and times the settings; `place` starts the names of the reference's pictures.
    pub(crate) fn run(
        &self,
        plan: &Plan,
        stage: &mut Stage<'_>,
        place: &str,
        pictures: &mut Pictures,
    ) -> Result<SweepLight, Error> {
        let Self { gpu, source, light, tracing, .. } = *self;
        let kind = source.light(light)?.shape.kind();
        let cell = |truth| Cell { gpu, source, light, truth, tracing, still: 0 };
        let truth = |bounces| {
            let of = self.truths.iter().find(|(of, _)| *of == bounces).or(self.truths.first());
            of.map(|(_, truth)| truth).ok_or_else(|| Error::Name("there is no truth to compare with".into()))
        };
        let first = plan.settings.first().map_or(0, |setting| bounces(&setting.choice));
        let reference = cell(truth(first)?).reference(place, pictures)?;
        let size = bare_size(plan.settings.iter().map(|setting| &setting.choice));
        let lights = (light, source.yardstick_light(light));
        let mut timing = Timing::new(&source.scene.camera, lights, self.frames, size);
        let mut results: Vec<(String, SweepResult)> = Vec::new();
        let what = format!("{}, light {light} ({}): settings", source.scene.name, kind.name());
        self.progress.begin(&what, plan.settings.len() as u64);
        for (done, setting) in (1u64..).zip(&plan.settings) {
            let cell = cell(truth(bounces(&setting.choice))?);
            let made = cell.actor(stage, &setting.choice);
            let refused = made.as_ref().is_err_and(|error| Status::of(error).0 == Status::Failed);
            if !(refused && setting.by_rule) {
                let mut result = SweepResult::of(&setting.choice);
                match made.and_then(|actor| self.scored(&cell, stage, actor)) {
                    Ok((actor, (found, cost))) => {
                        result.set_errors(found);
                        timing.add(stage, results.len(), actor, cost.bytes)?;
                    }
                    Err(error) => result.fail(&error),
                }
                results.push((setting.choice.label(), result));
            }
            self.progress.at(done);
        }
        let (timed, yardsticks) = timing.finish(stage)?;
        self.progress.end();
        for (number, timed) in timed {
            results[number].1.set_time(timed);
        }
        let Parts { results, numbers, skipped } = Parts::of(results);
        let bare_ms = yardsticks.bare_minimum_over_floor_ms.map(|spread| spread.median);
        let curves = plan.curves.iter().map(|curve| numbered(curve, &numbers)).collect();
        let answers = answers(&results, bare_ms);
        let (kind, soft) = (kind.name(), kind.is_soft());
        Ok(SweepLight { light, kind, soft, reference, yardsticks, results, curves, skipped, answers })
    }

    /// A frame to warm up, and one that counts.
    fn scored(
        &self,
        cell: &Cell<'_>,
        stage: &mut Stage<'_>,
        actor: Actor,
    ) -> Result<(Actor, (Found, CostRecord)), Error> {
        let scored = |renderer: &mut Renderer| cell.scored(renderer, 1).map(|Scored { found, cost }| (found, cost));
        stage.act(self.light, actor, scored)
    }
}

impl SweepResult {
    /// A choice's, with nothing found yet.
    fn of(choice: &Choice) -> Self {
        Self {
            technique: choice.info.id.into(),
            title: choice.info.title.into(),
            settings: choice.changed().clone(),
            light_samples: choice.light_samples,
            status: Status::Ok,
            reason: None,
            scores: None,
            radiance: None,
            errors: BTreeMap::new(),
            frames: 0,
            cost: None,
            over_floor_ms: None,
        }
    }

    /// What failed has a reason and nothing else.
    fn fail(&mut self, error: &Error) {
        let (status, reason) = Status::of(error);
        (self.status, self.reason, self.scores, self.radiance) = (status, Some(reason), None, None);
        self.errors.clear();
    }

    fn set_errors(&mut self, found: Found) {
        match found {
            Found::Visibility { scores, .. } => {
                self.errors = errors(&scores);
                self.scores = Some(scores);
            }
            Found::Radiance { scores, .. } => {
                self.errors = radiance_errors(&scores);
                self.radiance = Some(scores);
            }
        }
    }

    fn set_time(&mut self, timed: Timed) {
        match timed.cost {
            Ok(cost) => {
                (self.frames, self.cost, self.over_floor_ms) = (timed.frames, Some(cost), timed.over_floor_ms);
            }
            Err(error) => self.fail(&error),
        }
    }
}

/// The results of a light.
#[derive(Debug, Default)]
struct Parts {
    results: Vec<SweepResult>,
    /// By the label of the setting.
    numbers: BTreeMap<String, usize>,
    skipped: Vec<Skipped>,
}

impl Parts {
    /// Sets aside what can't be done.
    fn of(all: Vec<(String, SweepResult)>) -> Self {
        let mut parts = Self::default();
        for (label, result) in all {
            if result.status == Status::Unsupported {
                let skipped = Skipped { technique: result.technique, reason: result.reason.unwrap_or_default() };
                if !parts.skipped.contains(&skipped) {
                    parts.skipped.push(skipped);
                }
                continue;
            }
            parts.numbers.insert(label, parts.results.len());
            parts.results.push(result);
        }
        let Self { results, skipped, .. } = &mut parts;
        skipped.retain(|s| !results.iter().any(|r| r.technique == s.technique));
        parts
    }
}

fn numbered(curve: &Curve, numbers: &BTreeMap<String, usize>) -> SweepCurve {
    let found = || curve.labels.iter().map(|label| numbers.get(label).copied());
    SweepCurve {
        technique: curve.technique.into(),
        parameter: curve.parameter.clone(),
        values: curve.values.iter().zip(found()).filter_map(|(value, number)| number.map(|_| *value)).collect(),
        results: found().flatten().collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        fixture::fixture,
        sweep::{fixture::cost, record::SweepResult},
    };

    fn failed(text: &str) -> Error {
        Error::Name(text.into())
    }

    fn result(label: &str, outcome: Result<f64, Error>) -> (String, SweepResult) {
        let mut result = SweepResult::of(&Choice::parse(&umbrage::Registry::default(), label, &[]).unwrap());
        let scores = fixture().scenes.remove(0).lights.remove(0).results.remove(0).scores.unwrap();
        (result.errors, result.scores) = (errors(&scores), Some(scores));
        let over_floor_ms = outcome.as_ref().ok().map(|ms| ms - 1.0);
        let cost = outcome.map(|ms| cost(Some(ms), 0.0, ms));
        result.set_time(Timed { frames: 3, cost, over_floor_ms });
        (label.into(), result)
    }

    fn unsupported() -> Error {
        umbrage::Error::Unsupported { technique: "pcf".into(), what: "line lights".into() }.into()
    }

    /// One that is good, one that is not for this light, one that failed; then the first again.
    fn parts(last: Result<f64, Error>) -> Parts {
        Parts::of(vec![
            result("shadow-map:size=512", Ok(3.0)),
            result("pcf", Err(unsupported())),
            result("volume", Err(failed("no room"))),
            result("shadow-map:size=64", last),
        ])
    }

    #[test]
    fn the_impossible_is_set_aside_and_curves_find_their_results() {
        let parts = parts(Ok(5.0));
        let over: Vec<_> = parts.results.iter().map(|r| (r.technique.as_str(), r.over_floor_ms)).collect();
        assert_eq!(over, [("shadow-map", Some(2.0)), ("volume", None), ("shadow-map", Some(4.0))]);
        let skipped = Skipped { technique: "pcf".into(), reason: "not for line lights".into() };
        assert_eq!(parts.skipped, [skipped]);
        assert_eq!(parts.numbers["shadow-map:size=64"], 2);
        let labels = ["shadow-map:size=64", "pcf", "shadow-map:size=512"].map(String::from).to_vec();
        let values = vec![64.0, 100.0, 512.0];
        let curve = Curve { technique: "shadow-map", parameter: "size".into(), labels, values };
        let SweepCurve { values, results, .. } = numbered(&curve, &parts.numbers);
        assert_eq!((values, results), (vec![64.0, 512.0], vec![2, 0]));
    }

    #[test]
    fn answers_are_given_for_measures_that_the_light_has() {
        let answers = answers(&parts(Ok(5.0)).results, Some(1.0));
        // The fixture has no pixel far from edges.
        assert_eq!(answers.iter().map(|a| a.measure).collect::<Vec<_>>(), ["mae", "vs_hard", "p99"]);
        assert_eq!(answers[0].front, [0]);
        let techniques: Vec<_> = answers[0].budgets[1].best.iter().map(|b| (&*b.technique, b.result)).collect();
        assert_eq!(techniques, [("shadow-map", Some(0)), ("volume", None)]);
    }

    #[test]
    fn what_fails_while_it_is_timed_has_no_scores() {
        let last = parts(Err(failed("lost"))).results.remove(2);
        assert_eq!((last.status, last.reason.as_deref(), last.scores.is_none()), (Status::Failed, Some("lost"), true));
    }
}

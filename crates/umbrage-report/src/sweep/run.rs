//! A sweep under way: each light is compared once under all settings, then what came out well is timed.

use crate::{
    choice::Choice,
    compare::{Compare, Outcome, check_choices},
    error::Error,
    pictures::Pictures,
    progress::Progress,
    record::{LightRecord, ReferenceRecord, ResultRecord, Status},
    source::Source,
    sweep::{
        Sweep,
        answer::{Answer, Point, answer},
        measures::{MEASURES, errors},
        plan::{Curve, Plan},
        record::{Skipped, SweepCurve, SweepLight, SweepResult, SweepScene},
        time::{Timed, Timing},
    },
};
use std::{collections::BTreeMap, slice::from_ref};
use umbrage::Gpu;

pub(crate) struct Run<'a> {
    pub sweep: &'a Sweep,
    pub gpu: &'a Gpu,
    pub progress: &'a dyn Progress,
    pub pictures: Pictures,
}

impl Run<'_> {
    /// All lights of a scene; `number` tells its pictures from those of others.
    pub(crate) fn scene(&mut self, number: usize, source: &Source, lights: &[usize]) -> Result<SweepScene, Error> {
        let scene = &source.scene;
        let mut record = SweepScene {
            name: scene.name.clone(),
            source: source.asked.clone(),
            width: self.sweep.size.0,
            height: self.sweep.size.1,
            triangles: scene.triangle_count(),
            instances: scene.instances.len(),
            notes: source.notes.clone(),
            lights: Vec::new(),
        };
        for &light in lights {
            let refused = |choice: &Choice| check_choices(from_ref(choice), self.gpu).is_err();
            let soft = source.light(light)?.shape.kind().is_soft();
            let plan = Plan::new(&self.sweep.choices, &self.sweep.vary, soft, &refused)?;
            let Outcome { report, pictures } =
                self.compare(source, light, plan.choices.clone()).run(self.gpu, self.progress)?;
            for compared in report.scenes {
                (record.width, record.height) = (compared.width, compared.height);
                for mut scored in compared.lights {
                    self.keep_reference(number, &mut scored.reference, &pictures);
                    record.lights.push(self.light(source, (record.width, record.height), &plan, scored)?);
                }
            }
        }
        Ok(record)
    }

    /// The comparison that scores `choices`. Its times are not used, so one frame does.
    fn compare(&self, source: &Source, light: usize, choices: Vec<Choice>) -> Compare {
        Compare {
            scenes: vec![(source.clone(), vec![light])],
            choices,
            size: self.sweep.size,
            samples: self.sweep.samples,
            reference: self.sweep.reference.clone(),
            frames: 1,
            command: Vec::new(),
        }
    }

    /// Takes over the reference's pictures under names that no other scene has.
    fn keep_reference(&mut self, number: usize, reference: &mut ReferenceRecord, made: &Pictures) {
        for name in reference.pictures.values_mut() {
            let own = name.replacen("pictures/0-", &format!("pictures/{number}-"), 1);
            if let Some(png) = made.files.get(name) {
                self.pictures.files.insert(own.clone(), png.clone());
            }
            *name = own;
        }
    }

    /// Times what was scored, and puts both together.
    fn light(&self, source: &Source, size: (u32, u32), plan: &Plan, scored: LightRecord) -> Result<SweepLight, Error> {
        let LightRecord { light, kind, soft, reference, results } = scored;
        let timing = Timing { gpu: self.gpu, source, light, size, frames: self.sweep.frames };
        let bytes = |result: &ResultRecord| result.cost.as_ref().map(|cost| cost.bytes);
        let good = plan.choices.iter().zip(&results).filter_map(|(c, r)| Some((c.clone(), bytes(r)?)));
        let (timed, yardsticks) = timing.run(&good.collect::<Vec<_>>(), self.progress)?;
        let parts = join(&plan.choices, results, timed);
        let bare_ms = yardsticks.bare_minimum_over_floor_ms.map(|spread| spread.median);
        let curves = plan.curves.iter().map(|curve| numbered(curve, &parts.numbers)).collect();
        let answers = answers(&parts.results, bare_ms);
        let (results, skipped) = (parts.results, parts.skipped);
        Ok(SweepLight { light, kind, soft, reference, yardsticks, results, curves, skipped, answers })
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

/// Puts scores and times together; `timed` has those that have scores, in the same order. What can't be done is set aside.
fn join(choices: &[Choice], results: Vec<ResultRecord>, timed: Vec<Timed>) -> Parts {
    let mut parts = Parts::default();
    let mut timed = timed.into_iter();
    for (choice, result) in choices.iter().zip(results) {
        let time = result.cost.as_ref().and_then(|_| timed.next());
        if result.status == Status::Unsupported {
            let skipped = Skipped { technique: result.technique, reason: result.reason.unwrap_or_default() };
            if !parts.skipped.contains(&skipped) {
                parts.skipped.push(skipped);
            }
            continue;
        }
        parts.numbers.insert(choice.label(), parts.results.len());
        parts.results.push(joined(result, time));
    }
    let Parts { results, skipped, .. } = &mut parts;
    skipped.retain(|s| !results.iter().any(|r| r.technique == s.technique));
    parts
}

fn joined(scored: ResultRecord, timed: Option<Timed>) -> SweepResult {
    let ResultRecord { technique, title, settings, light_samples, status, reason, scores, .. } = scored;
    let mut result = SweepResult {
        technique,
        title,
        settings,
        light_samples,
        status,
        reason,
        errors: scores.as_ref().map(errors).unwrap_or_default(),
        scores,
        cost: None,
        over_floor_ms: None,
    };
    if let Some(timed) = timed {
        (result.status, result.reason) = (timed.status, timed.reason);
        (result.cost, result.over_floor_ms) = (timed.cost, timed.over_floor_ms);
    }
    if result.status != Status::Ok {
        result.scores = None;
        result.errors.clear();
    }
    result
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

/// What each measure that the light has says.
pub(crate) fn answers(results: &[SweepResult], bare_ms: Option<f64>) -> Vec<Answer> {
    let mut techniques: Vec<String> = Vec::new();
    for result in results {
        if !techniques.contains(&result.technique) {
            techniques.push(result.technique.clone());
        }
    }
    let of = |number: usize| results[number].technique.clone();
    let answers = MEASURES.iter().map(|measure| {
        let points: Vec<Point> = results.iter().enumerate().filter_map(|(i, r)| r.point(i, measure)).collect();
        (!points.is_empty()).then(|| answer(measure, &points, &techniques, &of, bare_ms))
    });
    answers.flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{record::fixture, sweep::record::cost};

    fn timed(ms: f64) -> Timed {
        Timed { status: Status::Ok, reason: None, cost: Some(cost(Some(ms), 0.0, ms)), over_floor_ms: Some(ms - 1.0) }
    }

    /// The fixture's results: one that is good, one that is not for this light, one that failed; then the good one again.
    fn parts(last: Timed) -> Parts {
        let mut results = fixture().scenes.remove(0).lights.remove(0).results;
        results.push(results[0].clone());
        let labels = ["shadow-map:size=512", "pcf", "volume", "shadow-map:size=64"];
        let choices: Vec<Choice> = labels.iter().map(|label| Choice::parse(label, &[]).unwrap()).collect();
        join(&choices, results, vec![timed(3.0), last])
    }

    #[test]
    fn times_go_to_what_was_scored_and_the_impossible_is_set_aside() {
        let parts = parts(timed(5.0));
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
        let answers = answers(&parts(timed(5.0)).results, Some(1.0));
        // The fixture has no pixel far from edges.
        assert_eq!(answers.iter().map(|a| a.measure).collect::<Vec<_>>(), ["mae", "vs_hard", "p99"]);
        assert_eq!(answers[0].front, [0]);
        let techniques: Vec<_> = answers[0].budgets[1].best.iter().map(|b| (&*b.technique, b.result)).collect();
        assert_eq!(techniques, [("shadow-map", Some(0)), ("volume", None)]);
    }

    #[test]
    fn what_fails_while_it_is_timed_has_no_scores() {
        let lost = Timed { status: Status::Failed, reason: Some("lost".into()), cost: None, over_floor_ms: None };
        let last = parts(lost).results.remove(2);
        assert_eq!((last.status, last.reason.as_deref(), last.scores.is_none()), (Status::Failed, Some("lost"), true));
    }
}

//! A small sweep for tests.

use crate::{
    bench::record::BenchCost,
    record::{SCHEMA, ScoresRecord},
    spread::Spread,
    status::Status,
    sweep::{
        answers::answers,
        measures::errors,
        record::{Clock, Skipped, SweepCurve, SweepLight, SweepReport, SweepResult, SweepScene, Yardsticks},
    },
};
use std::collections::BTreeMap;

/// A cost for tests.
pub(crate) fn cost(gpu_ms: Option<f64>, prepare_ms: f64, frame_ms: f64) -> BenchCost {
    let spread = |ms| Spread::of([ms]);
    BenchCost {
        passes: Vec::new(),
        gpu_ms: gpu_ms.map(spread),
        prepare_ms: spread(prepare_ms),
        change_ms: None,
        frame_ms: spread(frame_ms),
        draws: 3,
        triangles: 500,
        bytes: 1 << 20,
        traffic: None,
        counts: Vec::new(),
    }
}

/// A small sweep for tests: technique `a<b` with three sizes, `b` that costs more than it is worth,
/// and one that failed.
pub(crate) fn fixture() -> SweepReport {
    let compared = crate::fixture::fixture();
    let scene = compared.scenes.into_iter().next().expect("a scene");
    let light = scene.lights.into_iter().next().expect("a light");
    let good = light.results.into_iter().next().expect("a result");
    let result = |technique: &str, size: u32, ms: f64, mae: f64| {
        let scores = good.scores.clone().map(|scores| ScoresRecord { mae, ..scores });
        SweepResult {
            technique: technique.into(),
            title: "A technique".into(),
            settings: BTreeMap::from([("size".into(), size.to_string())]),
            light_samples: None,
            status: Status::Ok,
            reason: None,
            errors: scores.as_ref().map(errors).unwrap_or_default(),
            scores,
            radiance: None,
            frames: 5,
            cost: Some(cost(Some(ms + 1.0), 0.0, ms + 9.0)),
            over_floor_ms: Some(ms),
        }
    };
    let mut failed = result("broken", 1, 0.0, 0.0);
    (failed.status, failed.reason) = (Status::Failed, Some("the graphics device was lost".into()));
    (failed.scores, failed.cost, failed.over_floor_ms) = (None, None, None);
    failed.errors.clear();
    let results = vec![
        result("a<b", 256, 2.0, 0.04),
        result("a<b", 512, 4.0, 0.02),
        result("a<b", 1024, 8.0, 0.01),
        result("b", 512, 5.0, 0.03),
        failed,
    ];
    let light = SweepLight {
        light: light.light,
        kind: light.kind,
        soft: light.soft,
        reference: light.reference,
        yardsticks: Yardsticks {
            clock: Clock::Gpu,
            floor_ms: Some(Spread::of([1.0])),
            bare_minimum_size: Some(1024),
            bare_minimum_over_floor_ms: Some(Spread::of([2.0, 2.5, 3.0])),
        },
        answers: answers(&results, Some(2.5)),
        results,
        curves: vec![SweepCurve {
            technique: "a<b".into(),
            parameter: "size".into(),
            values: vec![256.0, 512.0, 1024.0],
            results: vec![0, 1, 2],
        }],
        skipped: vec![Skipped { technique: "picky".into(), reason: "not for line lights".into() }],
    };
    SweepReport {
        schema: SCHEMA,
        made: compared.made,
        frames: 5,
        scenes: vec![SweepScene {
            name: scene.name,
            source: scene.source,
            width: scene.width,
            height: scene.height,
            triangles: scene.triangles,
            instances: scene.instances,
            notes: scene.notes,
            lights: vec![light],
        }],
    }
}

//! The data of `sweep.json`. Names are stable; a change that breaks readers raises
//! [`crate::record::SCHEMA`].

use crate::{
    bench::record::BenchCost,
    choice::LIGHT_SAMPLES,
    made::Made,
    record::{RadianceRecord, ReferenceRecord, ScoresRecord},
    round::maybe_six,
    spread::Spread,
    status::Status,
    sweep::{
        answer::{Answer, Point},
        measures::Measure,
    },
};
use serde::Serialize;
use std::collections::BTreeMap;

/// What `sweep` found.
#[derive(Clone, Debug, Serialize)]
pub struct SweepReport {
    /// [`crate::record::SCHEMA`].
    pub schema: u32,
    /// Circumstances.
    pub made: Made,
    /// Frames of each setting, after those of warm-up.
    pub frames: u32,
    /// One for each scene, as given.
    pub scenes: Vec<SweepScene>,
}

/// A scene that was swept.
#[derive(Clone, Debug, Serialize)]
pub struct SweepScene {
    /// Its title.
    pub name: String,
    /// Registry name or path, as given.
    pub source: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Triangles, each instance counted.
    pub triangles: usize,
    /// Placed meshes.
    pub instances: usize,
    /// What the loader made up or left out.
    pub notes: Vec<String>,
    /// One for each light of the scene.
    pub lights: Vec<SweepLight>,
}

/// A light, and error and cost of all settings on it.
#[derive(Clone, Debug, Serialize)]
pub struct SweepLight {
    /// Its number in the scene, from 0.
    pub light: usize,
    /// Its kind.
    pub kind: &'static str,
    /// True where it has an extent.
    pub soft: bool,
    /// The truth.
    pub reference: ReferenceRecord,
    /// What settings are set against.
    pub yardsticks: Yardsticks,
    /// One for each setting.
    pub results: Vec<SweepResult>,
    /// Which of them differ in one parameter.
    pub curves: Vec<SweepCurve>,
    /// Techniques that can't do this light, or not on this adapter.
    pub skipped: Vec<Skipped>,
    /// One for each of [`crate::MEASURES`] that this light has.
    pub answers: Vec<Answer>,
}

/// Costs that others are set against, measured again with every batch of settings. Spreads are over
/// those batches: where they are wide, the machine had other things to do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Yardsticks {
    /// What costs are: GPU time and preparation, or the whole frame where the adapter keeps no
    /// time.
    pub clock: Clock,
    /// The floor, milliseconds; null where nothing was measured.
    pub floor_ms: Option<Spread>,
    /// Texels across the map of the bare minimum: of the sizes measured the one nearest to 1024.
    pub bare_minimum_size: Option<u32>,
    /// The bare minimum over the floor, milliseconds; null where it could not be told from the
    /// floor.
    pub bare_minimum_over_floor_ms: Option<Spread>,
}

/// What costs are made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Clock {
    /// GPU time of the technique's passes, and the CPU's time to prepare them.
    #[default]
    Gpu,
    /// The whole frame from start to finished picture.
    Frame,
}

/// One setting of one technique.
#[derive(Clone, Debug, Serialize)]
pub struct SweepResult {
    /// Id of the technique.
    pub technique: String,
    /// Its title.
    pub title: String,
    /// Parameters set away from their defaults.
    pub settings: BTreeMap<String, String>,
    /// Points of the light that were averaged by brute force; null without.
    pub light_samples: Option<u32>,
    /// How it ended.
    pub status: Status,
    /// Why it is not `ok`; null where it is.
    pub reason: Option<String>,
    /// Errors, as `compare` has them; null unless `ok`.
    pub scores: Option<ScoresRecord>,
    /// Errors of radiance; only there where the technique answers with radiance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radiance: Option<RadianceRecord>,
    /// Those that answers go by, for each of [`crate::MEASURES`] that the light has.
    pub errors: BTreeMap<&'static str, f64>,
    /// Frames that times are medians of: fewer than asked for where they take long.
    pub frames: u32,
    /// Costs, as `bench` has them; null unless `ok`.
    pub cost: Option<BenchCost>,
    /// Cost over that of the floor, which took turns with it, milliseconds; below 0 where it does
    /// less than the floor, or by noise.
    #[serde(serialize_with = "maybe_six")]
    pub over_floor_ms: Option<f64>,
}

/// Results that differ in one parameter, in its order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepCurve {
    /// Id of the technique.
    pub technique: String,
    /// Name of the parameter.
    pub parameter: String,
    /// Its values, one a result; none where it is a word.
    pub values: Vec<f64>,
    /// Numbers of the results.
    pub results: Vec<usize>,
}

/// A technique that was left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Skipped {
    /// Its id.
    pub technique: String,
    /// Why.
    pub reason: String,
}

impl SweepLight {
    /// What a measure says, where the light has it.
    pub fn answer(&self, measure: &Measure) -> Option<&Answer> {
        self.answers.iter().find(|answer| answer.measure == measure.name)
    }
}

impl SweepResult {
    /// Id and settings, as one would ask for it.
    pub fn name(&self) -> String {
        std::iter::once(self.technique.clone()).chain(self.set()).collect::<Vec<_>>().join(" ")
    }

    /// What is set away from the defaults.
    pub(crate) fn set(&self) -> Vec<String> {
        let set = self.settings.iter().map(|(name, value)| format!("{name}={value}"));
        set.chain(self.light_samples.map(|n| format!("{LIGHT_SAMPLES}={n}"))).collect()
    }

    /// Cost and error as a point, where it has both.
    pub(crate) fn point(&self, number: usize, measure: &Measure) -> Option<Point> {
        Some(Point { result: number, cost: self.over_floor_ms?, error: *self.errors.get(measure.name)? })
    }
}

#[cfg(test)]
mod tests {
    use crate::sweep::fixture::fixture;

    #[test]
    fn names_in_json_are_stable() {
        let json = serde_json::to_value(fixture()).unwrap();
        let light = &json["scenes"][0]["lights"][0];
        assert_eq!(
            (&json["schema"], &json["frames"], &light["yardsticks"]["clock"]),
            (&1.into(), &5.into(), &"gpu".into())
        );
        assert_eq!(light["yardsticks"]["bare_minimum_over_floor_ms"]["median"], 2.5);
        assert_eq!(light["results"][1]["over_floor_ms"], 4.0);
        assert_eq!(light["results"][1]["errors"], serde_json::json!({ "mae": 0.02, "p99": 1.0, "vs_hard": 1.5 }));
        assert_eq!(light["results"][4]["over_floor_ms"], serde_json::Value::Null);
        assert_eq!(light["curves"][0]["results"], serde_json::json!([0, 1, 2]));
        assert_eq!(light["skipped"][0]["technique"], "picky");
        let answer = &light["answers"][0];
        assert_eq!((&answer["measure"], &answer["front"]), (&"mae".into(), &serde_json::json!([0, 1, 2])));
        assert_eq!(answer["budgets"][1]["bare_minimums"], 2.0);
        assert_eq!(answer["budgets"][1]["over_floor_ms"], 5.0);
        assert_eq!(answer["budgets"][1]["best"][1], serde_json::json!({ "technique": "b", "result": 3 }));
        assert_eq!(answer["levels"][2]["best"][1], serde_json::json!({ "technique": "b", "result": null }));
    }

    #[test]
    fn a_result_goes_by_what_one_would_ask_for() {
        let mut result = fixture().scenes.remove(0).lights.remove(0).results.remove(0);
        result.light_samples = Some(4);
        assert_eq!(result.name(), "a<b size=256 light-samples=4");
        result.settings.clear();
        result.light_samples = None;
        assert_eq!(result.name(), "a<b");
    }
}

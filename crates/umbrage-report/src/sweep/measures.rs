//! The errors that techniques are set against their cost by: less is better, 0 is the truth.

use crate::{
    column::{COLUMNS, RADIANCE_COLUMNS},
    record::{RadianceRecord, ReferenceRecord, ScoresRecord},
    round::rounded,
};
use serde::Serialize;
use std::collections::BTreeMap;

/// One error.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Measure {
    /// What it is called.
    pub name: &'static str,
    /// The axis of a plot.
    pub title: &'static str,
    /// Levels that the cheapest settings are sought for, largest first.
    pub levels: [f64; 4],
    #[serde(skip)]
    of: Of,
    /// The same of the perfect hard shadow.
    #[serde(skip)]
    pub(crate) hard: fn(&ReferenceRecord) -> Option<f64>,
}

/// The error; `None` where the light has no such number.
#[derive(Clone, Copy, Debug)]
enum Of {
    Visibility(fn(&ScoresRecord) -> Option<f64>),
    Radiance(fn(&RadianceRecord) -> Option<f64>),
}

/// All of them.
pub const MEASURES: [Measure; 7] = [
    Measure {
        name: "mae",
        title: "mean absolute error",
        levels: [0.05, 0.02, 0.01, 0.005],
        of: Of::Visibility(|scores| Some(scores.mae)),
        hard: |reference| reference.hard_mae,
    },
    Measure {
        name: "vs_hard",
        title: "error over that of a perfect hard shadow",
        levels: [1.0, 0.5, 0.25, 0.125],
        of: Of::Visibility(|scores| scores.vs_hard),
        hard: |reference| reference.hard_mae.map(|_| 1.0),
    },
    Measure {
        name: "p99",
        title: "worst error but for 1 % of the pixels",
        levels: [0.5, 0.2, 0.1, 0.05],
        of: Of::Visibility(|scores| Some(scores.p99)),
        hard: |_| None,
    },
    Measure {
        name: "interior",
        title: "percentage wrong far from shadow edges",
        levels: [1.0, 0.3, 0.1, 0.03],
        // 0 and nothing less, whatever the subtraction makes of it.
        of: Of::Visibility(|scores| scores.interior_pct.map(|right| (100.0 - right).max(0.0))),
        hard: |_| None,
    },
    Measure {
        name: "relative_mae",
        title: "mean absolute error of luminance over the mean luminance",
        levels: [0.05, 0.02, 0.01, 0.005],
        of: Of::Radiance(|scores| scores.relative_mae),
        hard: |_| None,
    },
    Measure {
        name: "relative_rmse",
        title: "root of the mean squared error of luminance over the mean luminance",
        levels: [0.05, 0.02, 0.01, 0.005],
        of: Of::Radiance(|scores| scores.relative_rmse),
        hard: |_| None,
    },
    Measure {
        name: "radiance_flip",
        title: "difference seen between the tone-mapped pictures",
        levels: [0.1, 0.05, 0.02, 0.01],
        of: Of::Radiance(|scores| Some(scores.flip)),
        hard: |_| None,
    },
];

impl Measure {
    /// What it means.
    pub fn help(&self) -> String {
        let all = || COLUMNS.iter().chain(&RADIANCE_COLUMNS);
        let column = |name: &str| all().find(|c| c.name.replace(' ', "_") == name).map_or("", |c| c.help);
        match self.name {
            "interior" => {
                "Percentage that is off by more than 0.02 far from every shadow edge: 100 − interior_pct.".into()
            }
            name => column(name).into(),
        }
    }
}

/// All errors that there are, by name.
pub(crate) fn errors(scores: &ScoresRecord) -> BTreeMap<&'static str, f64> {
    by_name(|of| if let Of::Visibility(of) = of { of(scores) } else { None })
}

/// The same of radiance.
pub(crate) fn radiance_errors(scores: &RadianceRecord) -> BTreeMap<&'static str, f64> {
    by_name(|of| if let Of::Radiance(of) = of { of(scores) } else { None })
}

fn by_name(value: impl Fn(Of) -> Option<f64>) -> BTreeMap<&'static str, f64> {
    MEASURES.iter().filter_map(|measure| Some((measure.name, rounded(value(measure.of)?)))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::fixture;

    #[test]
    fn errors_are_those_of_the_scores_and_shrink() {
        let mut light = fixture().scenes.remove(0).lights.remove(0);
        let scores = light.results[0].scores.as_mut().unwrap();
        scores.interior_pct = Some(99.5);
        let wanted = [("mae", 0.0123457), ("vs_hard", 1.5), ("p99", 1.0), ("interior", 0.5)];
        assert_eq!(errors(scores), BTreeMap::from(wanted));
        scores.vs_hard = None;
        assert!(!errors(scores).contains_key("vs_hard"));
        let hard: Vec<_> = MEASURES.iter().map(|m| (m.hard)(&light.reference)).collect();
        assert_eq!(hard, [Some(0.02), Some(1.0), None, None, None, None, None]);
        for measure in MEASURES {
            assert!(measure.levels.is_sorted_by(|a, b| a > b), "{}", measure.name);
            assert!(!measure.help().is_empty(), "{} is not explained", measure.name);
        }
    }
}

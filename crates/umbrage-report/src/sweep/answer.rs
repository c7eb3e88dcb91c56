//! The two questions: the least error at a cost, and the least cost at an error.

use crate::{
    round::{maybe_six, six},
    sweep::measures::Measure,
};
use serde::Serialize;

/// Budgets, in bare minimums.
pub const BUDGETS: [f64; 4] = [1.0, 2.0, 4.0, 8.0];

/// One setting as a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    /// Its number among the results.
    pub result: usize,
    /// Milliseconds over the floor; below 0 where the technique does less than the floor, or by
    /// noise.
    pub cost: f64,
    /// By one measure.
    pub error: f64,
}

/// What a measure says about a light.
#[derive(Clone, Debug, Serialize)]
pub struct Answer {
    /// Name of the measure.
    pub measure: &'static str,
    /// Numbers of the results that no other is better than in both cost and error, cheapest first.
    pub front: Vec<usize>,
    /// The least error of each technique within a budget.
    pub budgets: Vec<Budget>,
    /// The least cost of each technique at an error.
    pub levels: Vec<Level>,
}

/// The least error for this cost.
#[derive(Clone, Debug, Serialize)]
pub struct Budget {
    /// In bare minimums.
    pub bare_minimums: f64,
    /// The same in milliseconds over the floor; null where the bare minimum could not be told from
    /// the floor.
    #[serde(serialize_with = "maybe_six")]
    pub over_floor_ms: Option<f64>,
    /// One for each technique.
    pub best: Vec<Best>,
}

/// The least cost for this error.
#[derive(Clone, Debug, Serialize)]
pub struct Level {
    /// Errors up to this.
    #[serde(serialize_with = "six")]
    pub error: f64,
    /// One for each technique.
    pub best: Vec<Best>,
}

/// The best of a technique.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Best {
    /// Its id.
    pub technique: String,
    /// Number of the result; null where none comes up to what is asked.
    pub result: Option<usize>,
}

/// The points that no other point is as good as in one respect and better than in the other,
/// cheapest first.
pub(crate) fn front(points: &[Point]) -> Vec<Point> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.cost.total_cmp(&b.cost).then(a.error.total_cmp(&b.error)));
    let mut front: Vec<Point> = Vec::new();
    for point in sorted {
        if front.last().is_none_or(|last| point.error < last.error) {
            front.push(point);
        }
    }
    front
}

/// Answers both questions for `techniques`; `of` tells whose a result is, `bare_ms` what the bare
/// minimum costs over the floor.
pub(crate) fn answer(
    measure: &Measure,
    points: &[Point],
    techniques: &[String],
    of: &dyn Fn(usize) -> String,
    bare_ms: Option<f64>,
) -> Answer {
    let best = |fits: &dyn Fn(&Point) -> bool, by: fn(&Point) -> (f64, f64)| -> Vec<Best> {
        let pick = |technique: &String| {
            let own = points.iter().filter(|p| of(p.result) == *technique && fits(p)).map(|p| (by(p), p.result));
            let least = own.min_by(|(a, _), (b, _)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
            Best { technique: technique.clone(), result: least.map(|(_, result)| result) }
        };
        techniques.iter().map(pick).collect()
    };
    let budget = |bare_minimums: f64| {
        let limit = bare_ms.map(|ms| bare_minimums * ms);
        let fits = |p: &Point| limit.is_some_and(|limit| p.cost <= limit);
        Budget { bare_minimums, over_floor_ms: limit, best: best(&fits, |p| (p.error, p.cost)) }
    };
    let level = |error: f64| Level { error, best: best(&|p: &Point| p.error <= error, |p| (p.cost, p.error)) };
    Answer {
        measure: measure.name,
        front: front(points).iter().map(|p| p.result).collect(),
        budgets: BUDGETS.map(budget).into(),
        levels: measure.levels.map(level).into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::measures::MEASURES;

    fn points(of: &[(f64, f64)]) -> Vec<Point> {
        of.iter().enumerate().map(|(result, &(cost, error))| Point { result, cost, error }).collect()
    }

    fn numbers(front: &[Point]) -> Vec<usize> {
        front.iter().map(|p| p.result).collect()
    }

    #[test]
    fn the_front_is_what_nothing_beats() {
        let all = points(&[(4.0, 0.1), (1.0, 0.5), (2.0, 0.6), (2.0, 0.3), (8.0, 0.1), (9.0, 0.01), (-0.1, 0.9)]);
        assert_eq!(numbers(&front(&all)), [6, 1, 3, 0, 5]);
        assert_eq!(numbers(&front(&points(&[(1.0, 0.5), (1.0, 0.5)]))), [0]);
        assert_eq!(numbers(&front(&[])), [0usize; 0]);
    }

    #[test]
    fn no_point_of_the_front_is_beaten_and_all_others_are() {
        // A lattice without order, so that every relation occurs.
        let all = points(&(0..60).map(|i| (f64::from(i * 37 % 23), f64::from(i * 17 % 19))).collect::<Vec<_>>());
        let chosen = numbers(&front(&all));
        let beats =
            |a: &Point, b: &Point| a.cost <= b.cost && a.error <= b.error && (a.cost, a.error) != (b.cost, b.error);
        for point in &all {
            let beaten = all.iter().any(|other| beats(other, point));
            let twin = all[..point.result].iter().any(|o| (o.cost, o.error) == (point.cost, point.error));
            assert_eq!(chosen.contains(&point.result), !beaten && !twin, "{point:?}");
        }
    }

    /// Technique `a` has results 0, 1, 2, `b` the rest, and `c` none.
    fn answers(bare_ms: Option<f64>) -> Answer {
        let all = points(&[(1.0, 0.04), (3.0, 0.02), (9.0, 0.001), (2.0, 0.3), (2.5, 0.008), (3.0, 0.008)]);
        let of = |result| if result < 3 { "a".to_string() } else { "b".into() };
        answer(&MEASURES[0], &all, &["a".into(), "b".into(), "c".into()], &of, bare_ms)
    }

    fn results(best: &[Best]) -> Vec<Option<usize>> {
        best.iter().map(|b| b.result).collect()
    }

    #[test]
    fn the_least_error_within_a_budget() {
        let answer = answers(Some(1.5));
        let of = |i: usize| (answer.budgets[i].over_floor_ms, results(&answer.budgets[i].best));
        assert_eq!(of(0), (Some(1.5), vec![Some(0), None, None]));
        // Of equal errors the cheaper one.
        assert_eq!(of(1), (Some(3.0), vec![Some(1), Some(4), None]));
        assert_eq!(of(2), (Some(6.0), vec![Some(1), Some(4), None]));
        assert_eq!(of(3), (Some(12.0), vec![Some(2), Some(4), None]));
    }

    #[test]
    fn the_least_cost_at_an_error() {
        let answer = answers(Some(1.5));
        let of = |i: usize| (answer.levels[i].error, results(&answer.levels[i].best));
        assert_eq!(of(0), (0.05, vec![Some(0), Some(4), None]));
        // Just that error is good enough.
        assert_eq!(of(1), (0.02, vec![Some(1), Some(4), None]));
        assert_eq!(of(2), (0.01, vec![Some(2), Some(4), None]));
        assert_eq!(of(3), (0.005, vec![Some(2), None, None]));
    }

    #[test]
    fn without_a_bare_minimum_there_is_no_budget() {
        let answer = answers(None);
        assert!(answer.budgets.iter().all(|b| b.over_floor_ms.is_none() && b.best.iter().all(|b| b.result.is_none())));
        assert_eq!(answer.levels[0].best[0].result, Some(0));
    }
}

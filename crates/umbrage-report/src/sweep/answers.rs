//! The answers about a light.

use crate::sweep::{
    answer::{Answer, Point, answer},
    measures::MEASURES,
    record::SweepResult,
};

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

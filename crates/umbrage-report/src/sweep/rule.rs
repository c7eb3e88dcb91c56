//! What is tried where nothing is asked for: a rule that knows parameters, not techniques.
//!
//! Around its base a technique is changed in one parameter at a time. Numbers take a geometric
//! series, ×2, ×½, ×4, ×¼ of the base within their range; a base of 0 has no scale to take one
//! from. Words take each value, switches the other one. What was set away from its default stays. A
//! hard technique is averaged over points of a soft light, too.
//!
//! There are at most [`MOST`] settings a technique. Parameters count in the order of their
//! declaration: the values of each come in pairs, and a parameter gets its second pair when the one
//! two places after it gets its first.

use crate::{
    choice::{Choice, LIGHT_SAMPLES},
    error::Error,
    round::rounded,
    sweep::curve::{Curve, changed},
};
use umbrage::{ParamKind, Registry, Value};

/// Settings of a technique, its base among them.
pub(crate) const MOST: usize = 12;

/// Factors of a series.
const FACTORS: [f64; 4] = [2.0, 0.5, 4.0, 0.25];

/// Points of a soft light that hard techniques are averaged over.
const POINTS: [&str; 2] = ["4", "16"];

/// A parameter that is varied.
#[derive(Debug, PartialEq)]
struct Line {
    name: &'static str,
    /// What the base has, where it is a number.
    number: Option<f64>,
    /// What else is tried, most telling first.
    values: Vec<String>,
}

/// The base and what is tried around it, with a curve for each number that is varied.
pub(crate) fn around(base: &Choice, soft: bool) -> Result<(Vec<Choice>, Vec<Curve>), Error> {
    let (mut choices, mut curves) = (vec![base.clone()], Vec::new());
    let lines = lines(base, soft);
    for (line, count) in lines.iter().zip(counts(&lines)) {
        let mut along: Vec<(f64, String)> = line.number.iter().map(|&number| (number, base.label())).collect();
        for value in &line.values[..count] {
            let choice = changed(base, &[(line.name.into(), value.clone())])?;
            along.extend(value.parse().ok().filter(|_| line.number.is_some()).map(|v: f64| (v, choice.label())));
            choices.push(choice);
        }
        if along.len() > 1 {
            along.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (values, labels) = along.into_iter().unzip();
            curves.push(Curve { technique: base.info.id, parameter: line.name.into(), labels, values });
        }
    }
    Ok((choices, curves))
}

/// All that could be varied.
fn lines(base: &Choice, soft: bool) -> Vec<Line> {
    let brute = (soft && base.settings.is_hard() && base.light_samples.is_none()).then(|| Line {
        name: LIGHT_SAMPLES,
        number: Some(1.0),
        values: POINTS.map(String::from).to_vec(),
    });
    let free = base.info.params().iter().zip(base.settings.iter());
    let free = free.filter(|(param, _)| !base.changed().contains_key(param.name));
    let own = free.map(|(param, (_, value))| {
        let number = match value {
            Value::Int(v) => Some(v as f64),
            Value::Float(v) => Some(v),
            Value::Choice(_) | Value::Switch(_) | Value::Filter(_) => None,
        };
        Line { name: param.name, number, values: values(base.registry(), &param.kind, value) }
    });
    brute.into_iter().chain(own).filter(|line| !line.values.is_empty()).collect()
}

/// How many values of each parameter are tried.
fn counts(lines: &[Line]) -> Vec<usize> {
    let of = |(place, line): (usize, &Line)| (0..line.values.len()).map(|i| (place + i / 2 * 2, place)).collect();
    let mut ranked: Vec<(usize, usize)> = lines.iter().enumerate().flat_map(|l| -> Vec<_> { of(l) }).collect();
    ranked.sort();
    ranked.truncate(MOST - 1);
    (0..lines.len()).map(|place| ranked.iter().filter(|(_, of)| *of == place).count()).collect()
}

/// What else a parameter may be, most telling first.
fn values(registry: &Registry, kind: &ParamKind, base: Value) -> Vec<String> {
    let tried: Vec<String> = match (*kind, base) {
        (ParamKind::Int { min, max, .. }, Value::Int(v)) => {
            FACTORS.map(|f| Value::Int(((v as f64 * f).round() as i64).clamp(min, max)).to_string()).to_vec()
        }
        (ParamKind::Float { min, max, .. }, Value::Float(v)) => {
            FACTORS.map(|f| Value::Float(rounded(v * f).clamp(min, max)).to_string()).to_vec()
        }
        (ParamKind::Choice { .. } | ParamKind::Filter { .. }, _) => {
            kind.words(registry).into_iter().map(String::from).collect()
        }
        (_, Value::Switch(on)) => vec![Value::Switch(!on).to_string()],
        _ => Vec::new(),
    };
    let mut values: Vec<String> = Vec::new();
    for value in tried {
        if value != base.to_string() && !values.contains(&value) {
            values.push(value);
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(name: &'static str, values: usize) -> Line {
        Line { name, number: None, values: (0..values).map(|v| v.to_string()).collect() }
    }

    #[test]
    fn numbers_take_a_geometric_series_within_their_range() {
        let int = |min, max, v| values(&Registry::default(), &ParamKind::Int { min, max, default: v }, Value::Int(v));
        assert_eq!(int(1, 16384, 1024), ["2048", "512", "4096", "256"]);
        assert_eq!(int(1, 1500, 1024), ["1500", "512", "256"]);
        assert_eq!(int(1, 8, 1), ["2", "4"]);
        assert_eq!(int(0, 1_000_000, 0), [""; 0]);
        let float =
            |min, max, v| values(&Registry::default(), &ParamKind::Float { min, max, default: v }, Value::Float(v));
        assert_eq!(float(0.0, 64.0, 2.5), ["5", "1.25", "10", "0.625"]);
        assert_eq!(float(0.0, 1.0, 1.0), ["0.5", "0.25"]);
        assert_eq!(float(0.0, 1.0, 0.0), [""; 0]);
    }

    #[test]
    fn words_take_each_value_and_switches_the_other() {
        let kind = ParamKind::Choice { values: &["a", "b", "c"] };
        assert_eq!(values(&Registry::default(), &kind, Value::Choice("b")), ["a", "c"]);
        assert_eq!(values(&Registry::default(), &ParamKind::Switch { default: true }, Value::Switch(true)), ["off"]);
    }

    #[test]
    fn parameters_declared_earlier_get_more_values() {
        assert_eq!(counts(&[line("a", 4), line("b", 4), line("c", 4), line("d", 4), line("e", 4)]), [4, 4, 2, 1, 0]);
        assert_eq!(counts(&[line("a", 1), line("b", 9)]), [1, 9]);
        assert_eq!(counts(&[line("a", 40)]), [MOST - 1]);
        assert_eq!(counts(&[]), [0usize; 0]);
    }

    #[test]
    fn every_technique_is_varied_one_parameter_at_a_time() {
        for info in umbrage::techniques() {
            let base = Choice::new(&Registry::default(), info.id, &[]).unwrap();
            for soft in [false, true] {
                let (choices, curves) = around(&base, soft).unwrap();
                assert!(choices.len() <= MOST, "{} has {}", info.id, choices.len());
                assert_eq!(choices[0].label(), info.id);
                for choice in &choices[1..] {
                    let set = choice.changed().len() + choice.light_samples.iter().count();
                    assert_eq!(set, 1, "{} differs in {set} parameters", choice.label());
                    assert!(choice.light_samples.is_none() || soft && choice.settings.is_hard(), "{}", choice.label());
                }
                for curve in curves {
                    assert!(curve.labels.contains(&base.label()), "{curve:?} misses the base");
                    assert!(curve.labels.iter().all(|l| choices.iter().any(|c| c.label() == *l)), "{curve:?}");
                }
            }
        }
    }

    #[test]
    fn what_is_set_stays_and_curves_are_in_order() {
        let number = |p: &&umbrage::Param| matches!(p.kind, ParamKind::Int { default, .. } if default > 3);
        let with_number = umbrage::techniques().iter().find_map(|t| Some((t, t.params().iter().find(number)?)));
        let (info, param) = with_number.expect("a technique with a number");
        let base = Choice::new(&Registry::default(), info.id, &[(param.name.into(), "3".into())]).unwrap();
        let (held, _) = around(&base, false).unwrap();
        assert!(held.iter().all(|c| c.changed()[param.name] == "3"), "{held:?}");

        let (_, curves) = around(&Choice::new(&Registry::default(), info.id, &[]).unwrap(), false).unwrap();
        let curve = curves.iter().find(|c| c.parameter == param.name).expect("a curve of the number");
        let default = param.kind.default().to_string();
        let value = |label: &String| label.rsplit_once('=').map_or(&*default, |(_, v)| v).parse::<f64>().unwrap();
        let values: Vec<f64> = curve.labels.iter().map(value).collect();
        assert!(values.len() > 2 && values.is_sorted(), "{values:?}");
    }
}

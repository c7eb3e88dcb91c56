//! Settings around a base, and curves through them.

use crate::{
    choice::{Choice, LIGHT_SAMPLES},
    error::Error,
};

/// Settings that differ in one parameter, in its order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Curve {
    pub technique: &'static str,
    pub parameter: String,
    /// [`Choice::label`] of each.
    pub labels: Vec<String>,
    /// The parameter's value in each; none where it is a word.
    pub values: Vec<f64>,
}

/// The base with `set` beside or in place of what it has set.
pub(crate) fn changed(base: &Choice, set: &[(String, String)]) -> Result<Choice, Error> {
    let own = base.changed().iter().map(|(name, value)| (name.clone(), value.clone()));
    let points = base.light_samples.map(|n| (LIGHT_SAMPLES.to_string(), n.to_string()));
    let all: Vec<_> = own.chain(points).chain(set.iter().cloned()).collect();
    Choice::new(base.registry(), base.info.id, &all)
}

//! Quality at equal cost and cost at equal quality: techniques × settings on each light, scored as
//! [`Compare`](crate::Compare) does it and timed as [`Bench`](crate::Bench) does.

mod along;
pub(crate) mod answer;
mod answers;
mod axis;
mod canvas;
mod curve;
#[cfg(test)]
pub(crate) mod fixture;
mod light;
pub(crate) mod measures;
mod outcome;
mod plan;
pub(crate) mod plot;
pub(crate) mod record;
mod rule;
mod run;
mod table;
mod time;
mod vary;

pub use outcome::SweepOutcome;
pub use run::Sweep;
pub use vary::Vary;

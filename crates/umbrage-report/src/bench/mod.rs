//! Times of techniques, set against the least that any technique can cost in the same run.

pub(crate) mod baseline;
mod columns;
mod csv;
pub(crate) mod record;
mod run;
mod runner;
mod table;
mod versus;

pub use record::{BenchCost, BenchLight, BenchPass, BenchReport, BenchResult, BenchScene, BenchTraffic};
pub use run::Bench;
pub use versus::{Earlier, NoBenchmark};

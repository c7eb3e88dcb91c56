//! Runs scenes × techniques × lights against the ground truth and records what came out.
//!
//! [`Compare`] gives errors, times, memory and pictures of every technique as a [`Report`], written
//! as `report.json` and as one self-contained page; [`Bench`] gives times alone, set against the
//! floor of the same run; [`Sweep`] puts both together over many settings and asks what is best at
//! a cost or an error. All walk the registry of `umbrage`: a new technique needs no line here.

mod choice;
mod error;
mod given;
mod maps;
mod motion;
mod path;
mod progress;
mod source;

pub use choice::{
    CONTACT, CONTACT_THICKNESS, Choice, LIGHT_FRAMES, LIGHT_PIECES, LIGHT_SAMPLES, PATH_TRACED, PATH_TRACED_SUMMARY,
    RAY_TRACED, RAY_TRACED_SUMMARY, RayTraced,
};
pub use error::Error;
pub use given::Given;
pub use maps::Maps;
pub use motion::{Motion, Moving, PERIOD, place};
pub use path::CameraPath;
pub use progress::{Progress, Silent};
pub use source::Source;
pub use umbrage_io::printable;

/// Browsers have the names of scenes, techniques and ways of the camera. What runs, measures and
/// writes files waits for the device, and is for other systems.
macro_rules! not_in_browsers {
    ($($item:item)*) => { $(#[cfg(not(target_family = "wasm"))] $item)* };
}

not_in_browsers! {
    mod bake;
    mod bakes;
    mod bench;
    mod bounced;
    mod cell;
    mod churn;
    mod column;
    mod compare;
    #[cfg(test)]
    mod fixture;
    mod flicker;
    mod html;
    mod made;
    mod measure;
    mod output;
    mod path_traced;
    mod pictures;
    pub mod record;
    mod round;
    mod shot;
    mod sky;
    mod spread;
    mod stage;
    mod status;
    mod sweep;
    mod table;
    mod truth;
    mod way;

    pub use umbrage_bake;
    pub use bake::Bake;
    pub use bench::{Bench, BenchCost, BenchLight, BenchPass, BenchReport, BenchResult, BenchScene, BenchTraffic};
    pub use bench::{Earlier, NoBenchmark};
    pub use path_traced::PathTraced;
    pub use column::{COLUMNS, Column, RADIANCE_COLUMNS};
    pub use compare::{Compare, Outcome};
    pub use html::page;
    pub use made::{Adapter, Machine, Made};
    pub use output::{Folder, check_file};
    pub use pictures::Pictures;
    pub use record::Report;
    pub use umbrage_io::Probe;
    pub use sky::SkyProbe;
    pub use shot::{Aov, Method, Picture, Shot};
    pub use spread::Spread;
    pub use sweep::{
        Sweep, SweepOutcome, Vary,
        answer::{Answer, BUDGETS, Best, Budget, Level},
        measures::{MEASURES, Measure},
        record::{Clock, Skipped, SweepCurve, SweepLight, SweepReport, SweepResult, SweepScene, Yardsticks},
    };
    pub use table::tables;
    pub use truth::{Tracing, Truth};
    pub use way::Way;

    /// Indented JSON with a line end. Plain data with text keys always has a JSON form.
    fn json(data: &impl serde::Serialize) -> String {
        serde_json::to_string_pretty(data).unwrap_or_default() + "\n"
    }
}

//! The tracer as a whole, from outside.

mod closed_forms;
mod light_seen;
mod progressive;
mod radiance;
mod references;
mod scales;
mod scenes;
mod visibility;

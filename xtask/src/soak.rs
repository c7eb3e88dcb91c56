//! Whether memory stays level, and pictures right, however long it runs.

use crate::shell;
use anyhow::{Context, Result};

/// Draws for so many minutes, and as many again in the laboratory.
pub fn run(minutes: &str) -> Result<()> {
    minutes.parse::<f64>().with_context(|| format!("`{minutes}` is no number of minutes"))?;
    let mut command = shell::cargo();
    command.args(["run", "--quiet", "--package", "umbrage-renderer", "--example", "soak", "--", minutes]);
    command.env("NODEVICE_SELECT", "1");
    shell::run(command)?;
    let mut laboratory = shell::cargo();
    laboratory.args([
        "test",
        "--package",
        "umbrage-viewer",
        "--test",
        "lab",
        "memory_stays_level",
        "--",
        "--nocapture",
    ]);
    laboratory.env("UMBRAGE_SOAK_MINUTES", minutes);
    shell::run(laboratory)
}

//! Whether memory stays level, and pictures right, however long it runs.

use crate::shell;
use anyhow::{Context, Result};

/// Draws for so many minutes.
pub fn run(minutes: &str) -> Result<()> {
    minutes.parse::<f64>().with_context(|| format!("`{minutes}` is no number of minutes"))?;
    let mut command = shell::cargo();
    command.args(["run", "--quiet", "--package", "umbrage-renderer", "--example", "soak", "--", minutes]);
    command.env("NODEVICE_SELECT", "1");
    shell::run(command)
}

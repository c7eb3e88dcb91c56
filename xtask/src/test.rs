//! The whole test suite.

use crate::{
    setup,
    shell::{self, Profile},
};
use anyhow::Result;

/// Runs every test of the workspace; `rest` goes to `cargo test` (a filter, `-- --nocapture`).
pub fn run(rest: &[&str]) -> Result<()> {
    setup::run(Profile::Dev)?;
    let mut command = shell::cargo();
    command.args(["test", "--workspace", "--no-fail-fast"]).args(rest);
    shell::run(command)
}

//! The whole test suite.

use crate::{bench, setup, shell};
use anyhow::{Result, bail};
use std::process::Command;

/// The test that also needs Python, by a part of its name.
const WITH_PYTHON: &str = "the_numbers_are_those_of_the_script";

/// Runs every test of the workspace; `rest` goes to `cargo test` (a filter, `-- --nocapture`).
/// Tests that need the shared references are ignored by name; where the references are there they
/// run, else the last lines say how many did not.
pub fn run(rest: &[&str]) -> Result<()> {
    shell::build_tests()?;
    setup::run_tested()?;
    let missing = Missing::find();
    let mut command = shell::cargo();
    command.args(["test", "--workspace", "--no-fail-fast"]).args(rest);
    if !rest.contains(&"--") {
        command.arg("--");
    }
    command.args(missing.arguments());
    let result = shell::run(command);
    missing.report()?;
    result
}

/// What the machine lacks that some tests need.
struct Missing {
    references: bool,
    python: bool,
}

impl Missing {
    fn find() -> Self {
        let imports = Command::new("python3").args(["-c", "import numpy, PIL"]).output();
        Self {
            references: !bench::shared().join("references").is_dir(),
            python: !imports.is_ok_and(|output| output.status.success()),
        }
    }

    /// For the test programs: run what is ignored by name as far as it can run.
    fn arguments(&self) -> &'static [&'static str] {
        match (self.references, self.python) {
            (true, _) => &[],
            (false, true) => &["--include-ignored", "--skip", WITH_PYTHON],
            (false, false) => &["--include-ignored"],
        }
    }

    /// Says how many tests did not run, and what they need.
    fn report(&self) -> Result<()> {
        if self.references {
            let folder = bench::shared();
            println!("\n{} tests did not run: they need the shared references.", count_ignored()?);
            println!("There are none in {}; UMBRAGE_SHARED names another folder.", folder.display());
        } else if self.python {
            println!("\n1 test did not run, {WITH_PYTHON}: it needs python3 with numpy and pillow.");
        } else {
            println!("\nall tests ran");
        }
        Ok(())
    }
}

/// The number of tests that are ignored by name.
fn count_ignored() -> Result<usize> {
    let mut command = shell::cargo();
    command.args(["test", "--quiet", "--workspace", "--tests", "--", "--list", "--ignored"]);
    let listed = shell::output(command)?.lines().filter(|line| line.ends_with(": test")).count();
    if listed == 0 {
        bail!("no test is ignored by name, yet some need the shared references");
    }
    Ok(listed)
}

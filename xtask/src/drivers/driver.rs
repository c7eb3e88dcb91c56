//! One driver under test.

use super::packages::Unpacked;
use super::results::{Results, cells};
use crate::shell;
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

/// Tests on the device that hold on every driver: bounds of errors and of the interior, robustness,
/// what rasterisers may do, limits.
const TESTS: [&str; 5] = ["golden::", "robust::", "rasterisers::", "limits::", "dark::"];

/// A driver: the one that is there, or another by the file that describes it to the Vulkan loader.
pub struct Driver {
    pub name: String,
    /// A part of the adapter's name that has to be measured.
    pub adapter: Option<&'static str>,
    /// What `--adapter` gets.
    pub choice: Option<String>,
    pub description: Option<PathBuf>,
    pub libraries: Option<PathBuf>,
}

/// How much is compared.
pub struct Matrix {
    pub scenes: &'static [&'static str],
    pub size: &'static str,
    /// Whether tests run, too.
    pub tests: bool,
}

impl Driver {
    /// What the machine's Vulkan loader finds.
    pub fn installed() -> Self {
        Self { name: "default".into(), adapter: None, choice: None, description: None, libraries: None }
    }

    /// Another adapter of those that it finds, by its number in the list.
    pub fn adapter(number: u32) -> Self {
        Self { name: format!("adapter-{number}"), choice: Some(number.to_string()), ..Self::installed() }
    }

    /// One whose adapter has to have `adapter` in its name.
    pub fn unpacked(name: &str, adapter: &'static str, unpacked: Unpacked) -> Self {
        let Unpacked { description, libraries, package } = unpacked;
        println!("{name}: {package}");
        Self {
            name: name.into(),
            adapter: Some(adapter),
            choice: None,
            description: Some(description),
            libraries: Some(libraries),
        }
    }

    /// One by its ICD file.
    pub fn described(name: &str, description: PathBuf) -> Self {
        Self { name: name.into(), description: Some(description), ..Self::installed() }
    }

    /// Lets the command find this driver and no other.
    fn select(&self, command: &mut Command) {
        if let Some(file) = &self.description {
            command.env("VK_ICD_FILENAMES", file).env("VK_DRIVER_FILES", file);
        }
        if let Some(folder) = &self.libraries {
            command.env("LD_LIBRARY_PATH", folder);
        }
        command.env("NODEVICE_SELECT", "1");
    }

    /// Compares all techniques, and runs the tests where they are asked for.
    pub fn measure(&self, matrix: &Matrix, folder: &str) -> Result<Results> {
        let out = format!("{folder}/{}", self.name);
        let mut arguments = vec!["compare"];
        arguments.extend(matrix.scenes);
        arguments.extend(["--techniques", "all", "--samples", "16", "--size", matrix.size, "--frames", "1"]);
        let truth = format!("{folder}/truth");
        arguments.extend(["--truth-cache", &truth, "-o", &out, "--json"]);
        if let Some(adapter) = &self.choice {
            arguments.extend(["--adapter", adapter]);
        }
        let mut command = shell::tested_umbrage(&arguments)?;
        self.select(&mut command);
        let start = Instant::now();
        let report: Value =
            serde_json::from_str(&shell::output(command)?).context("`compare --json` printed no JSON")?;
        let adapter = report["made"]["adapter"]["name"].as_str().unwrap_or("?").to_string();
        if let Some(expected) = self.adapter.filter(|expected| !adapter.contains(expected)) {
            bail!("{expected} was asked for, yet {adapter} was measured");
        }
        let cells = cells(&report);
        if cells.is_empty() {
            bail!("{} ({adapter}) gave no result", self.name);
        }
        let seconds = start.elapsed().as_secs_f64();
        let failed_tests = if matrix.tests { Some(self.test()?) } else { None };
        Ok(Results { name: self.name.clone(), adapter, cells, seconds, failed_tests })
    }

    /// The names of tests that fail on this driver.
    fn test(&self) -> Result<Vec<String>> {
        let mut command = shell::cargo();
        command.args(["test", "--quiet", "--workspace", "--test", "gpu", "--"]).args(TESTS);
        self.select(&mut command);
        if let Some(adapter) = &self.choice {
            command.env("UMBRAGE_ADAPTER", adapter);
        }
        let output = command.output().context("can't run the tests")?;
        let text = String::from_utf8_lossy(&output.stdout);
        let failed: Vec<_> = text.lines().filter_map(failed_test).collect();
        if !output.status.success() && failed.is_empty() {
            bail!("the tests could not run on {}: {}", self.name, String::from_utf8_lossy(&output.stderr));
        }
        Ok(failed)
    }
}

/// The test that a line of the test program says has failed.
fn failed_test(line: &str) -> Option<String> {
    let name = line.strip_prefix("---- ")?.strip_suffix(" stdout ----")?;
    Some(name.to_string())
}

#[cfg(test)]
mod tests {
    use super::failed_test;

    #[test]
    fn failures_are_named() {
        assert_eq!(failed_test("---- robust::empty stdout ----").as_deref(), Some("robust::empty"));
        assert_eq!(failed_test("test robust::empty ... ok"), None);
    }
}

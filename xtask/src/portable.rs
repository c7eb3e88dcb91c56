//! What a change must not break although no test runs there: browsers, and the oldest toolchain.

use crate::shell;
use anyhow::{Context, Result};
use std::process::{Command, Stdio};

/// The crates that a browser can run, some of them in part; `umbrage-metrics` joins them without
/// ꟻLIP, which is C++.
const FOR_BROWSERS: [&str; 7] = [
    "umbrage-core",
    "umbrage-io",
    "umbrage-reference",
    "umbrage-metrics",
    "umbrage",
    "umbrage-renderer",
    "umbrage-report",
];
const BROWSER: &str = "wasm32-unknown-unknown";

/// Compiles nothing at full speed that only runs while compiling.
const QUICK: [&str; 4] = ["--config", "profile.dev.package.\"*\".opt-level=0", "--config", "profile.dev.opt-level=0"];

/// Checks the crates for both, without their default features: as hosts have them that bring a
/// device of their own. Where rustup is missing, so may be target and toolchain: then it
/// says what did not run.
pub fn run() -> Result<()> {
    let oldest = oldest_toolchain()?;
    if !has_rustup() {
        println!("not checked, since there is no rustup: {BROWSER}, and Rust {oldest}");
        return Ok(());
    }
    shell::run(rustup(&["target", "add", BROWSER]))?;
    let mut check = shell::cargo();
    check.args(["check", "--no-default-features", "--target", BROWSER, "--target-dir", "target/portable"]).args(QUICK);
    // What is dead there belongs behind a condition.
    check.env("RUSTFLAGS", "-D warnings");
    shell::run(with_packages(check))?;
    shell::run(alone())?;
    shell::run(rustup(&["toolchain", "install", &oldest, "--profile", "minimal"]))?;
    // rustup chooses the toolchain anew: cargo has named its own in the environment.
    let mut check = rustup(&["run", &oldest, "cargo", "check", "--no-default-features", "--features", "umbrage/mint"]);
    check.args(["--target-dir", "target/portable"]).args(QUICK).env_remove("CARGO").env_remove("RUSTC");
    shell::run(with_packages(check))
}

/// The library with none of its features, which nothing else of the workspace is content with.
fn alone() -> Command {
    let mut check = shell::cargo();
    check.args(["check", "--package", "umbrage", "--no-default-features", "--target", BROWSER]);
    check.args(["--target-dir", "target/portable"]).args(QUICK).env("RUSTFLAGS", "-D warnings");
    check
}

fn with_packages(mut command: Command) -> Command {
    command.args(FOR_BROWSERS.iter().flat_map(|package| ["--package", package]));
    command
}

/// The toolchain of `rust-version` in the workspace's manifest.
fn oldest_toolchain() -> Result<String> {
    let manifest = std::fs::read_to_string("Cargo.toml").context("can't read Cargo.toml")?;
    let line = manifest.lines().find_map(|line| line.strip_prefix("rust-version = "));
    Ok(format!("{}.0", line.context("Cargo.toml names no `rust-version`")?.trim_matches('"')))
}

fn rustup(arguments: &[&str]) -> Command {
    let mut command = Command::new("rustup");
    command.args(arguments);
    command
}

fn has_rustup() -> bool {
    let mut asked = rustup(&["--version"]);
    asked.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

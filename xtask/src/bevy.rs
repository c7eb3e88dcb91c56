//! The crate for Bevy, which is no member of the workspace: its tests and its example.

use crate::shell;
use anyhow::{Context, Result, bail};
use std::process::{Command, Stdio};

const MANIFEST: &str = "bevy_umbrage/Cargo.toml";

/// Tests it and draws the example's pictures into out/bevy/, with the first toolchain that is new
/// enough.
pub fn run() -> Result<()> {
    let wanted = rust_version()?;
    let Some(toolchain) = ["stable", "beta", "nightly"].into_iter().find(|name| is_enough(name, wanted)) else {
        let (major, minor, _) = wanted;
        bail!(
            "Bevy needs Rust {major}.{minor}, and no toolchain of rustup's is as new; \
             `rustup toolchain install stable` (or nightly) brings one"
        );
    };
    std::fs::create_dir_all("out/bevy").context("can't make out/bevy")?;
    shell::run(cargo(toolchain, &["test"]))?;
    let mut example = cargo(toolchain, &["run", "--example", "fox"]);
    let shadows = ["--shadows", "umbrage,bevy,none"];
    example.arg("--").args(shadows).args(["--frames", "10", "--truth", "256", "--out", "out/bevy/fox.png"]);
    shell::run(example)
}

fn cargo(toolchain: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new("rustup");
    command.args(["run", toolchain, "cargo"]).args(arguments);
    // A nightly of the right version, but the wrong day, mostly does.
    command.args(["--manifest-path", MANIFEST, "--ignore-rust-version"]);
    command.env_remove("CARGO").env_remove("RUSTC").env("NODEVICE_SELECT", "1");
    command
}

type Version = (u32, u32, u32);

/// What the crate's manifest asks for.
fn rust_version() -> Result<Version> {
    let manifest = std::fs::read_to_string(MANIFEST).with_context(|| format!("can't read {MANIFEST}"))?;
    let line = manifest.lines().find_map(|line| line.strip_prefix("rust-version = "));
    line.and_then(|line| version(line.trim_matches('"'))).with_context(|| format!("{MANIFEST} has no `rust-version`"))
}

fn is_enough(toolchain: &str, (major, minor, patch): Version) -> bool {
    let asked = Command::new("rustup").args(["run", toolchain, "rustc", "--version"]).stderr(Stdio::null()).output();
    let Ok(answer) = asked else { return false };
    let text = String::from_utf8_lossy(&answer.stdout);
    let Some(found) = text.split_whitespace().nth(1).and_then(version) else { return false };
    // A nightly counts its patches at 0.
    found >= (major, minor, patch) || (toolchain == "nightly" && found >= (major, minor, 0))
}

/// Reads `1.97.1` or `1.97.0-nightly`.
fn version(text: &str) -> Option<Version> {
    let mut numbers = text.split(['.', '-']).map(|number| number.parse().ok());
    Some((numbers.next()??, numbers.next()??, numbers.next().flatten().unwrap_or(0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read_as_toolchains_and_manifests_write_them() {
        assert_eq!(version("1.97.0-nightly"), Some((1, 97, 0)));
        assert_eq!(version("1.97.1"), Some((1, 97, 1)));
        assert_eq!(version("1.97"), Some((1, 97, 0)));
        assert_eq!(version("nightly"), None);
    }
}

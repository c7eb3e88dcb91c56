//! Tells the program which commit it is built from; reports name it.

use std::{path::Path, process::Command};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Git writes a line here with every commit. A missing path would run this in every build.
    let log = "../../.git/logs/HEAD";
    if Path::new(log).exists() {
        println!("cargo::rerun-if-changed={log}");
    }
    let output = Command::new("git").args(["rev-parse", "--short=12", "HEAD"]).output();
    if let Some(output) = output.ok().filter(|o| o.status.success()) {
        println!("cargo::rustc-env=UMBRAGE_COMMIT={}", String::from_utf8_lossy(&output.stdout).trim());
    }
}

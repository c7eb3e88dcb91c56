//! Whether the library's crates can be published.

use crate::shell;
use anyhow::Result;

/// Those that nobody builds on.
const NOT_PUBLISHED: [&str; 3] = ["umbrage-cli", "umbrage-viewer", "xtask"];

/// Packs every crate as a registry would get it. That the packed crates compile is not tried: their
/// files are those of the workspace, which everything else here compiles.
pub fn run() -> Result<()> {
    let mut package = shell::cargo();
    package.args(["package", "--workspace", "--no-verify", "--allow-dirty", "--target-dir", "target/package"]);
    package.args(NOT_PUBLISHED.iter().flat_map(|name| ["--exclude", name]));
    shell::run(package)
}

//! Running other programs, shown before they run.

use anyhow::{Context, Result, bail};
use std::{
    path::PathBuf,
    process::{Command, Stdio},
};

/// How the `umbrage` command is built.
#[derive(Clone, Copy, PartialEq)]
pub enum Profile {
    /// As the tests build it.
    Dev,
    /// For measuring.
    Release,
}

/// Whether `umbrage list` names it among the techniques, though it is one of the references, which
/// have no folder and draw nothing on a GPU.
pub fn is_reference(id: &str) -> bool {
    ["ray-traced", "path-traced"].contains(&id)
}

/// The folder of the workspace's `Cargo.toml`.
pub fn workspace_root() -> Result<PathBuf> {
    let here = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").context("run this as `cargo xtask`")?);
    here.parent().map(PathBuf::from).context("xtask lies in no folder")
}

/// The cargo that runs us.
pub fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// The `umbrage` command, built first where it is out of date.
pub fn umbrage(profile: Profile, arguments: &[&str]) -> Command {
    let mut command = cargo();
    command.args(["run", "--quiet", "--package", "umbrage-cli"]);
    if profile == Profile::Release {
        command.arg("--release");
    }
    // Keeps Mesa's device chooser from looking for a desktop and complaining where there is none.
    command.env("NODEVICE_SELECT", "1").arg("--").args(arguments);
    command
}

/// The `umbrage` command that the tests have built, beside this program.
pub fn tested_umbrage(arguments: &[&str]) -> Result<Command> {
    let name = format!("umbrage{}", std::env::consts::EXE_SUFFIX);
    let path = std::env::current_exe().context("can't find this program's own file")?.with_file_name(name);
    let mut command = Command::new(path);
    command.env("NODEVICE_SELECT", "1").args(arguments);
    Ok(command)
}

/// Builds the `umbrage` command with cargo's own progress on view.
pub fn build(profile: Profile) -> Result<()> {
    let mut command = cargo();
    command.args(["build", "--package", "umbrage-cli"]);
    if profile == Profile::Release {
        command.arg("--release");
    }
    run(command)
}

/// Builds all tests, and with them the command that [`tested_umbrage`] runs. Building it by itself
/// would compile much of what it needs a second time, with other features.
pub fn build_tests() -> Result<()> {
    let mut build = cargo();
    build.args(["test", "--workspace", "--no-run"]);
    run(build)
}

/// Prints the command, runs it, and fails where it fails.
pub fn run(mut command: Command) -> Result<()> {
    let line = text(&command);
    eprintln!("$ {line}");
    let status = command.status().with_context(|| format!("can't run `{line}`"))?;
    if !status.success() {
        bail!("`{line}` failed ({status})");
    }
    Ok(())
}

/// Runs the command and returns what it printed; its complaints pass through.
pub fn output(mut command: Command) -> Result<String> {
    let line = text(&command);
    eprintln!("$ {line}");
    let output = command.stderr(Stdio::inherit()).output().with_context(|| format!("can't run `{line}`"))?;
    if !output.status.success() {
        bail!("`{line}` failed ({})", output.status);
    }
    String::from_utf8(output.stdout).with_context(|| format!("`{line}` printed no UTF-8"))
}

/// The command as one would type it.
fn text(command: &Command) -> String {
    let program = command.get_program().to_string_lossy().into_owned();
    let name = program.rsplit(['/', '\\']).next().unwrap_or_default().to_string();
    let words = command.get_args().map(|a| a.to_string_lossy().into_owned());
    std::iter::once(name).chain(words).collect::<Vec<_>>().join(" ")
}

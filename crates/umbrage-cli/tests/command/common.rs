//! Running the command in a folder of its own.

use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

/// The command, quiet about what is not its own.
pub fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_umbrage"));
    command.args(arguments).current_dir(folder).env("NODEVICE_SELECT", "1");
    command
}

/// Runs it to its end.
pub fn umbrage(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().expect("the command starts")
}

/// What it printed, where it had to succeed.
pub fn output(folder: &Path, arguments: &[&str]) -> String {
    let output = umbrage(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "umbrage {arguments:?} failed:\n{errors}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// Names of all files and folders below `folder`, sorted.
pub fn files(folder: &Path) -> Vec<String> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            names.extend(files(&path));
        }
        names.push(path.display().to_string());
    }
    names.sort();
    names
}

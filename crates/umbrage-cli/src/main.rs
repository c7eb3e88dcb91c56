//! The `umbrage` command, with the techniques that are built in.

use std::process::ExitCode;

fn main() -> ExitCode {
    umbrage_cli::run(&umbrage::Registry::default(), std::env::args_os())
}

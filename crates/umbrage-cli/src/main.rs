//! The `umbrage` command, with the techniques that are built in.

mod layers;

use std::process::ExitCode;

fn main() -> ExitCode {
    layers::without_device_chooser();
    umbrage_cli::run(&umbrage::Registry::default(), std::env::args_os())
}

//! The `umbrage` command: one file a subcommand, no algorithm. As a library it is the command of
//! whoever has techniques of their own:
//!
//! ```no_run
//! let registry = umbrage::Registry::default();
//! umbrage_cli::run(&registry, std::env::args_os());
//! ```

mod args;
mod bake;
mod bars;
mod bench;
mod compare;
mod failure;
mod info;
mod list;
mod render;
mod say;
mod sky;
mod sweep;
#[cfg(feature = "view")]
mod view;

use clap::{Parser, Subcommand};
use std::{ffi::OsString, process::ExitCode};
use umbrage::Registry;

/// Real-time shadow techniques on wgpu, each measured against ray-traced ground truth.
#[derive(Parser)]
#[command(name = "umbrage", version, arg_required_else_help = true, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  umbrage list                                        techniques, scenes, adapters
  umbrage compare primitives --techniques all -o out  a table, and out/index.html
  umbrage render atrium --technique pcf -o atrium.png
  umbrage sweep primitives                            error against cost, in out/sweep/index.html
  umbrage view primitives                             the laboratory: a window to turn, set and compare

A SCENE is the name of a built-in scene (`primitives`, `atrium:0.25` with its detail) or a file:
*.scene.toml, *.gltf, *.glb, *.obj. `umbrage COMMAND --help` shows the examples of each command.";

#[derive(Subcommand)]
enum Command {
    List(list::List),
    Info(info::Info),
    Render(render::Render),
    Compare(compare::Compare),
    Bench(bench::Bench),
    Sweep(sweep::Sweep),
    Bake(bake::Bake),
    Sky(sky::Sky),
    #[cfg(feature = "view")]
    View(view::View),
}

/// What a command works with.
struct Context<'a> {
    registry: &'a Registry,
    /// The command line, for records; the program goes by its name alone.
    line: Vec<String>,
}

/// Runs a command line, the program's name first, on the techniques of `registry`.
pub fn run(registry: &Registry, line: impl IntoIterator<Item = OsString>) -> ExitCode {
    let line: Vec<OsString> = line.into_iter().collect();
    let cli = match Cli::try_parse_from(&line) {
        Ok(cli) => cli,
        Err(error) => return failure::usage(&error),
    };
    let words = line.iter().skip(1).map(|word| word.to_string_lossy().into_owned());
    let context = Context { registry, line: std::iter::once("umbrage".into()).chain(words).collect() };
    let result = match cli.command {
        Command::List(list) => list.run(&context),
        Command::Info(info) => info.run(),
        Command::Render(render) => render.run(&context),
        Command::Compare(compare) => compare.run(&context),
        Command::Bench(bench) => bench.run(&context),
        Command::Sweep(sweep) => sweep.run(&context),
        Command::Bake(bake) => bake.run(),
        Command::Sky(sky) => sky.run(),
        #[cfg(feature = "view")]
        Command::View(view) => view.run(&context),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failure::report(&error),
    }
}

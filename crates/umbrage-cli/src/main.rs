//! The `umbrage` command: one file a subcommand, no algorithm.

mod args;
mod bars;
mod bench;
mod compare;
mod failure;
mod info;
mod list;
mod render;
mod sweep;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

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
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return failure::usage(&error),
    };
    let result = match cli.command {
        Command::List(list) => list.run(),
        Command::Info(info) => info.run(),
        Command::Render(render) => render.run(),
        Command::Compare(compare) => compare.run(),
        Command::Bench(bench) => bench.run(),
        Command::Sweep(sweep) => sweep.run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failure::report(&error),
    }
}

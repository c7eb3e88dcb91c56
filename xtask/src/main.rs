//! `cargo xtask`: the workspace's own chores. Each does its set-up itself, so that a fresh clone
//! needs Rust and git only.

mod bench;
mod bevy;
mod browser;
mod demo;
mod docs;
mod drivers;
mod fuzz;
mod gpu_day;
mod isa;
mod package;
mod portable;
mod setup;
mod shell;
mod soak;
mod tables;
mod test;
mod validation;
mod web;
mod window;

use anyhow::{Result, bail};
use std::process::ExitCode;

const USAGE: &str = "\
cargo xtask COMMAND

  setup   find a usable graphics adapter; where there is none, install Mesa's software Vulkan driver (Debian, Ubuntu)
  demo    compare the techniques on a few built-in scenes; ends in a table and out/demo/index.html
  test    run the whole test suite
  portable
          check that the library compiles for browsers, and with the oldest toolchain that is promised
  package check that a registry would take the library's crates
  browser compile every shader in Chromium, whose compiler of WGSL is another one than wgpu's, draw a picture with
          every technique there, and open the laboratory on its page
  web [--serve [PORT]]
          build the laboratory as a page, and a page for learners with each technique; writes out/web/, which any server
          of static files can hand out, and so does --serve
  window  open the laboratory on a virtual screen and use it with real keys and a real mouse (Debian, Ubuntu)
  soak MINUTES
          draw with all techniques while everything changes: memory has to stay level, and pictures right
  validation
          render with every technique, and run the library's tests, under Vulkan's validation layer; what it reports
          has to be known
  bench   measure the standard set of scenes and write benchmarks/<date>-<machine>/
  bevy    test bevy_umbrage and draw its example with shadows of its own and of Bevy, where a toolchain is new enough
  fuzz MINUTES
          read damaged files of every kind; what fails is kept in out/fuzz/
  drivers [--core] [NAME=FILE ...]
          compare all techniques, and run the library's tests, on this machine's drivers, SwiftShader, a newer Mesa, and
          drivers by their Vulkan ICD files; --core compares a few small scenes on one driver and SwiftShader
  gpu-day [--any]
          on a graphics card, in eight minutes: compare all techniques with the truth and with a software driver, run the
          library's tests, and write a benchmark; --any takes a software adapter where there is nothing else
  isa     compile every shader of every technique for two of AMD's GPUs, which need not be there, with Mesa's RADV;
          write registers, spills and throughput to benchmarks/isa/ and tell what has changed
  tables za [TECHNIQUE ...] | fe | px
          measure the tables of three theses again: filtered and soft maps (za, all or some of the techniques),
          splits (fe), wedges (px); write maps/, splits/ or loops/ there
  docs    write the generated tables of README.md and of the techniques' pages
  docs --pictures
          render the pictures of README.md again
  docs --numbers
          measure the numbers of README.md again, then write the tables";

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<()> {
    std::env::set_current_dir(shell::workspace_root()?)?;
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["setup"] => setup::run(shell::Profile::Dev).map(|_| ()),
        ["demo"] => demo::run(),
        ["test", rest @ ..] => test::run(rest),
        ["portable"] => portable::run(),
        ["package"] => package::run(),
        ["browser"] => browser::run(),
        ["web", rest @ ..] => web::run(rest),
        ["soak", minutes] => soak::run(minutes),
        ["validation"] => validation::run(),
        ["window"] => window::run(),
        ["bench"] => bench::run(),
        ["bevy"] => bevy::run(),
        ["fuzz", minutes] => fuzz::run(minutes),
        ["gpu-day"] => gpu_day::run(false),
        ["gpu-day", "--any"] => gpu_day::run(true),
        ["isa"] => isa::run(),
        ["drivers", rest @ ..] => drivers::run(rest),
        ["docs"] => docs::tables(),
        ["docs", "--pictures"] => docs::pictures(),
        ["docs", "--numbers"] => docs::numbers(),
        ["tables", "za", only @ ..] => tables::za::run(only),
        ["tables", "fe"] => tables::fe::run(),
        ["tables", "px"] => tables::px::run(),
        [] | ["help" | "-h" | "--help"] => {
            println!("{USAGE}");
            Ok(())
        }
        other => bail!("there is no `cargo xtask {}`\n\n{USAGE}", other.join(" ")),
    }
}

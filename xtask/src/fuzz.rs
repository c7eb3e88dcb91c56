//! Damaged files for a while: `crates/umbrage-io/examples/fuzz` reads them, and is started again
//! where an input has ended it.

use crate::shell::{self, Profile};
use anyhow::{Context, Result, bail};
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Where inputs that fail are kept.
const FOLDER: &str = "out/fuzz";

/// Memory that the reader may ask for, KiB: what it may hold, and as much again for what it maps.
const MOST_KIB: u32 = 2 << 20;

/// Builds, reads, and tells what was found.
pub fn run(minutes: &str) -> Result<()> {
    let minutes: f64 = minutes.parse().ok().filter(|m| *m > 0.0).context("write `cargo xtask fuzz MINUTES`")?;
    let mut build = shell::cargo();
    build.args(["build", "--package", "umbrage-io", "--example", "fuzz"]);
    shell::run(build)?;
    shell::build(Profile::Dev)?;
    let built = std::env::current_exe().context("can't find this program's own file")?;
    let built = built.parent().context("this program lies in no folder")?;
    fs::create_dir_all(FOLDER).with_context(|| format!("{FOLDER} can't be made"))?;
    let (started, mut next, mut findings) = (Instant::now(), first_input(), 0);
    let (end, first) = (started + Duration::from_secs_f64(60.0 * minutes), next);
    while Instant::now() < end {
        let left = end.saturating_duration_since(Instant::now());
        let (stopped_at, found) = read(built, left, next)?;
        findings += found;
        next = stopped_at + 1;
    }
    let seconds = started.elapsed().as_secs_f64();
    println!("{} inputs in {seconds:.0} s, {findings} findings", next - first);
    if findings > 0 {
        bail!("{findings} inputs fail: they are in {FOLDER}, each with what was found; mend the reader");
    }
    Ok(())
}

/// Each run starts at other inputs: those of a run are numbered from the second that it starts at.
fn first_input() -> u64 {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    now.map_or(0, |now| now.as_secs()) * 100_000
}

/// Reads inputs until the time is over or one of them ends the reader; returns the number of the
/// last one, and how many failed.
fn read(built: &Path, left: Duration, first: u64) -> Result<(u64, usize)> {
    let reader = built.join("examples").join(name("fuzz"));
    let limited = format!("ulimit -v {MOST_KIB} 2>/dev/null; exec \"$0\" \"$@\"");
    let mut command = match cfg!(unix) {
        true => Command::new("sh"),
        false => Command::new(&reader),
    };
    if cfg!(unix) {
        command.arg("-c").arg(limited).arg(&reader);
    }
    let seconds = format!("{:.1}", left.as_secs_f64());
    command.arg(seconds).arg(FOLDER).arg(built.join(name("umbrage"))).arg(first.to_string());
    let mut child = command.stdout(Stdio::piped()).spawn().context("the reader does not start")?;
    let (mut last, mut found, mut is_done) = (first, 0, false);
    let lines = child.stdout.take().map(|out| BufReader::new(out).lines()).into_iter().flatten();
    for line in lines.map_while(Result::ok) {
        found += usize::from(line.starts_with("found: "));
        let number = |prefix: &str| line.strip_prefix(prefix)?.split(' ').next()?.parse::<u64>().ok();
        if let Some(at) = number("stopped at ") {
            (last, is_done) = (at, true);
        }
        if let Some(count) = number("done: ") {
            (last, is_done) = (first + count.saturating_sub(1), true);
        }
        println!("{line}");
    }
    let status = child.wait().context("the reader does not end")?;
    if !is_done {
        let (number, kept) = last_input()?;
        println!("found: the reader ended with {status}: {}", kept.display());
        return Ok((number, found + 1));
    }
    Ok((last, found))
}

/// The input that the reader was at when it ended.
fn last_input() -> Result<(u64, PathBuf)> {
    let folder = Path::new(FOLDER);
    let number = fs::read_to_string(folder.join("number.txt")).context("the reader has left no input")?;
    let number: u64 = number.trim().parse().context("the reader has left no number of an input")?;
    let kept = folder.join(format!("input-{number}"));
    fs::rename(folder.join("now"), &kept).context("the last input can't be moved")?;
    Ok((number, kept))
}

fn name(program: &str) -> String {
    format!("{program}{}", std::env::consts::EXE_SUFFIX)
}

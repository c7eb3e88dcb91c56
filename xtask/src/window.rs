//! The laboratory in a real window: on a virtual screen, with real keys and a real mouse.

use crate::{setup, shell};
use anyhow::{Context, Result, bail, ensure};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// What it takes on Debian and Ubuntu: the screen, the hands, and what windows of X11 load.
const PACKAGES: [&str; 8] = [
    "xvfb",
    "xdotool",
    "libxkbcommon-x11-0",
    "libx11-xcb1",
    "libxcursor1",
    "libxi6",
    "libxrandr2",
    "mesa-vulkan-drivers",
];
/// Longest time for anything to be seen.
const LIMIT: Duration = Duration::from_secs(90);
/// A screen that nobody else has.
const SCREEN: &str = ":83";

/// Opens the laboratory and uses it: keys, a drag, sizes down to one pixel, out of sight and back.
pub fn run() -> Result<()> {
    install()?;
    shell::build_tests()?;
    let folder = std::env::current_dir()?.join("out").join("window");
    if folder.exists() {
        std::fs::remove_dir_all(&folder)?;
    }
    std::fs::create_dir_all(&folder)?;
    let _screen = Running(start(Command::new("Xvfb").args([SCREEN, "-screen", "0", "1280x800x24"]))?);
    let program =
        shell::tested_umbrage(&["view", "contact:0.2", "--technique", "shadow-map", "--adapter", "software"])?;
    let mut window = Running(open(program, &folder)?);
    let id = wait("the window", || hands(&["search", "--name", "umbrage"]).ok().filter(|id| !id.is_empty()))?;
    let id = id.lines().next().unwrap_or_default().to_string();
    focus(&id)?;
    hands(&["mousemove", "600", "400"])?;
    use_it(&id)?;
    // The next technique has to be the one that the snapshot is of.
    let taken = snapshot(&folder, "shadow-map")?;
    hands(&["key", "space"])?;
    let next = snapshot(&folder, "")?;
    ensure!(taken != next, "Space did not choose the next technique");
    hands(&["key", "Escape"])?;
    let status = wait("the end", || window.0.try_wait().ok().flatten())?;
    ensure!(status.success(), "the window ended with {status}");
    println!("the window took keys and mouse, sizes and a snapshot: {next}");
    Ok(())
}

/// Drags, resizes, hides and shows.
fn use_it(id: &str) -> Result<()> {
    hands(&["mousedown", "1"])?;
    for _ in 0..4 {
        hands(&["mousemove_relative", "20", "5"])?;
        sleep(Duration::from_millis(50));
    }
    hands(&["mouseup", "1"])?;
    for size in [["1", "1"], ["300", "200"], ["1200", "760"]] {
        hands(&["windowsize", id, size[0], size[1]])?;
        sleep(Duration::from_millis(300));
    }
    hands(&["windowunmap", id])?;
    sleep(Duration::from_millis(300));
    hands(&["windowmap", id])?;
    focus(id)?;
    hands(&["mousemove", "600", "400"]).map(|_| ())
}

/// Gives the window the keys, once it is on the screen.
fn focus(id: &str) -> Result<()> {
    wait("the window on the screen", || hands(&["windowfocus", id]).ok()).map(|_| ())
}

/// Takes a snapshot and returns its name, which begins with `technique`.
fn snapshot(folder: &Path, technique: &str) -> Result<String> {
    let files = || -> Vec<String> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
    };
    let before = files();
    let start = Instant::now();
    while start.elapsed() < LIMIT {
        hands(&["key", "ctrl+s"])?;
        sleep(Duration::from_millis(700));
        if let Some(new) = files().into_iter().find(|f| !before.contains(f) && f.starts_with(technique)) {
            return Ok(new);
        }
    }
    bail!("Ctrl+S wrote no snapshot within {LIMIT:?}")
}

/// Installs what is missing, where one command does.
fn install() -> Result<()> {
    let is_there = |program: &str| Command::new(program).arg("-help").output().is_ok();
    if is_there("Xvfb") && is_there("xdotool") {
        return Ok(());
    }
    ensure!(setup::is_debian(), "this needs Xvfb and xdotool: install them, then run this again");
    shell::run(setup::apt(&["update"]))?;
    shell::run(setup::apt(&[&["install", "--yes", "--no-install-recommends"], &PACKAGES[..]].concat()))
}

/// A program that ends with this value.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // One that has ended already can't be ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn start(command: &mut Command) -> Result<Child> {
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().with_context(|| format!("can't run {}", command.get_program().to_string_lossy()))
}

fn open(mut program: Command, folder: &Path) -> Result<Child> {
    // The screen takes a moment to come up.
    wait("the virtual screen", || hands(&["getmouselocation"]).ok())?;
    program.env("DISPLAY", SCREEN).env_remove("WAYLAND_DISPLAY").current_dir(folder);
    program.spawn().context("can't run umbrage")
}

/// Has `xdotool` do something; what it prints.
fn hands(arguments: &[&str]) -> Result<String> {
    let output =
        Command::new("xdotool").args(arguments).env("DISPLAY", SCREEN).output().context("can't run xdotool")?;
    ensure!(output.status.success(), "xdotool {}: {}", arguments.join(" "), String::from_utf8_lossy(&output.stderr));
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_string())
}

/// Asks again and again.
fn wait<T>(what: &str, mut ask: impl FnMut() -> Option<T>) -> Result<T> {
    let start = Instant::now();
    loop {
        if let Some(found) = ask() {
            return Ok(found);
        }
        ensure!(start.elapsed() < LIMIT, "{what} did not come within {LIMIT:?}");
        sleep(Duration::from_millis(100));
    }
}

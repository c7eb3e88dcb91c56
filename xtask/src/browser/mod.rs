//! Every shader, and a picture with every technique, in a real browser: Chromium's compiler of
//! WGSL, Tint, is another one than wgpu's, and so is what checks and runs the commands.

mod laboratory;
mod pictures;

pub use pictures::binder;

use crate::shell;
use anyhow::{Context, Result, bail, ensure};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::{fs, sync::mpsc, thread, time::Duration};

const FOLDER: &str = "target/browser";
const PAGE: &str = include_str!("shaders.html");

/// Names under which Chromium is found.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// WebGPU without a desktop and without a graphics card.
const FLAGS: [&str; 10] = [
    "--headless=new",
    "--no-sandbox",
    "--no-first-run",
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
    "--enable-features=Vulkan",
    "--use-vulkan=swiftshader",
    "--use-angle=swiftshader",
    "--disable-vulkan-surface",
    "--enable-logging=stderr",
];

/// Time that a page may say nothing.
const PATIENCE: Duration = Duration::from_secs(300);

/// Makes every shader module, and every compute pipeline, in Chromium, and fails where one fails or
/// comes with a warning; then draws a picture with every technique there, and opens the laboratory
/// on its page. Where there is no Chromium it says so.
pub fn run() -> Result<()> {
    let Some(browser) = BROWSERS.into_iter().find(|name| starts(name)) else {
        println!("nothing was checked, since there is no Chromium: {}", BROWSERS.join(", "));
        return Ok(());
    };
    fs::create_dir_all(FOLDER)?;
    let folder = fs::canonicalize(FOLDER)?;
    let sources = folder.join("wgsl");
    if sources.exists() {
        fs::remove_dir_all(&sources)?;
    }
    let mut write = shell::cargo();
    write.args(["run", "--quiet", "--package", "umbrage-renderer", "--example", "wgsl", "--"]).arg(&sources);
    shell::run(write)?;
    let page = folder.join("shaders.html");
    fs::write(&page, PAGE.replace("SHADERS", &pairs(&sources)?))?;
    report(&said_by(browser, &folder, &format!("file://{}", page.display()))?)?;
    pictures::run(browser, &folder)?;
    laboratory::run(browser, &folder)
}

/// What a page says in the browser.
fn said_by(browser: &str, folder: &Path, page: &str) -> Result<Vec<String>> {
    let mut command = Command::new(browser);
    command.args(FLAGS).arg(format!("--user-data-dir={}", folder.join("profile").display()));
    command.arg(page).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().with_context(|| format!("can't start {browser}"))?;
    let found = listen(&mut child);
    child.kill()?;
    child.wait()?;
    found
}

fn starts(program: &str) -> bool {
    let mut asked = Command::new(program);
    asked.arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

/// The shaders as JSON that may stand in a page.
fn pairs(folder: &Path) -> Result<String> {
    let mut files: Vec<_> = fs::read_dir(folder)?.collect::<Result<_, _>>()?;
    files.sort_by_key(|file| file.file_name());
    let pair = |file: &fs::DirEntry| {
        let name = file.path().file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok(serde_json::json!([name, fs::read_to_string(file.path())?]))
    };
    let all: Vec<serde_json::Value> = files.iter().map(pair).collect::<Result<_>>()?;
    ensure!(!all.is_empty(), "there is no shader in {}", folder.display());
    Ok(serde_json::to_string(&all)?.replace("</", "<\\/"))
}

/// What the page says until its end.
fn listen(child: &mut Child) -> Result<Vec<String>> {
    let stderr = child.stderr.take().context("the browser has no standard error")?;
    let (sender, lines) = mpsc::channel();
    thread::spawn(move || {
        let says = |line: String| Some(line.split_once("umbrage: ")?.1.rsplit_once("\", source:")?.0.to_string());
        // Nobody listens any more once the end has come.
        BufReader::new(stderr).lines().map_while(Result::ok).filter_map(says).all(|line| sender.send(line).is_ok())
    });
    let mut found = Vec::new();
    loop {
        match lines.recv_timeout(PATIENCE) {
            Ok(line) if line == "end" => return Ok(found),
            Ok(line) => found.push(line),
            Err(_) => bail!("the browser said nothing more after {found:?}"),
        }
    }
}

fn report(found: &[String]) -> Result<()> {
    found.iter().for_each(|line| println!("{line}"));
    let wrong = found.iter().filter(|line| line.starts_with("error") || line.starts_with("warning")).count();
    ensure!(wrong == 0, "the browser has {wrong} complaints about shaders");
    ensure!(found.iter().any(|line| line.starts_with("checked")), "the page did not reach its end");
    Ok(())
}

//! The laboratory as a page: static files that any server can hand out.

mod serve;
mod tours;

use crate::{browser, shell};
use anyhow::{Context, Result, bail, ensure};
use flate2::{Compression, write::GzEncoder};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::{env, fs};

pub use serve::Server;

/// Where the files lie.
pub const OUT: &str = "out/web";
const TARGET: &str = "wasm32-unknown-unknown";
/// The program that is built, and the cargo profile that makes it small.
const PROGRAM: &str = "umbrage-page";
const PROFILE: &str = "web";
/// Apart from what is built for this machine, so that neither waits for the other.
const BUILT: &str = "target/web";
/// The page, beside the code that starts in it.
const PAGE: &str = "crates/umbrage-viewer/index.html";
/// Where `--serve` listens, unless another one is asked for.
const PORT: u16 = 8000;

/// Size of the program as servers send it, bytes, at most.
const MOST_BYTES: usize = 8 << 20;

/// Builds the page, and with `--serve [PORT]` hands it out.
pub fn run(arguments: &[&str]) -> Result<()> {
    let port = match *arguments {
        [] => None,
        ["--serve"] => Some(PORT),
        ["--serve", port] => Some(port.parse().with_context(|| format!("`{port}` is no port"))?),
        _ => bail!("write `cargo xtask web`, or `cargo xtask web --serve [PORT]`"),
    };
    build()?;
    let Some(port) = port else {
        println!("any server of static files can hand {OUT} out, such as `cargo xtask web --serve`");
        return Ok(());
    };
    let server = Server::open(Path::new(OUT), port)?;
    println!("http://localhost:{}/ (Ctrl+C ends it)", server.port());
    server.run();
    Ok(())
}

/// Writes the files.
pub fn build() -> Result<()> {
    let mut target = Command::new("rustup");
    target.args(["target", "add", TARGET]);
    shell::run(target)?;
    let mut build = shell::cargo();
    build.args(["build", "--package", "umbrage-viewer", "--bin", PROGRAM, "--no-default-features"]);
    build.args(["--features", "page", "--profile", PROFILE, "--target", TARGET, "--target-dir", BUILT]);
    shell::run(build)?;
    let program = Path::new(BUILT).join(TARGET).join(PROFILE).join(format!("{PROGRAM}.wasm"));
    fs::create_dir_all(OUT).with_context(|| format!("can't make {OUT}"))?;
    let mut bind = Command::new(browser::binder(Path::new("target/tools"))?);
    bind.args(["--target", "web", "--no-typescript", "--out-name", "umbrage", "--out-dir", OUT]).arg(program);
    shell::run(bind)?;
    let program = Path::new(OUT).join("umbrage_bg.wasm");
    shrink(&program)?;
    fs::copy(PAGE, Path::new(OUT).join("index.html")).with_context(|| format!("can't copy {PAGE}"))?;
    let pages = tours::write(Path::new(OUT))?;
    let bytes = compressed(&program)?;
    println!("{OUT}: the laboratory, {:.1} MiB compressed, and {pages} pages for learners", megabytes(bytes));
    let most = megabytes(MOST_BYTES);
    ensure!(bytes <= MOST_BYTES, "the program has {:.1} MiB compressed, more than {most}", megabytes(bytes));
    Ok(())
}

fn megabytes(bytes: usize) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

/// Has Binaryen make the program smaller, where it is installed.
fn shrink(program: &Path) -> Result<()> {
    let mut asked = Command::new("wasm-opt");
    let is_there = asked.arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok();
    if !is_there || env::var_os("UMBRAGE_NO_WASM_OPT").is_some() {
        return Ok(());
    }
    let mut shrink = Command::new("wasm-opt");
    shrink.args(["-Oz", "--all-features", "-o"]).arg(program).arg(program);
    shell::run(shrink)
}

/// Size of a file as servers send it, bytes.
fn compressed(file: &Path) -> Result<usize> {
    let bytes = fs::read(file).with_context(|| format!("can't read {}", file.display()))?;
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(&bytes)?;
    Ok(encoder.finish()?.len())
}

//! Every technique on several drivers: what is right on one has to be right on all.

use crate::{
    setup,
    shell::{self, Profile},
};
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::Command,
    time::Instant,
};

/// Where drivers are unpacked and results are written.
const FOLDER: &str = "target/drivers";

/// The Debian package that holds a software Vulkan driver which shares no code with Mesa's.
const PACKAGE: &str = "chromium-common";
const SWIFTSHADER_NAME: &str = "swiftshader";
const SWIFTSHADER: &str = "usr/lib/chromium/libvk_swiftshader.so";

/// How much less of the interior may be right than on the first driver, per cent.
const TOLERANCE: f64 = 0.05;

/// How much is compared.
struct Matrix {
    scenes: &'static [&'static str],
    size: &'static str,
}

/// What runs with every change: point, sphere and spot lights, large casters near a lamp, an open
/// view.
const CORE: Matrix = Matrix { scenes: &["primitives", "lantern"], size: "160x120" };

const WHOLE: Matrix = Matrix {
    scenes: &[
        "primitives",
        "lantern",
        "contact",
        "overlap",
        "picket-fence",
        "duelling-frusta",
        "atrium:0.25",
        "city:0.25",
        "terrain:0.25",
    ],
    size: "320x240",
};

/// A driver: the one that is there, or another by the file that describes it to the Vulkan loader.
struct Driver {
    name: String,
    description: Option<PathBuf>,
}

/// Compares all techniques on the machine's own driver, on SwiftShader, and on those of `arguments`
/// (`NAME=FILE`, a driver's JSON file); with `--core` on a few small scenes only.
pub fn run(arguments: &[&str]) -> Result<()> {
    let is_core = arguments.contains(&"--core");
    let matrix = if is_core { CORE } else { WHOLE };
    setup::run(Profile::Dev)?;
    let mut drivers = vec![Driver { name: "default".into(), description: None }];
    match swiftshader()? {
        Some(file) => drivers.push(Driver { name: SWIFTSHADER_NAME.into(), description: Some(file) }),
        None => println!("SwiftShader was not run: it is unpacked from a package of Debian, {PACKAGE}"),
    }
    for argument in arguments.iter().filter(|a| **a != "--core") {
        let (name, file) = argument
            .split_once('=')
            .with_context(|| format!("`{argument}` is no driver: give NAME=FILE, FILE being its Vulkan ICD file"))?;
        let file = fs::canonicalize(file).with_context(|| format!("can't find the driver file {file}"))?;
        drivers.push(Driver { name: name.into(), description: Some(file) });
    }
    let results = drivers.iter().map(|driver| driver.measure(&matrix)).collect::<Result<Vec<_>>>()?;
    let (first, others) = results.split_first().context("there is no driver")?;
    let wrong: usize = others.iter().map(|other| other.show_against(first)).sum();
    if wrong > 0 {
        bail!("{wrong} cells are worse than on {}", first.name);
    }
    println!("\nall techniques are as right on all drivers");
    Ok(())
}

/// Unpacks SwiftShader, and returns the file that describes it; `None` where there are no packages
/// of Debian.
fn swiftshader() -> Result<Option<PathBuf>> {
    if !setup::is_debian() {
        return Ok(None);
    }
    let folder = std::env::current_dir().context("there is no current folder")?.join(FOLDER);
    let library = folder.join(SWIFTSHADER);
    if !library.is_file() {
        fs::create_dir_all(&folder).with_context(|| format!("can't create {FOLDER}"))?;
        let download = || {
            let mut command = Command::new("apt-get");
            command.args(["download", PACKAGE]).current_dir(&folder);
            shell::run(command)
        };
        if download().is_err() {
            shell::run(setup::apt(&["update"]))?;
            download()?;
        }
        let mut unpack = Command::new("dpkg-deb");
        unpack.arg("--extract").arg(package_in(&folder)?).arg(&folder);
        shell::run(unpack)?;
    }
    let description = folder.join("swiftshader.json");
    let content = serde_json::json!({
        "file_format_version": "1.0.0",
        "ICD": { "library_path": library, "api_version": "1.1.0" },
    });
    fs::write(&description, content.to_string()).context("can't write SwiftShader's description")?;
    Ok(Some(description))
}

/// The package that was downloaded last.
fn package_in(folder: &Path) -> Result<PathBuf> {
    let files = fs::read_dir(folder).with_context(|| format!("can't read {}", folder.display()))?;
    let packages = files.flatten().map(|entry| entry.path()).filter(|p| p.extension().is_some_and(|e| e == "deb"));
    packages.max().with_context(|| format!("{PACKAGE} was downloaded, yet there is no package in {FOLDER}"))
}

/// Scene, light, and technique with its settings.
type Cell = (String, u64, String);

/// What a driver gave.
struct Results {
    name: String,
    adapter: String,
    /// The share of the interior that is right, per cent; or why there is none.
    cells: BTreeMap<Cell, Result<f64, String>>,
    seconds: f64,
}

impl Driver {
    fn measure(&self, matrix: &Matrix) -> Result<Results> {
        let out = format!("{FOLDER}/{}", self.name);
        let mut arguments = vec!["compare"];
        arguments.extend(matrix.scenes);
        arguments.extend(["--techniques", "all", "--samples", "16", "--size", matrix.size, "--frames", "1"]);
        let truth = format!("{FOLDER}/truth");
        arguments.extend(["--truth-cache", &truth, "-o", &out, "--json"]);
        let mut command = shell::umbrage(Profile::Dev, &arguments);
        if let Some(file) = &self.description {
            command.env("VK_ICD_FILENAMES", file).env("VK_DRIVER_FILES", file);
        }
        let start = Instant::now();
        let report: Value =
            serde_json::from_str(&shell::output(command)?).context("`compare --json` printed no JSON")?;
        let adapter = report["made"]["adapter"]["name"].as_str().unwrap_or("?").to_string();
        if self.name == SWIFTSHADER_NAME && !adapter.contains("SwiftShader") {
            bail!("SwiftShader was asked for, yet {adapter} was measured");
        }
        let cells = cells(&report);
        if cells.is_empty() {
            bail!("{} ({adapter}) gave no result", self.name);
        }
        Ok(Results { name: self.name.clone(), adapter, cells, seconds: start.elapsed().as_secs_f64() })
    }
}

/// The results in a report.
fn cells(report: &Value) -> BTreeMap<Cell, Result<f64, String>> {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let mut cells = BTreeMap::new();
    for scene in list(&report["scenes"]) {
        for light in list(&scene["lights"]) {
            for result in list(&light["results"]) {
                let name = |value: &Value| value.as_str().unwrap_or("?").to_string();
                if result["status"] == "unsupported" {
                    continue;
                }
                let interior = result["scores"]["interior_pct"].as_f64();
                let value = interior.ok_or_else(|| format!("{} {}", name(&result["status"]), name(&result["reason"])));
                let cell = (name(&scene["source"]), light["light"].as_u64().unwrap_or(0), name(&result["technique"]));
                cells.insert(cell, value);
            }
        }
    }
    cells
}

impl Results {
    /// Prints what is worse here than there, and returns how much that is.
    fn show_against(&self, first: &Self) -> usize {
        println!(
            "\n{} ({}), {:.0} s, against {} ({}), {:.0} s:",
            self.name, self.adapter, self.seconds, first.name, first.adapter, first.seconds
        );
        let mut wrong = 0;
        let mut largest: f64 = 0.0;
        for (cell, expected) in &first.cells {
            let here = self.cells.get(cell);
            let text = match (expected, here) {
                (_, None) => "missing".to_string(),
                (Ok(expected), Some(Ok(value))) => {
                    largest = largest.max(expected - value);
                    if expected - value <= TOLERANCE {
                        continue;
                    }
                    format!("{value:.2} % of the interior is right, there {expected:.2} %")
                }
                (Ok(_), Some(Err(reason))) => reason.clone(),
                (Err(reason), Some(_)) => format!("failed on {}, too: {reason}", first.name),
            };
            wrong += 1;
            println!("  {} light {}: {}: {text}", cell.0, cell.1, cell.2);
        }
        println!(
            "  {} cells, {wrong} worse; the largest difference is {largest:.3} points of the interior",
            first.cells.len()
        );
        wrong
    }
}

//! Every technique on several drivers: what is right on one has to be right on all.

mod driver;
mod packages;
mod results;

use crate::{setup, shell};
use anyhow::{Context, Result, bail};
use driver::{Driver, Matrix};
use serde_json::Value;
use std::fs;

/// Where drivers are unpacked and results are written.
const FOLDER: &str = "target/drivers";

/// What runs with every change: point, sphere and spot lights, large casters near a lamp, an open
/// view.
const CORE: Matrix = Matrix { scenes: &["primitives", "lantern"], size: "160x120", tests: false };

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
    tests: true,
};

/// What fits in the minutes for which a graphics card may be there.
const CARD: Matrix =
    Matrix { scenes: &["primitives", "lantern", "contact", "picket-fence", "city:0.25"], size: "320x240", tests: true };

/// Compares all techniques on the machine's own driver, on SwiftShader, and on those of `arguments`
/// (`NAME=FILE`, a driver's JSON file); with `--core` on a few small scenes only, and otherwise on
/// all other adapters and on a newer Mesa, too, with the tests of the library.
pub fn run(arguments: &[&str]) -> Result<()> {
    let is_core = arguments.contains(&"--core");
    let matrix = if is_core { CORE } else { WHOLE };
    shell::build_tests()?;
    setup::run_tested()?;
    let mut drivers = vec![Driver::installed()];
    if !is_core {
        drivers.extend(other_adapters()?);
    }
    drivers.extend(unpacked(is_core)?);
    for argument in arguments.iter().filter(|a| **a != "--core") {
        let (name, file) = argument
            .split_once('=')
            .with_context(|| format!("`{argument}` is no driver: give NAME=FILE, FILE being its Vulkan ICD file"))?;
        let file = fs::canonicalize(file).with_context(|| format!("can't find the driver file {file}"))?;
        drivers.push(Driver::described(name, file));
    }
    compare(&drivers, &matrix)
}

/// The adapter of this number against that of a software driver, where there is one.
pub fn card(card: u32, software: Option<u32>) -> Result<()> {
    let drivers: Vec<_> = software.into_iter().chain([card]).map(Driver::adapter).collect();
    compare(&drivers, &CARD)
}

/// Measures all of them and shows what is worse than on the first.
fn compare(drivers: &[Driver], matrix: &Matrix) -> Result<()> {
    let results = drivers.iter().map(|driver| driver.measure(matrix, FOLDER)).collect::<Result<Vec<_>>>()?;
    let (first, others) = results.split_first().context("there is no driver")?;
    let wrong: usize = others.iter().map(|other| other.show_against(first)).sum();
    println!("\n{}", results::heading());
    results.iter().for_each(|driver| println!("{}", driver.row()));
    let broken = first.cells.values().filter(|cell| cell.is_err()).count();
    let failed = first.failed_tests.as_ref().map_or(0, Vec::len);
    if wrong + broken + failed > 0 {
        bail!("{wrong} cells or tests are worse than on {}, where {broken} cells and {failed} tests fail", first.name);
    }
    if others.is_empty() {
        println!("\nthere is one driver only, so nothing was compared");
        return Ok(());
    }
    println!("\nall techniques are as right on all drivers");
    Ok(())
}

/// The drivers that come in packages.
fn unpacked(is_core: bool) -> Result<Vec<Driver>> {
    if !setup::is_debian() {
        println!("SwiftShader and a newer Mesa were not run: they are unpacked from packages of Debian");
        return Ok(Vec::new());
    }
    let folder = std::env::current_dir().context("there is no current folder")?.join(FOLDER);
    let mut drivers = vec![Driver::unpacked("swiftshader", "SwiftShader", packages::swiftshader(&folder)?)];
    if !is_core {
        match packages::newer_mesa(&folder) {
            Ok(found) => drivers.push(Driver::unpacked("newer-mesa", "llvmpipe", found)),
            Err(error) => println!("a newer Mesa was not run: {error:#}"),
        }
    }
    Ok(drivers)
}

/// All adapters but the first, which is what the command takes by itself. Those that can't do the
/// work, such as those of OpenGL, are named with the reason.
fn other_adapters() -> Result<Vec<Driver>> {
    let list = shell::output(shell::tested_umbrage(&["list", "--json"])?)?;
    let list: Value = serde_json::from_str(&list).context("`umbrage list --json` printed no JSON")?;
    let adapters = list["adapters"].as_array().context("`umbrage list --json` has no list of adapters")?;
    let name = |adapter: &Value| adapter["name"].as_str().unwrap_or("?").to_string();
    for adapter in adapters {
        if let Some(reason) = adapter["unusable"].as_str() {
            println!("{} ({}) was not run: {reason}", name(adapter), adapter["backend"].as_str().unwrap_or("?"));
        }
    }
    let usable = (0..).zip(adapters).filter(|(_, adapter)| adapter["unusable"].is_null());
    // By their numbers, since one that is found through two systems has one name.
    Ok(usable.skip(1).map(|(number, _): (u32, _)| Driver::adapter(number)).collect())
}

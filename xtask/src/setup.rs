//! Finds a usable graphics adapter, or installs a software one where that is a matter of one
//! command.

use crate::shell::{self, Profile};
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::{fs, path::Path, process::Command};

/// Ends with a usable adapter, or with an error that says what to install. Tells whether there is
/// only a software adapter.
pub fn run(profile: Profile) -> Result<bool> {
    shell::build(profile)?;
    find_or_install(&|| Ok(shell::umbrage(profile, &LIST)))
}

/// The same with the command that the tests have built.
pub fn run_tested() -> Result<bool> {
    find_or_install(&|| shell::tested_umbrage(&LIST))
}

/// What to ask the command for the adapters.
const LIST: [&str; 2] = ["list", "--json"];

fn find_or_install(list: &dyn Fn() -> Result<Command>) -> Result<bool> {
    if let Some(found) = adapters(list()?)? {
        return Ok(found.show());
    }
    if !is_debian() {
        bail!("no usable graphics adapter: {}", remedy());
    }
    println!("no usable graphics adapter: installing Mesa's software Vulkan driver");
    shell::run(apt(&["update"]))?;
    shell::run(apt(&["install", "--yes", "--no-install-recommends", "mesa-vulkan-drivers", "libvulkan1"]))?;
    let found = adapters(list()?)?.context("Mesa is installed, yet there is still no usable graphics adapter")?;
    Ok(found.show())
}

/// The usable adapters.
struct Found {
    names: String,
    is_software: bool,
}

impl Found {
    fn show(&self) -> bool {
        println!("graphics adapters: {}", self.names);
        self.is_software
    }
}

/// The usable adapters that `umbrage` sees; `None` where there is none.
fn adapters(list: Command) -> Result<Option<Found>> {
    let json: Value = serde_json::from_str(&shell::output(list)?).context("`umbrage list --json` printed no JSON")?;
    let list = json["adapters"].as_array().context("`umbrage list --json` has no list of adapters")?;
    let usable = |a: &&Value| a["unusable"].is_null();
    let list: Vec<&Value> = list.iter().filter(usable).collect();
    let name = |a: &&Value| format!("{} ({})", a["name"].as_str().unwrap_or("?"), a["kind"].as_str().unwrap_or("?"));
    let names = list.iter().map(name).collect::<Vec<_>>().join(", ");
    let is_software = list.iter().all(|a| a["kind"] == "software");
    Ok((!list.is_empty()).then_some(Found { names, is_software }))
}

/// True on Debian, Ubuntu and what derives from them.
pub fn is_debian() -> bool {
    Path::new("/etc/debian_version").exists() && Path::new("/usr/bin/apt-get").exists()
}

/// `apt-get`, as root.
pub fn apt(arguments: &[&str]) -> Command {
    // The owner of one's own process folder is who one is.
    let root = fs::metadata("/proc/self").is_ok_and(|m| owner(&m) == 0);
    let mut command = Command::new(if root { "apt-get" } else { "sudo" });
    if !root {
        command.arg("apt-get");
    }
    command.args(arguments).env("DEBIAN_FRONTEND", "noninteractive");
    command
}

#[cfg(unix)]
fn owner(metadata: &fs::Metadata) -> u32 {
    std::os::unix::fs::MetadataExt::uid(metadata)
}

#[cfg(not(unix))]
fn owner(_: &fs::Metadata) -> u32 {
    u32::MAX
}

fn remedy() -> &'static str {
    if cfg!(target_os = "linux") {
        "install a Vulkan driver and loader (Fedora: mesa-vulkan-drivers vulkan-loader; Arch: vulkan-swrast; \
         openSUSE: libvulkan_lvp), then run this again"
    } else if cfg!(target_os = "windows") {
        "install your graphics card's driver (DirectX 12 or Vulkan), then run this again"
    } else if cfg!(target_os = "macos") {
        "Metal needs macOS 10.15 or newer on a Mac with a Metal graphics processor"
    } else {
        "install a Vulkan driver for this system, then run this again"
    }
}

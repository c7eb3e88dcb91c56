//! Software drivers from packages of Debian, unpacked beside those that are installed.

use crate::{setup, shell};
use anyhow::{Context, Result, bail};
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// A driver that was unpacked.
pub struct Unpacked {
    /// What tells the Vulkan loader of it.
    pub description: PathBuf,
    /// Where the libraries that it needs lie.
    pub libraries: PathBuf,
    /// What it is, in the file's own name: package and version.
    pub package: String,
}

/// Chromium's software driver, which shares no code with Mesa's.
pub fn swiftshader(folder: &Path) -> Result<Unpacked> {
    let folder = &folder.join("swiftshader");
    let library = "usr/lib/chromium/libvk_swiftshader.so";
    let download = || {
        let mut command = Command::new("apt-get");
        command.args(["download", "chromium-common"]).current_dir(folder);
        shell::run(command)
    };
    unpack(folder, library, &|| {
        download().or_else(|_| {
            shell::run(setup::apt(&["update"]))?;
            download()
        })
    })
}

/// Mesa's software driver of the release's backports suite.
pub fn newer_mesa(folder: &Path) -> Result<Unpacked> {
    let folder = &folder.join("newer-mesa");
    let library = "usr/lib/x86_64-linux-gnu/libvulkan_lvp.so";
    unpack(folder, library, &|| {
        let suite = format!("{}-backports", codename()?);
        let lists = folder.join("lists");
        fs::create_dir_all(&lists).context("can't create a folder for lists of packages")?;
        let source = folder.join("backports.list");
        fs::write(&source, format!("deb {} {suite} main\n", mirror()?))
            .context("can't write the source of packages")?;
        let of_suite = |arguments: &[&str]| {
            let mut command = Command::new("apt-get");
            command.arg("-o").arg(format!("Dir::Etc::sourcelist={}", source.display()));
            command.args(["-o", "Dir::Etc::sourceparts=-", "-o"]).arg(format!("Dir::State::lists={}", lists.display()));
            command.args(arguments).current_dir(folder);
            shell::run(command)
        };
        of_suite(&["update"])?;
        let packages = ["mesa-vulkan-drivers", "libdrm2", "libdrm-amdgpu1"].map(|name| format!("{name}/{suite}"));
        of_suite(&[&["download"][..], &packages.each_ref().map(String::as_str)].concat())
    })
}

/// Downloads packages into `folder` where the library is not there yet, extracts them, and writes
/// what tells the loader of it.
fn unpack(folder: &Path, library: &str, download: &dyn Fn() -> Result<()>) -> Result<Unpacked> {
    fs::create_dir_all(folder).with_context(|| format!("can't create {}", folder.display()))?;
    let path = folder.join(library);
    if !path.is_file() {
        download()?;
        for package in packages_in(folder)? {
            let mut extract = Command::new("dpkg-deb");
            extract.arg("--extract").arg(package).arg(folder);
            shell::run(extract)?;
        }
    }
    if !path.is_file() {
        bail!("the packages in {} have no {library}", folder.display());
    }
    let description = folder.join("driver.json");
    let content = serde_json::json!({
        "file_format_version": "1.0.0",
        "ICD": { "library_path": path, "api_version": "1.1.0" },
    });
    fs::write(&description, content.to_string()).context("can't write the description of a driver")?;
    let largest = packages_in(folder)?.into_iter().max_by_key(|p| fs::metadata(p).map_or(0, |m| m.len()));
    let package = largest.as_deref().and_then(Path::file_stem).map(|stem| stem.to_string_lossy().into_owned());
    let libraries = path.parent().context("a library lies in no folder")?.to_path_buf();
    Ok(Unpacked { description, libraries, package: package.unwrap_or_default() })
}

fn packages_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let files = fs::read_dir(folder).with_context(|| format!("can't read {}", folder.display()))?;
    Ok(files.flatten().map(|entry| entry.path()).filter(|p| p.extension().is_some_and(|e| e == "deb")).collect())
}

/// The release's name, such as `bookworm`.
fn codename() -> Result<String> {
    let text = fs::read_to_string("/etc/os-release").context("can't read /etc/os-release")?;
    let line = text.lines().find_map(|line| line.strip_prefix("VERSION_CODENAME="));
    Ok(line.context("/etc/os-release names no release")?.trim_matches('"').to_string())
}

/// Where this machine has the packages of its release from.
fn mirror() -> Result<String> {
    let mut command = Command::new("apt-get");
    command.args(["indextargets", "--format", "$(RELEASE) $(REPO_URI)", "Created-By: Packages"]);
    let (list, release) = (shell::output(command)?, codename()?);
    let mirror = list.lines().find_map(|line| line.split_once(' ').filter(|(r, _)| *r == release));
    Ok(mirror.context("apt-get knows of no place that has this release")?.1.to_string())
}

//! What shaders cost on GPUs that need not be there: `isa/` compiles them with Mesa's RADV, and
//! what it finds is kept under `benchmarks/isa/` and compared with what lay there.

use crate::shell;
use anyhow::{Context, Result, bail};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

const FOLDER: &str = "benchmarks/isa";

/// RDNA 2 and RDNA 3.
const FAMILIES: [&str; 2] = ["navi21", "gfx1100"];

/// Where distributions put the files that name Vulkan's drivers.
const DRIVERS: [&str; 2] = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"];

/// Waves a SIMD that a shader has to leave room for.
const FEWEST_WAVES: u32 = 8;

/// A shader's numbers by the names of their columns.
type Row = BTreeMap<String, String>;

/// Compiles for each family, tells what has changed, and fails where a shader spills or leaves too
/// little room at a technique's defaults.
pub fn run() -> Result<()> {
    let drivers = [driver("lvp")?, driver("radeon")?].join(":");
    let mut faults = Vec::new();
    for family in FAMILIES {
        let mut compile = shell::cargo();
        compile.args(["run", "--manifest-path", "isa/Cargo.toml", "--target-dir", "target/isa"]);
        compile.env("VK_ICD_FILENAMES", &drivers).env("RADV_FORCE_FAMILY", family).env("NODEVICE_SELECT", "1");
        let new = shell::output(compile)?;
        let path = format!("{FOLDER}/{family}.csv");
        let rows = rows(&new);
        let old = fs::read_to_string(&path).map(|text| self::rows(&text)).unwrap_or_default();
        println!("{family}: {} shaders", rows.len());
        tell_changes(&old, &rows);
        faults.extend(rows.iter().filter_map(|row| fault(row).map(|fault| format!("{family}: {fault}"))));
        fs::create_dir_all(FOLDER).with_context(|| format!("can't make {FOLDER}"))?;
        fs::write(&path, new).with_context(|| format!("can't write {path}"))?;
    }
    if !faults.is_empty() {
        bail!("these shaders spill, or leave room for fewer than {FEWEST_WAVES} waves:\n{}", faults.join("\n"));
    }
    Ok(())
}

/// The file that names a driver of Mesa's.
fn driver(name: &str) -> Result<String> {
    let files = DRIVERS.iter().filter_map(|folder| fs::read_dir(Path::new(folder)).ok()).flatten().flatten();
    let paths = files.map(|file| file.path().display().to_string());
    let is_it = |path: &String| path.rsplit('/').next().is_some_and(|file| file.starts_with(&format!("{name}_icd")));
    let found = paths.into_iter().find(is_it);
    found.with_context(|| {
        format!("no `{name}_icd.*.json` in {}: install Mesa's Vulkan drivers (mesa-vulkan-drivers)", DRIVERS.join(", "))
    })
}

/// The lines of a table. Shaders' names are quoted, since some have commas.
fn rows(csv: &str) -> Vec<Row> {
    let mut lines = csv.lines();
    let names: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    lines.map(|line| names.iter().map(|name| name.to_string()).zip(fields(line)).collect()).collect()
}

fn fields(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    let mut is_quoted = false;
    for character in line.chars() {
        match (character, fields.last_mut()) {
            ('"', _) => is_quoted = !is_quoted,
            (',', _) if !is_quoted => fields.push(String::new()),
            (other, Some(field)) => field.push(other),
            (_, None) => {}
        }
    }
    fields
}

fn number(row: &Row, column: &str) -> u32 {
    row.get(column).and_then(|text| text.parse().ok()).unwrap_or(0)
}

fn name(row: &Row) -> String {
    let part = |column| row.get(column).map_or("", String::as_str);
    let parts = [part("technique"), part("setting"), part("shader"), part("stage")];
    parts.iter().filter(|text| !text.is_empty()).copied().collect::<Vec<_>>().join(" ")
}

fn fault(row: &Row) -> Option<String> {
    let spilled = number(row, "spilled") + number(row, "scratch_bytes");
    let waves = number(row, "subgroups_per_simd");
    let is_default = row.get("setting").is_some_and(String::is_empty);
    let is_wrong = is_default && (spilled > 0 || waves < FEWEST_WAVES);
    is_wrong.then(|| format!("{}: {spilled} spilled, {waves} waves", name(row)))
}

/// Shaders whose cost has changed by more than rounding, the dearest first.
fn tell_changes(old: &[Row], new: &[Row]) {
    const COST: &str = "inverse_throughput";
    let before: BTreeMap<String, u32> = old.iter().map(|row| (name(row), number(row, COST))).collect();
    let mut changed: Vec<_> = new
        .iter()
        .filter_map(|row| Some((name(row), *before.get(&name(row))?, number(row, COST))))
        .filter(|(_, before, now)| before.abs_diff(*now) * 50 > *before)
        .collect();
    changed.sort_by_key(|(_, _, now)| std::cmp::Reverse(*now));
    for (name, before, now) in changed {
        println!("  {name}: {before} -> {now} cycles a wave");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "technique,setting,shader,stage,spilled,scratch_bytes,inverse_throughput,subgroups_per_simd\n\
                         vsm,,\"vsm, 16 bits: look\",fragment,0,0,700,20\n\
                         wedges,batch=per-loop,\"wedges: make\",compute,4,0,9,4\n\
                         wedges,,\"wedges: make\",compute,0,16,9,9\n";

    #[test]
    fn names_with_commas_are_one_field() {
        let rows = rows(TABLE);
        assert_eq!(name(&rows[0]), "vsm vsm, 16 bits: look fragment");
        assert_eq!(number(&rows[0], "inverse_throughput"), 700);
    }

    #[test]
    fn what_spills_at_defaults_is_a_fault() {
        let faults: Vec<_> = rows(TABLE).iter().filter_map(fault).collect();
        assert_eq!(faults, ["wedges wedges: make compute: 16 spilled, 9 waves"]);
    }
}

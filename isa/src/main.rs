//! Compiles every pipeline of every technique for a GPU that need not be there, and prints what its
//! driver says of each shader: registers, spills, instructions, throughput.
//!
//! Mesa's RADV compiles for any of AMD's chips where `RADV_FORCE_FAMILY` names one. It then offers
//! a device that runs nothing, and which wgpu can't open.

mod driver;
mod formats;
mod pipeline;
mod spirv;
mod table;
mod techniques;

use anyhow::{Context, Result};

fn main() -> Result<()> {
    let only: Vec<String> = std::env::args().skip(1).collect();
    let driver = driver::Driver::open()?;
    let mut table = table::Table::default();
    let is_asked = |id: &str| only.is_empty() || only.iter().any(|asked| asked == id);
    for set in techniques::yardsticks().into_iter().filter(|set| is_asked(&set.name)) {
        add(&driver, &mut table, &set.name.clone(), &set)?;
    }
    for info in umbrage::techniques().iter().filter(|info| is_asked(info.id)) {
        eprintln!("{}", info.id);
        for set in techniques::sets(info)? {
            add(&driver, &mut table, info.id, &set)?;
        }
    }
    print!("{}", table.csv());
    Ok(())
}

/// Compiles all pipelines that a technique takes with these settings.
fn add(driver: &driver::Driver, table: &mut table::Table, technique: &str, set: &techniques::Set) -> Result<()> {
    for pipeline in techniques::pipelines(set)? {
        table.add(technique, set, driver.compile(&pipeline).with_context(|| set.name.clone())?);
    }
    Ok(())
}

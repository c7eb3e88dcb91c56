//! What is worth knowing of a graphics card, in one go: whether all is right there, and what it
//! takes. It is for machines that are there for minutes.

use crate::shell::{self, Profile};
use crate::{bench, drivers};
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::time::Instant;

/// Seconds that all of it may take once the programs are built.
const MOST_SECONDS: f64 = 480.0;

/// Compares every technique with the truth and with the software driver's result, runs the tests
/// that hold on every driver, and files a benchmark, all on the first hardware adapter; with `any`
/// on the first adapter whatever it is, to try this out.
pub fn run(any: bool) -> Result<()> {
    shell::build_tests()?;
    shell::build(Profile::Release)?;
    let adapters = Adapters::find()?;
    let Some(card) = adapters.hardware.or(any.then_some(0)) else {
        bail!("there is no hardware adapter, only {}; `--any` takes what there is", adapters.names.join(", "));
    };
    let start = Instant::now();
    let part = |name: &str, result: Result<()>| {
        println!("\n{name}: {}, after {:.0} s", word(&result), start.elapsed().as_secs_f64());
        result
    };
    let right = part("right", drivers::card(card, adapters.software.filter(|software| *software != card)));
    let cost = part("cost", bench::run_on(card));
    let seconds = start.elapsed().as_secs_f64();
    if seconds > MOST_SECONDS {
        println!("it took {seconds:.0} s and is meant to take {MOST_SECONDS:.0}");
    }
    right.and(cost)
}

fn word(result: &Result<()>) -> &'static str {
    if result.is_ok() { "done" } else { "failed" }
}

/// Usable adapters by their numbers in the command's list.
struct Adapters {
    hardware: Option<u32>,
    software: Option<u32>,
    names: Vec<String>,
}

impl Adapters {
    fn find() -> Result<Self> {
        let list = shell::output(shell::umbrage(Profile::Release, &["list", "--json"]))?;
        let list: Value = serde_json::from_str(&list).context("`umbrage list --json` printed no JSON")?;
        let all = list["adapters"].as_array().context("`umbrage list --json` has no list of adapters")?;
        Ok(Self::of(all))
    }

    fn of(all: &[Value]) -> Self {
        let usable: Vec<_> = (0..).zip(all).filter(|(_, adapter)| adapter["unusable"].is_null()).collect();
        let first = |is_software: bool| {
            let is_it = |(_, adapter): &&(u32, &Value)| (adapter["kind"] == "software") == is_software;
            usable.iter().find(is_it).map(|(number, _)| *number)
        };
        let names = usable.iter().map(|(_, adapter)| adapter["name"].as_str().unwrap_or("?").to_string()).collect();
        Self { hardware: first(false), software: first(true), names }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_first_usable_card_is_taken() {
        let adapter = |kind: &str, unusable: Value| json!({ "name": kind, "kind": kind, "unusable": unusable });
        let all = [
            adapter("discrete", json!("no compute")),
            adapter("software", Value::Null),
            adapter("integrated", Value::Null),
        ];
        let found = Adapters::of(&all);
        assert_eq!((found.hardware, found.software), (Some(2), Some(1)));
        assert_eq!(Adapters::of(&all[..2]).hardware, None);
    }
}

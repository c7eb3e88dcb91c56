//! What a stored sweep says of settings: error against cost, and which are on the Pareto front.

/// `technique,mae,times_bare_minimum,is_on_front`, after a line `# where it was measured` for each
/// light. Written by the test `the_table_is_that_of_the_stored_sweep`.
const TABLE: &str = include_str!("record.csv");

/// Settings that were measured.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Measured {
    /// Scene and light.
    pub place: &'static str,
    /// The technique with its settings, as the command line has it.
    pub label: &'static str,
    /// Mean absolute error of visibility.
    pub mae: f64,
    /// Its time over that of the bare minimum, both over the floor.
    pub times_bare: f64,
    /// No setting of any technique was as good for less.
    pub is_on_front: bool,
}

/// All settings of the technique `id`, as they were measured.
pub(crate) fn of(id: &str) -> Vec<Measured> {
    all().into_iter().filter(|measured| measured.label.split(':').next() == Some(id)).collect()
}

fn all() -> Vec<Measured> {
    let mut place = "";
    let mut found = Vec::new();
    for line in TABLE.lines() {
        if let Some(name) = line.strip_prefix("# ") {
            place = name;
            continue;
        }
        let mut fields = line.split(',');
        let mut next = || fields.next().unwrap_or_default();
        let (label, mae, times_bare) = (next(), next().parse(), next().parse());
        if let (Ok(mae), Ok(times_bare)) = (mae, times_bare) {
            found.push(Measured { place, label, mae, times_bare, is_on_front: next() == "yes" });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;
    use std::fmt::Write;
    use umbrage_report::Choice;

    fn number(value: &Value) -> f64 {
        value.as_f64().unwrap()
    }

    /// The table of `sweep.json`.
    fn table(sweep: &Value) -> String {
        let registry = umbrage::Registry::default();
        let mut text = String::new();
        let adapter = sweep["made"]["adapter"]["name"].as_str().unwrap();
        for scene in sweep["scenes"].as_array().unwrap() {
            for light in scene["lights"].as_array().unwrap() {
                let (name, kind) = (scene["name"].as_str().unwrap(), light["kind"].as_str().unwrap());
                let light_of = if name.contains(kind) { String::new() } else { format!(", {kind} light") };
                writeln!(text, "# {name}{light_of}, on {}", adapter.split(" (").next().unwrap()).unwrap();
                let bare = number(&light["yardsticks"]["bare_minimum_over_floor_ms"]["median"]);
                let ok = light["results"].as_array().unwrap().iter().filter(|r| r["status"] == "ok");
                let row = |r: &Value| (label(r), number(&r["errors"]["mae"]), number(&r["over_floor_ms"]) / bare);
                // Parameters that were given up since can't be asked for.
                let is_known = |row: &(String, f64, f64)| Choice::parse(&registry, &row.0, &[]).is_ok();
                let rows: Vec<(String, f64, f64)> = ok.map(row).filter(is_known).collect();
                for (label, mae, times) in &rows {
                    let is_better = |(_, m, t): &(String, f64, f64)| m <= mae && t <= times && (m < mae || t < times);
                    let front = if rows.iter().any(is_better) { "no" } else { "yes" };
                    writeln!(text, "{label},{mae:.4},{times:.2},{front}").unwrap();
                }
            }
        }
        text
    }

    fn label(result: &Value) -> String {
        let settings = result["settings"].as_object().unwrap();
        let set = settings.iter().map(|(name, value)| format!(":{name}={}", value.as_str().unwrap()));
        let samples = result["light_samples"].as_u64().map(|n| format!(":light-samples={n}"));
        result["technique"].as_str().unwrap().to_string() + &set.chain(samples).collect::<String>()
    }

    #[test]
    fn the_table_is_that_of_the_stored_sweep() {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../");
        let sweep = format!("{root}benchmarks/2026-11-25-llvmpipe-llvm-15-0/sweep/sweep.json");
        let sweep: Value = serde_json::from_str(&std::fs::read_to_string(sweep).unwrap()).unwrap();
        let table = table(&sweep);
        if std::env::var_os("UMBRAGE_WRITE_DOCS").is_some() {
            std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/src/record.csv"), &table).unwrap();
        } else {
            assert_eq!(TABLE, table, "run this test with UMBRAGE_WRITE_DOCS=1");
        }
    }

    #[test]
    fn settings_of_a_technique_are_found_and_can_be_made() {
        let registry = umbrage::Registry::default();
        let found = all();
        assert!(found.iter().any(|m| m.is_on_front) && found.iter().any(|m| !m.is_on_front));
        for measured in &found {
            Choice::parse(&registry, measured.label, &[]).unwrap();
            assert!(of(measured.label.split(':').next().unwrap()).contains(measured));
        }
        assert!(of("none").is_empty());
    }
}

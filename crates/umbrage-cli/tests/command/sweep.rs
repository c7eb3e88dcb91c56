//! What `sweep` makes. It needs a graphics adapter: where there is none the tests fail, and the
//! message says how to get one.

use crate::common::{files, output, umbrage};
use serde_json::{Value, json};
use std::{collections::BTreeSet, fs, path::Path};

/// Runs `umbrage sweep` on small pictures in a folder; gives `sweep.json`.
fn sweep(folder: &Path, arguments: &[&str]) -> Value {
    let small = ["--samples", "8", "--size", "64x48", "--frames", "2", "--json"];
    let printed = output(folder, &[&["sweep"][..], arguments, &small].concat());
    serde_json::from_str(&printed).expect("JSON")
}

/// Technique and settings of every result.
fn names(light: &Value) -> Vec<String> {
    let results = light["results"].as_array().expect("results").iter();
    let set = |r: &Value| {
        let settings = r["settings"].as_object().expect("settings").iter();
        settings.map(|(k, v)| format!(" {k}={}", v.as_str().expect("text"))).collect::<String>()
    };
    let points = |r: &Value| r["light_samples"].as_u64().map(|n| format!(" light-samples={n}")).unwrap_or_default();
    results.map(|r| format!("{}{}{}", r["technique"].as_str().expect("an id"), set(r), points(r))).collect()
}

#[test]
fn sweep_writes_numbers_plots_and_a_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let vary = ["--vary", "shadow-map:size=64|128,faces=front|back", "--vary", "shadow-map:light-samples=1|4"];
    let what = ["contact", "--light", "1", "--techniques", "none,shadow-map", "-o", "out"];
    let report = sweep(folder.path(), &[&what[..], &vary].concat());
    let read = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).expect("a file");
    assert_eq!(serde_json::from_str::<Value>(&read("sweep.json")).expect("JSON"), report);
    assert_eq!((&report["schema"], &report["frames"]), (&1.into(), &2.into()));

    let light = &report["scenes"][0]["lights"][0];
    let wanted = [
        "none",
        "shadow-map size=64",
        "shadow-map faces=back size=64",
        "shadow-map size=128",
        "shadow-map faces=back size=128",
        "shadow-map light-samples=1",
        "shadow-map light-samples=4",
    ];
    assert_eq!(names(light), wanted);
    let curves: Vec<_> = light["curves"].as_array().expect("curves").iter().map(|c| c["results"].clone()).collect();
    assert_eq!(curves, [json!([1, 2]), json!([3, 4]), json!([5, 6])]);
    let results = light["results"].as_array().expect("results");
    for result in results {
        assert_eq!(result["status"], "ok", "{result}");
        assert!(result["over_floor_ms"].is_number() && result["cost"]["frame_ms"]["median"].is_number(), "{result}");
        assert_eq!(result["errors"]["mae"], result["scores"]["mae"]);
    }
    let mae = |number: usize| results[number]["errors"]["mae"].as_f64().expect("an error");
    assert!(mae(0) > 2.0 * mae(5), "no shadow is off by {}, a shadow by {}", mae(0), mae(5));
    assert!(light["yardsticks"]["floor_ms"]["median"].as_f64().is_some_and(|ms| ms > 0.0), "{light}");
    assert_eq!(light["yardsticks"]["bare_minimum_size"], 1024, "settings without a size have the usual map");

    let measures: Vec<_> = light["answers"].as_array().expect("answers").iter().map(|a| a["measure"].clone()).collect();
    assert_eq!(measures, ["mae", "vs_hard", "p99", "interior"]);
    check_answer(&light["answers"][0], results);

    let page = read("index.html");
    for part in ["id=\"data\"", "data:image/png;base64,", "0/0/mae", "const MEASURES", "light-samples"] {
        assert!(page.contains(part), "{part} is missing in the page");
    }
    assert!(!page.contains("{{") && !page.contains("https"), "the page is not complete in itself");
    for measure in measures {
        let name = format!("plots/0-contact-light1-{}.svg", measure.as_str().expect("a name"));
        assert!(read(&name).starts_with("<svg ") && read(&name).contains("shadow-map light-samples=4: "), "{name}");
    }
}

/// The front and the two tables follow from the numbers of the results.
fn check_answer(answer: &Value, results: &[Value]) {
    let point = |number: &Value| {
        let result = &results[number.as_u64().expect("a number") as usize];
        (result["over_floor_ms"].as_f64().expect("a cost"), result["errors"]["mae"].as_f64().expect("an error"))
    };
    let front: Vec<_> = answer["front"].as_array().expect("a front").iter().map(point).collect();
    assert!(!front.is_empty() && front.windows(2).all(|w| w[0].0 <= w[1].0 && w[0].1 > w[1].1), "{front:?}");
    for level in answer["levels"].as_array().expect("levels") {
        for best in level["best"].as_array().expect("a row a technique") {
            let limit = level["error"].as_f64().expect("an error");
            let own = results.iter().filter(|r| r["technique"] == best["technique"]);
            let good = own.filter(|r| r["errors"]["mae"].as_f64().is_some_and(|e| e <= limit));
            let least = good.filter_map(|r| r["over_floor_ms"].as_f64()).min_by(f64::total_cmp);
            let found = (!best["result"].is_null()).then(|| point(&best["result"]).0);
            assert_eq!(found, least, "{level}");
        }
    }
    assert_eq!(answer["budgets"].as_array().map(Vec::len), Some(4));
}

#[test]
fn a_range_of_numbers_gives_a_curve_along_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let vary = "shadow-map:bias=0..8/3,size=64";
    let report =
        sweep(folder.path(), &["contact", "--light", "0", "--techniques", "shadow-map", "--vary", vary, "-o", "out"]);
    let curve = &report["scenes"][0]["lights"][0]["curves"][0];
    assert_eq!((&curve["parameter"], &curve["values"]), (&"bias".into(), &json!([0.0, 4.0, 8.0])));
    let plot = fs::read_to_string(folder.path().join("out/plots/0-contact-light0-mae-along-bias.svg")).expect("a plot");
    assert!(plot.contains("<title>shadow-map size=64 bias=8: mae "), "{plot}");
    let page = fs::read_to_string(folder.path().join("out/index.html")).expect("a page");
    assert!(page.contains("0/0/mae/bias"), "the page lacks the plot");
}

#[test]
fn techniques_are_varied_by_themselves_and_over_soft_lights_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let report = sweep(folder.path(), &["contact", "--techniques", "shadow-map", "--set", "shadow-map.size=64"]);
    let lights = report["scenes"][0]["lights"].as_array().expect("lights");
    assert_eq!(lights.iter().map(|l| l["soft"].clone()).collect::<Vec<_>>(), [false, true]);
    for light in lights {
        let names = names(light);
        assert_eq!(names[0], "shadow-map size=64");
        assert!((6..=12).contains(&names.len()), "{names:?}");
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "{names:?}");
        assert!(names.iter().all(|name| name.contains("size=64")), "what is set stays: {names:?}");
        let brute = names.iter().filter(|name| name.contains("light-samples")).count();
        assert_eq!(brute, if light["soft"] == true { 2 } else { 0 }, "{names:?}");
    }
    assert!(folder.path().join("out/sweep/index.html").is_file(), "{:?}", files(folder.path()));
}

#[test]
fn without_json_both_tables_are_printed() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = "sweep contact --light 0 --techniques none --samples 4 --size 32x24 --frames 1 -o out";
    let text = output(folder.path(), &arguments.split(' ').collect::<Vec<_>>());
    for part in ["light 0 (point)", "settings: 1;", "within a budget", "≤ 0.005", "wrote out/index.html"] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
}

#[test]
fn mistakes_are_named_before_the_work_and_leave_nothing() {
    let refused = |vary: &str, parts: &[&str]| {
        let folder = tempfile::tempdir().expect("a folder");
        let arguments = ["sweep", "contact", "--techniques", "shadow-map", "--vary", vary, "-o", "out"];
        let output = umbrage(folder.path(), &arguments);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!((output.status.code(), text.trim_end().lines().count()), (Some(2), 1), "{text}");
        assert!(text.starts_with("error: ") && output.stdout.is_empty(), "{text}");
        parts.iter().for_each(|part| assert!(text.contains(part), "`{part}` is missing in\n{text}"));
        assert_eq!(files(folder.path()), [""; 0]);
    };
    refused("shadowmap:size=1|2", &["shadowmap", "did you mean `shadow-map`"]);
    refused("shadow-map:siez=1|2", &["siez", "did you mean `size`"]);
    refused("shadow-map:size=1|0", &["`size` of shadow-map", "`0`", "1 to"]);
    refused("shadow-map:faces=front|side", &["side", "front, back"]);
    refused("none:light-samples=1|2", &["`none` is not among"]);
    refused("shadow-map:bias=0..x", &["0..x", "from..to/count"]);
    refused("shadow-map:size=64..128/4", &["`size` of shadow-map", "85.3333"]);
    refused("shadow-map", &["--vary", "technique:name=value|value"]);
}

#[test]
fn help_shows_examples() {
    let help = output(Path::new("."), &["sweep", "--help"]);
    assert!(help.contains("Examples:") && help.contains("umbrage sweep primitives lantern"), "{help}");
}

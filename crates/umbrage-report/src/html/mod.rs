//! Reports as pages that need no network and no other file.

use crate::{
    column::{COLUMNS, Column, RADIANCE_COLUMNS},
    record::Report,
    sweep::{
        measures::{MEASURES, Measure},
        plot::Plot,
        record::SweepReport,
    },
};
use base64::{Engine, engine::general_purpose::STANDARD};
use serde::Serialize;
use std::collections::BTreeMap;

const TEMPLATE: &str = include_str!("template.html");
const STYLE: &str = include_str!("style.css");
const COMMON: &str = include_str!("common.js");

/// What differs between pages.
struct Frame {
    title: &'static str,
    heading: &'static str,
    /// Name of the file with the same numbers.
    file: &'static str,
    /// Markup after the main part.
    after: &'static str,
    script: &'static str,
}

const COMPARE: Frame = Frame {
    title: "shadows against ground truth",
    heading: "Shadow techniques against ray-traced ground truth",
    file: "report.json",
    after: include_str!("viewer.html"),
    script: include_str!("compare.js"),
};

const SWEEP: Frame = Frame {
    title: "error against cost",
    heading: "Shadow techniques: error against cost",
    file: "sweep.json",
    after: "",
    script: include_str!("sweep.js"),
};

/// What the page of a comparison reads.
#[derive(Serialize)]
struct Data<'a> {
    report: &'a Report,
    pictures: BTreeMap<&'a str, String>,
    metrics: Vec<Column>,
}

/// What the page of a sweep reads.
#[derive(Serialize)]
struct SweepData<'a> {
    report: &'a SweepReport,
    pictures: BTreeMap<&'a str, String>,
    measures: Vec<Explained>,
    /// By scene, light and measure: `0/1/mae`; those along a parameter have its name, too:
    /// `0/1/mae/lambda`.
    plots: BTreeMap<String, &'a str>,
}

/// A measure, with what it means.
#[derive(Serialize)]
struct Explained {
    #[serde(flatten)]
    measure: Measure,
    help: String,
}

/// The page of a comparison. `pictures` maps the names in `report` to the bytes of PNG files.
pub fn page(report: &Report, pictures: &BTreeMap<String, Vec<u8>>) -> String {
    let mut results = report.scenes.iter().flat_map(|scene| &scene.lights).flat_map(|light| &light.results);
    let radiance = if results.any(|result| result.radiance.is_some()) { &RADIANCE_COLUMNS[..] } else { &[] };
    let metrics = [&COLUMNS, radiance].concat();
    filled(&COMPARE, &Data { report, pictures: embedded(pictures), metrics })
}

/// The page of a sweep.
pub(crate) fn sweep_page(report: &SweepReport, pictures: &BTreeMap<String, Vec<u8>>, plots: &[Plot]) -> String {
    let along = |plot: &Plot| plot.along.as_ref().map_or(String::new(), |parameter| format!("/{parameter}"));
    let place = |plot: &Plot| format!("{}/{}/{}{}", plot.place.0, plot.place.1, plot.measure, along(plot));
    let measures = MEASURES.iter().map(|measure| Explained { measure: *measure, help: measure.help() }).collect();
    let plots = plots.iter().map(|plot| (place(plot), plot.svg.as_str())).collect();
    filled(&SWEEP, &SweepData { report, pictures: embedded(pictures), measures, plots })
}

fn embedded(pictures: &BTreeMap<String, Vec<u8>>) -> BTreeMap<&str, String> {
    let embed = |png: &Vec<u8>| format!("data:image/png;base64,{}", STANDARD.encode(png));
    pictures.iter().map(|(name, png)| (name.as_str(), embed(png))).collect()
}

fn filled(frame: &Frame, data: &impl Serialize) -> String {
    // The data comes last: nothing in it is taken for a placeholder.
    TEMPLATE
        .replace("/*{{style}}*/", STYLE)
        .replace("//{{script}}", &(COMMON.to_string() + frame.script))
        .replace("{{title}}", frame.title)
        .replace("{{heading}}", frame.heading)
        .replace("{{file}}", frame.file)
        .replace("{{after}}", frame.after)
        .replace("{{data}}", &json_in_html(data))
}

/// JSON that can stand within a `<script>`: the only thing to fear there is a `<`, which JSON has
/// in strings only.
fn json_in_html(data: &impl Serialize) -> String {
    // Plain data with text keys always has a JSON form.
    serde_json::to_string(data).unwrap_or_else(|_| "null".into()).replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{fixture::fixture, sweep};

    fn data_of(page: &str) -> serde_json::Value {
        let start = page.find("id=\"data\">").expect("a data block") + "id=\"data\">".len();
        let end = start + page[start..].find("</script>").expect("its end");
        serde_json::from_str(&page[start..end]).expect("JSON in the data block")
    }

    #[test]
    fn the_page_holds_its_data_pictures_style_and_script() {
        let report = fixture();
        let pictures = BTreeMap::from([("pictures/a.png".to_string(), b"png".to_vec())]);
        let page = page(&report, &pictures);
        assert!(!page.contains("{{"), "a placeholder was left");
        assert!(!page.contains("http://") && !page.contains("https://"), "the page reaches for the network");
        let data = data_of(&page);
        assert_eq!(data["report"], serde_json::to_value(&report).unwrap());
        assert_eq!(data["pictures"]["pictures/a.png"], "data:image/png;base64,cG5n");
        assert_eq!(data["metrics"].as_array().map(Vec::len), Some(COLUMNS.len()));
    }

    #[test]
    fn the_page_of_a_sweep_holds_its_data_plots_and_measures() {
        let report = sweep::fixture::fixture();
        let plots = sweep::plot::all(&report);
        let page = sweep_page(&report, &BTreeMap::new(), &plots);
        assert!(!page.contains("{{") && !page.contains("<dialog"), "a placeholder was left, or a part of another page");
        let data = data_of(&page);
        assert_eq!(data["report"], serde_json::to_value(&report).unwrap());
        assert_eq!(data["plots"]["0/0/mae"], plots[0].svg.as_str());
        let names: Vec<_> = data["measures"].as_array().unwrap().iter().map(|m| m["name"].as_str().unwrap()).collect();
        assert_eq!(names, MEASURES.map(|m| m.name));
        assert!(data["measures"][0]["help"].as_str().is_some_and(|help| help.contains("absolute error")));
        // The only address is the name of the format, which no browser opens.
        assert_eq!(page.matches("http").count(), page.matches("http://www.w3.org/2000/svg").count());
    }

    #[test]
    fn hostile_names_stay_text() {
        let mut report = fixture();
        report.scenes[0].name = "</script><script>alert(1)//{{data}}".into();
        let page = page(&report, &BTreeMap::new());
        assert_eq!(data_of(&page)["report"]["scenes"][0]["name"], report.scenes[0].name.as_str());
        assert_eq!(page.matches("</script>").count(), 2, "data ended the script element");
    }
}

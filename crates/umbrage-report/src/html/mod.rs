//! The report as one page that needs no network and no other file.

use crate::{column::COLUMNS, column::Column, record::Report};
use base64::{Engine, engine::general_purpose::STANDARD};
use serde::Serialize;
use std::collections::BTreeMap;

const TEMPLATE: &str = include_str!("template.html");
const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

/// What the page's script reads.
#[derive(Serialize)]
struct Data<'a> {
    report: &'a Report,
    pictures: BTreeMap<&'a str, String>,
    metrics: [Column; COLUMNS.len()],
}

/// The page. `pictures` maps the names in `report` to the bytes of PNG files.
pub fn page(report: &Report, pictures: &BTreeMap<String, Vec<u8>>) -> String {
    let embed = |png: &Vec<u8>| format!("data:image/png;base64,{}", STANDARD.encode(png));
    let pictures = pictures.iter().map(|(name, png)| (name.as_str(), embed(png))).collect();
    let data = json_in_html(&Data { report, pictures, metrics: COLUMNS });
    // The data comes last: nothing in it is taken for a placeholder.
    TEMPLATE.replace("/*{{style}}*/", STYLE).replace("//{{script}}", SCRIPT).replace("{{data}}", &data)
}

/// JSON that can stand within a `<script>`: the only thing to fear there is a `<`, which JSON has in strings only.
fn json_in_html(data: &impl Serialize) -> String {
    // Plain data with text keys always has a JSON form.
    serde_json::to_string(data).unwrap_or_else(|_| "null".into()).replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::fixture;

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
    fn hostile_names_stay_text() {
        let mut report = fixture();
        report.scenes[0].name = "</script><script>alert(1)//{{data}}".into();
        let page = page(&report, &BTreeMap::new());
        assert_eq!(data_of(&page)["report"]["scenes"][0]["name"], report.scenes[0].name.as_str());
        assert_eq!(page.matches("</script>").count(), 2, "data ended the script element");
    }
}

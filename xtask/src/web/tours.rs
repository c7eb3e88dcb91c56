//! Pages for learners: each technique with a tour of five steps, and ways to break it. What they
//! say is in the techniques' own folders; what can be set is in the registry.

mod breaks;
mod page;

use crate::shell;
use anyhow::{Context, Result, bail, ensure};
use base64::{Engine, engine::general_purpose::URL_SAFE_NO_PAD};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// Below the laboratory's own page.
const FOLDER: &str = "learn";
/// Steps of each tour.
const STEPS: usize = 5;
/// The scene of tours that name none.
const SCENE: &str = "primitives";
/// The reference that a step may show beside a technique.
const TRUTH: &str = "ray-traced";
/// Techniques of skies, which the laboratory does not show.
const NO_TOURS: [&str; 1] = ["prt"];
/// Pictures that every technique has.
const PICTURES: [&str; 3] = ["color", "visibility", "error"];

/// A tour as its file has it.
struct Tour {
    scene: String,
    /// Of the scene's camera and lights, in the words of the scene format.
    change: String,
    light: i64,
    steps: Vec<Step>,
}

/// One step: what to look at, and what is seen there.
#[derive(Default)]
struct Step {
    title: String,
    text: String,
    show: String,
    set: Vec<String>,
    beside: Option<String>,
}

/// Writes the pages into a folder of `out`, and says how many there are.
pub fn write(out: &Path) -> Result<usize> {
    let listed = shell::output(shell::umbrage(shell::Profile::Dev, &["list", "--json"]))?;
    let listed: Value = serde_json::from_str(&listed).context("`umbrage list --json` is no JSON")?;
    let all = listed["techniques"].as_array().context("`umbrage list --json` names no techniques")?;
    let has_page = |id: &str| !shell::is_reference(id) && !NO_TOURS.contains(&id);
    let techniques: Vec<&Value> = all.iter().filter(|technique| has_page(text(technique, "id"))).collect();
    let folder = out.join(FOLDER);
    fs::create_dir_all(&folder).with_context(|| format!("can't make {}", folder.display()))?;
    for technique in &techniques {
        let id = text(technique, "id");
        let of = own_folder(id);
        let tour = Tour::read(&of.join("tour.toml"))?;
        tour.check(technique, all).with_context(|| format!("the tour of `{id}`"))?;
        let readme = fs::read_to_string(of.join("README.md")).with_context(|| format!("`{id}` has no README.md"))?;
        let html = page::of(technique, &readme, &tour, &breaks::of(technique));
        fs::write(folder.join(format!("{id}.html")), html)?;
    }
    fs::write(folder.join("index.html"), page::index(&techniques))?;
    Ok(techniques.len())
}

/// Where the code of a technique lies.
fn own_folder(id: &str) -> PathBuf {
    Path::new("crates/umbrage/src/techniques").join(id.replace('-', "_"))
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}

impl Tour {
    fn read(file: &Path) -> Result<Self> {
        let text = fs::read_to_string(file).with_context(|| format!("can't read {}", file.display()))?;
        Self::parse(&text).with_context(|| file.display().to_string())
    }

    fn parse(text: &str) -> Result<Self> {
        let table: toml::Table = text.parse()?;
        let steps = table.get("step").and_then(toml::Value::as_array).context("there is no [[step]]")?;
        let scene = table.get("scene").and_then(toml::Value::as_str).unwrap_or(SCENE);
        let change = table.get("change").and_then(toml::Value::as_str).unwrap_or_default();
        let light = table.get("light").and_then(toml::Value::as_integer).unwrap_or(0);
        let steps = steps.iter().map(Step::read).collect::<Result<Vec<_>>>()?;
        ensure!(steps.len() == STEPS, "there are {} steps, and every tour has {STEPS}", steps.len());
        Ok(Self { scene: scene.into(), change: change.into(), light, steps })
    }

    /// Fails where a step shows or sets what the technique does not have.
    fn check(&self, technique: &Value, all: &[Value]) -> Result<()> {
        let has = |list: &Value, name: &str| list.as_array().is_some_and(|list| list.iter().any(|one| one == name));
        let params = technique["params"].as_array().cloned().unwrap_or_default();
        for Step { title, show, set, beside, .. } in &self.steps {
            let is_known = PICTURES.contains(&show.as_str()) || has(&technique["views"], show);
            ensure!(is_known, "`{title}` shows `{show}`, which there is not");
            for setting in set {
                let Some((name, _)) = setting.split_once('=') else { bail!("`{title}` sets `{setting}` to nothing") };
                ensure!(params.iter().any(|p| p["name"] == name), "`{title}` sets `{name}`, which there is not");
            }
            let other = beside.as_deref().and_then(|beside| beside.split(':').next());
            let is_known = other.is_none_or(|other| all.iter().any(|technique| technique["id"] == other));
            ensure!(is_known, "`{title}` shows `{}`, which there is not", other.unwrap_or_default());
        }
        Ok(())
    }

    /// The address of the laboratory with what a step shows.
    fn link(&self, id: &str, step: &Step) -> String {
        let technique = [&[id.to_string()], step.set.as_slice()].concat().join(":");
        let pane = |technique: &str| json!({ "technique": technique, "picture": step.show });
        let mut panes = vec![pane(&technique)];
        panes.extend(step.beside.as_deref().map(pane));
        permalink(&json!({ "scene": self.scene, "change": self.change, "light": self.light, "panes": panes }))
    }
}

/// As `umbrage-viewer` writes and reads them; what is left out is as it is at the start.
fn permalink(state: &Value) -> String {
    format!("1.{}", URL_SAFE_NO_PAD.encode(state.to_string()))
}

impl Step {
    fn read(table: &toml::Value) -> Result<Self> {
        let string = |key: &str| table.get(key).and_then(toml::Value::as_str).map(String::from);
        let required = |key: &str| string(key).with_context(|| format!("a step has no `{key}`"));
        let set = table.get("set").and_then(toml::Value::as_array).cloned().unwrap_or_default();
        let set = set.iter().map(|value| value.as_str().map(String::from).context("`set` holds texts"));
        Ok(Self {
            title: required("title")?,
            text: required("text")?,
            show: required("show")?,
            set: set.collect::<Result<_>>()?,
            beside: string("beside"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_technique_has_a_tour_of_five_steps() {
        let techniques = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/umbrage/src/techniques");
        let has_tour = |entry: &fs::DirEntry| !NO_TOURS.iter().any(|id| entry.path().ends_with(id));
        let folders = fs::read_dir(techniques).unwrap().flatten().filter(|entry| entry.path().is_dir());
        let folders = folders.filter(has_tour);
        let mut count = 0;
        for folder in folders {
            let tour = Tour::read(&folder.path().join("tour.toml")).unwrap();
            assert!(tour.steps.iter().all(|step| step.text.ends_with('.')), "{folder:?}");
            count += 1;
        }
        assert!(count >= 20, "{count} tours");
    }

    #[test]
    fn tours_that_cannot_be_followed_are_refused() {
        let step = "[[step]]\ntitle = \"a\"\ntext = \"b.\"\n";
        assert!(Tour::parse(&format!("{step}show = \"color\"\n")).is_err(), "a tour of one step");
        assert!(Tour::parse(&step.repeat(5)).is_err(), "steps that show nothing");
        let tour = |rest: &str| Tour::parse(&format!("{step}{rest}\n").repeat(5)).unwrap();
        let all = [json!({ "id": "x", "params": [{ "name": "size" }], "views": ["map-0"] })];
        let check = |rest: &str| tour(rest).check(&all[0], &all);
        check("show = \"map-0\"\nset = [\"size=4\"]\nbeside = \"x:size=2\"").unwrap();
        assert!(check("show = \"map-1\"").is_err());
        assert!(check("show = \"color\"\nset = [\"taps=4\"]").is_err());
        assert!(check("show = \"color\"\nbeside = \"y\"").is_err());
    }

    #[test]
    fn a_link_holds_what_a_step_shows() {
        let step =
            Step { show: "map-0".into(), set: vec!["size=64".into()], beside: Some("pcf".into()), ..Step::default() };
        let link =
            Tour { scene: "contact".into(), change: String::new(), light: 1, steps: Vec::new() }.link("vsm", &step);
        let json = URL_SAFE_NO_PAD.decode(link.strip_prefix("1.").unwrap()).unwrap();
        let state: Value = serde_json::from_slice(&json).unwrap();
        let pane = |technique| json!({ "technique": technique, "picture": "map-0" });
        assert_eq!(state["panes"], json!([pane("vsm:size=64"), pane("pcf")]));
        assert_eq!((&state["scene"], &state["light"]), (&json!("contact"), &json!(1)));
    }
}

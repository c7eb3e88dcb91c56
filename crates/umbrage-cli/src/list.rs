//! `umbrage list`: what there is.

use crate::{Context, say};
use anyhow::Result;
use clap::Args;
use serde_json::{Value, json};
use umbrage::{AdapterSummary, Gpu, Group, Param, Registry};
use umbrage_core::scenes::SCENES;
use umbrage_report::{PATH_TRACED, PATH_TRACED_SUMMARY, PathTraced, RAY_TRACED, RAY_TRACED_SUMMARY, RayTraced};

/// Lists techniques with their parameters, built-in scenes, and graphics adapters
#[derive(Args)]
#[command(after_help = "\
Examples:
  umbrage list
  umbrage list --json | jq '.techniques[].id'")]
pub struct List {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// A technique as a list shows it.
struct Entry {
    id: &'static str,
    summary: &'static str,
    source: &'static str,
    lights: Vec<&'static str>,
    params: &'static [Param],
    views: &'static [&'static str],
    /// Shaders of hosts can look its maps up.
    inline: bool,
}

impl List {
    /// Prints the lists.
    pub fn run(self, context: &Context<'_>) -> Result<()> {
        let (entries, adapters) = (entries(context.registry), Gpu::adapters());
        let text = if self.json { as_json(&entries, &adapters) } else { as_text(&entries, &adapters) };
        if self.json { say::json(&text) } else { say::text(&text) }
    }
}

/// The registry, with both tracers at its head.
fn entries(registry: &Registry) -> Vec<Entry> {
    let kinds = |kinds: umbrage_core::LightKinds| kinds.iter().map(|k| k.name()).collect();
    let ray_traced = Entry {
        id: RAY_TRACED,
        summary: RAY_TRACED_SUMMARY,
        source: "PX 2.1.2; ZA 5.4",
        lights: kinds(umbrage_core::LightKinds::ALL),
        params: RayTraced::params(),
        views: &[],
        inline: false,
    };
    let path_traced = Entry {
        id: PATH_TRACED,
        summary: PATH_TRACED_SUMMARY,
        lights: vec![umbrage_core::LightKind::Environment.name()],
        params: PathTraced::params(),
        source: "Veach, Guibas 1995",
        views: &[],
        inline: false,
    };
    let registered = registry.all().map(|t| Entry {
        id: t.id,
        summary: t.summary,
        source: t.source,
        lights: kinds(t.lights),
        params: t.params(),
        views: t.views,
        inline: t.is_lent(),
    });
    [ray_traced, path_traced].into_iter().chain(registered).collect()
}

fn as_json(entries: &[Entry], adapters: &[AdapterSummary]) -> String {
    let param = |p: &Param| {
        json!({ "name": p.name, "help": p.help, "unit": p.unit, "range": p.kind.range(),
                "default": p.kind.default().to_string() })
    };
    let technique = |e: &Entry| {
        json!({ "id": e.id, "summary": e.summary, "source": e.source, "lights": e.lights,
                "params": e.params.iter().map(param).collect::<Vec<Value>>(), "views": e.views, "inline": e.inline })
    };
    let scene = |s: &umbrage_core::scenes::SceneEntry| json!({ "id": s.id, "title": s.title, "about": s.about });
    let adapter = |a: &AdapterSummary| json!({ "name": a.name, "backend": a.backend, "kind": a.kind, "driver": a.driver, "unusable": a.unusable });
    let all = json!({
        "schema": umbrage_report::record::SCHEMA,
        "techniques": entries.iter().map(technique).collect::<Vec<Value>>(),
        "scenes": SCENES.iter().map(scene).collect::<Vec<Value>>(),
        "adapters": adapters.iter().map(adapter).collect::<Vec<Value>>(),
    });
    format!("{all:#}\n")
}

fn as_text(entries: &[Entry], adapters: &[AdapterSummary]) -> String {
    let mut text = String::from("Techniques\n");
    for e in entries {
        text += &format!("  {:16} {}\n  {:16} lights: {}\n", e.id, e.summary, "", e.lights.join(", "));
        if e.inline {
            text += &format!("  {:16} also as a look-up in a host's own shader\n", "");
        }
        for p in e.params {
            let unit = if p.unit.is_empty() { String::new() } else { format!(" {}", p.unit) };
            let (default, range) = (p.kind.default(), p.kind.range());
            text += &format!("  {:16}   {}={default}{unit}  ({range})  {}\n", "", p.name, p.help);
        }
        if !e.views.is_empty() {
            text += &format!("  {:16} views (render --aov NAME): {}\n", "", e.views.join(", "));
        }
    }
    text += "\nBuilt-in scenes (NAME, or NAME:DETAIL where 1 is normal)\n";
    for s in SCENES {
        text += &format!("  {:16} {}: {}\n", s.id, s.title, s.about);
    }
    text += "\nGraphics adapters (--adapter takes the number, a part of the name, or `software`)\n";
    for (i, a) in adapters.iter().enumerate() {
        let reason = a.unusable.as_ref().map_or(String::new(), |why| format!(": can't be used, since {why}"));
        text += &format!("  {i}  {} ({}, {}, {}){reason}\n", a.name, a.kind, a.backend, a.driver);
    }
    if adapters.iter().all(|a| a.unusable.is_some()) {
        text += "  none that can be used: install a Vulkan driver, or run `cargo xtask setup`\n";
    }
    text
}

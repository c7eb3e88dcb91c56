//! `umbrage info`: what is in a scene, and what is wrong with it.

use crate::say;
use anyhow::Result;
use clap::Args;
use serde_json::{Value, json};
use std::borrow::Cow;
use umbrage_core::mesh_check::{MeshReport, check_scene};
use umbrage_core::{Camera, Instance, Light, LightShape, Scene, glam::DVec3};
use umbrage_report::Source;

/// Shows what a scene holds: triangles, lights, bounds, and faults of its meshes
#[derive(Args)]
#[command(after_help = "\
Examples:
  umbrage info atrium
  umbrage info model.glb
  umbrage info bunny.scene.toml --json")]
pub struct Info {
    /// Built-in scene or file
    scene: String,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Info {
    /// Prints the facts.
    pub fn run(self) -> Result<()> {
        let source = Source::open(&self.scene)?;
        let report = check_scene(&source.scene);
        let text = if self.json { as_json(&source, &report) } else { as_text(&source, &report) };
        if self.json { say::json(&text) } else { say::text(&text) }
    }
}

/// What the loader had to say, and what techniques make of the scene.
fn notes(source: &Source) -> Vec<String> {
    let is_masked = |i: &Instance| i.casts && source.scene.materials[i.material].alpha_cutoff.is_some();
    let cards = source.scene.instances.iter().filter(|i| is_masked(i)).count();
    let masked = format!(
        "{cards} instances cast through an alpha mask: `volume`, `wedges` and `light-mask` look them up in maps of their own"
    );
    source.notes.iter().cloned().chain((cards > 0).then_some(masked)).collect()
}

/// The faults that a mesh can have, as names for JSON and for people.
fn faults(report: &MeshReport) -> [(&'static str, &'static str, usize); 7] {
    [
        ("open_edges", "open edges", report.open_edges),
        ("non_manifold_edges", "non-manifold edges", report.non_manifold_edges),
        ("inconsistent_edges", "edges between triangles wound differently", report.inconsistent_edges),
        ("degenerate_triangles", "degenerate triangles", report.degenerate_triangles),
        ("duplicate_triangles", "duplicate triangles", report.duplicate_triangles),
        ("non_finite_vertices", "vertices that are not finite", report.non_finite_vertices),
        ("out_of_range_triangles", "triangles with a missing vertex", report.out_of_range_triangles),
    ]
}

fn masked(scene: &Scene) -> usize {
    scene.materials.iter().filter(|m| m.alpha_cutoff.is_some()).count()
}

fn as_json(source: &Source, report: &MeshReport) -> String {
    let scene = &source.scene;
    let bounds = scene.bounds();
    let light = |(i, l): (usize, Cow<'_, Light>)| {
        let center = l.shape.center();
        let kind = l.shape.kind();
        if let LightShape::Environment(sky) = &l.shape {
            return json!({ "light": i, "kind": kind.name(), "rotate_deg": sky.rotate_deg, "intensity": sky.intensity });
        }
        let place = if center.w == 0.0 { "direction_to" } else { "position" };
        json!({ "light": i, "kind": kind.name(), "soft": kind.is_soft(), "casts": l.casts,
                place: center.truncate().to_array(), "radius": l.shape.radius() })
    };
    let mut mesh: Value = faults(report).into_iter().map(|(name, _, n)| (name.to_string(), json!(n))).collect();
    mesh["closed"] = json!(report.is_closed());
    let all = json!({
        "schema": umbrage_report::record::SCHEMA,
        "name": scene.name,
        "source": source.asked,
        "triangles": scene.triangle_count(),
        "instances": scene.instances.len(),
        "meshes": scene.meshes.len(),
        "vertices": report.vertices,
        "materials": scene.materials.len(),
        "masked_materials": masked(scene),
        "textures": scene.textures.len(),
        "bounds": { "min": bounds.min.to_array(), "max": bounds.max.to_array() },
        "camera": { "eye": scene.camera.eye.to_array(), "target": scene.camera.target.to_array(),
                    "fov_y_deg": scene.camera.fov_y_deg, "near": scene.camera.near,
                    "height": scene.camera.parallel.map(|p| p.height), "far": scene.camera.parallel.map(|p| p.far) },
        "lights": scene.numbered_lights().enumerate().map(light).collect::<Vec<Value>>(),
        "mesh_check": mesh,
        "notes": notes(source),
    });
    format!("{all:#}\n")
}

/// What fits into the picture from bottom to top.
fn height_of(camera: &Camera) -> String {
    let angle = || format!("{:.1}° high", camera.fov_y_deg);
    camera.parallel.map_or_else(angle, |p| format!("{:.3} m high, parallel lines of sight", p.height))
}

fn as_text(source: &Source, report: &MeshReport) -> String {
    let scene = &source.scene;
    let bounds = scene.bounds();
    let vector = |v: DVec3| format!("({:.3}, {:.3}, {:.3})", v.x, v.y, v.z);
    let row = |name: &str, value: String| format!("{name:<12} {value}\n");
    let mut text = format!("{} ({})\n", scene.name, source.asked);
    text += &row(
        "triangles",
        format!("{} in {} instances of {} meshes", scene.triangle_count(), scene.instances.len(), scene.meshes.len()),
    );
    text += &row(
        "materials",
        format!("{} ({} with an alpha mask), {} textures", scene.materials.len(), masked(scene), scene.textures.len()),
    );
    text += &row("bounds", format!("{} to {}, metres", vector(bounds.min), vector(bounds.max)));
    text += &row(
        "camera",
        format!("{} to {}, {}", vector(scene.camera.eye), vector(scene.camera.target), height_of(&scene.camera)),
    );
    for (i, light) in scene.numbered_lights().enumerate() {
        if let LightShape::Environment(sky) = &light.shape {
            text += &row(&format!("light {i}"), format!("environment, turned by {}°", sky.rotate_deg));
            continue;
        }
        let center = light.shape.center();
        let place = if center.w == 0.0 { "from" } else { "at" };
        let casts = if light.casts { "" } else { ", casts no shadow" };
        text += &row(
            &format!("light {i}"),
            format!("{} {place} {}{casts}", light.shape.kind().name(), vector(center.truncate())),
        );
    }
    let found: Vec<String> =
        faults(report).iter().filter(|f| f.2 > 0).map(|(_, name, n)| format!("{n} {name}")).collect();
    let closed = if report.is_closed() { "closed" } else { "not closed" };
    text += &row("meshes", if found.is_empty() { closed.into() } else { format!("{closed}: {}", found.join(", ")) });
    notes(source).into_iter().for_each(|note| text += &row("note", note));
    text
}

//! Draws the pictures of all techniques in the documentation of `umbrage::techniques`.
//!
//!     cargo run -p umbrage --example gallery
//!
//! They lie in the text itself, since the documentation of a package has no files beside it.

use base64::{Engine, prelude::BASE64_STANDARD};
use std::path::Path;
use umbrage::core::scenes;
use umbrage::{Gpu, TechniqueInfo};
use umbrage_renderer::{LightPass, Renderer};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Pixels across and down.
const SIZE: (u32, u32) = (200, 150);

/// The soft light of the scene.
const LIGHT: usize = 1;

fn main() -> Result<()> {
    let gpu = Gpu::request(None)?;
    let rows = umbrage::techniques().iter().map(|info| row(&gpu, info)).collect::<Result<String>>()?;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/techniques/gallery.txt");
    std::fs::write(path, format!("| | |\n|---|---|\n{rows}"))?;
    Ok(())
}

/// A row of the table: the technique at its defaults, and its summary.
fn row(gpu: &Gpu, info: &TechniqueInfo) -> Result<String> {
    let scene = (scenes::find("contact").ok_or("there is no such scene")?.build)(1.0);
    let technique = umbrage::parse(info.id)?.make(gpu)?;
    let mut renderer = Renderer::new(gpu, &scene, SIZE.0, SIZE.1, vec![LightPass { light: LIGHT, technique }])?;
    renderer.frame(&scene.camera)?;
    let picture = umbrage_io::pictures::png_bytes(Path::new(info.id), &renderer.color()?)?;
    let (id, module, summary) = (info.id, info.id.replace('-', "_"), info.summary);
    let picture = BASE64_STANDARD.encode(picture);
    Ok(format!("| ![{id}](data:image/png;base64,{picture}) | [`{id}`](self::{module}): {summary} |\n"))
}

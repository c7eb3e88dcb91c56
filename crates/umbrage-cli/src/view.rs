//! `umbrage view`: the laboratory.

use crate::Context;
use anyhow::{Result, bail};
use clap::Args;
use umbrage_viewer::Options;

/// Opens the laboratory: every technique beside the truth in one window
#[derive(Args)]
#[command(after_help = "\
Examples:
  umbrage view
  umbrage view atrium --technique pcss,ray-traced
  umbrage view model.glb --technique shadow-map:size=512
  umbrage view --state '1.eyJzY2VuZSI6…'     a permalink, copied with Keep, Copy permalink

In the window, `?` shows what keys and mouse do. Right click on a picture opens the menu of all techniques.")]
pub struct View {
    /// Built-in scene or file [default: primitives]
    scene: Option<String>,
    /// Techniques of up to four panes, separated by commas; `ray-traced` is the truth
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    technique: Vec<String>,
    /// A permalink: scene, camera, lights, techniques, settings
    #[arg(long, value_name = "LINK", conflicts_with_all = ["scene", "technique"])]
    state: Option<String>,
    /// Graphics adapter: a part of its name, or `software`
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
}

impl View {
    /// Opens the window and returns when it is closed.
    pub fn run(self, context: &Context<'_>) -> Result<()> {
        let options = Options {
            scene: self.scene,
            techniques: self.technique,
            state: self.state,
            adapter: self.adapter,
            ..Options::default()
        };
        if let Err(error) = umbrage_viewer::run(context.registry, &options) {
            bail!("{error}");
        }
        Ok(())
    }
}

//! `umbrage bake`: the transfer of radiance of a scene.

use crate::{args, bars::Bars, say};
use anyhow::{Context as _, Result, bail};
use clap::{Args, ValueEnum};
use signal_hook::{consts::SIGINT, flag};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use umbrage_core::{harmonics::Order, transfer::Kind};
use umbrage_report::umbrage_bake::{BakedSides, Settings, Storage};
use umbrage_report::{Progress, Source};

/// Bakes how light of the sky reaches every vertex of a scene, past what blocks and reflects it
#[derive(Args)]
#[command(after_help = "\
Examples:
  umbrage bake contact
  umbrage bake atrium --transfer interreflected --bounces 2 --order 6
  umbrage bake bunny.scene.toml --bake-samples 1024 --cache baked
  umbrage bake atrium --storage cpca:64:4 --out atrium.npz

The result is kept by the content of meshes, materials and settings, and found again. A bake that is stopped with \
Ctrl-C is continued by the same command; a file that is damaged is made anew.")]
pub struct Bake {
    /// Built-in scene or file
    scene: String,
    /// Order of the spherical harmonics: n has n² functions
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=10))]
    order: u32,
    /// What light does on its way: nothing is in it, surfaces block it, or reflect it, too
    #[arg(long, value_name = "KIND", default_value = "shadowed")]
    transfer: Transfer,
    /// Reflections of `interreflected` before the one that is seen [default: 2]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    bounces: Option<u32>,
    /// Rays for each vertex and bounce
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=65_536))]
    bake_samples: u32,
    /// Longest edge after cutting: this many fit along the diagonal of the scene
    #[arg(long, value_name = "N", default_value_t = 64.0)]
    detail: f64,
    /// Bake the backs of closed meshes, too, for cameras inside
    #[arg(long)]
    both_sides: bool,
    /// Folder that keeps the result
    #[arg(long, value_name = "FOLDER", default_value = "out/baked")]
    cache: PathBuf,
    /// How coefficients are stored: full, bytes, pca:K, vq:N, cpca:N:K (N clusters of K vectors)
    #[arg(long, value_name = "WAY", default_value = "full")]
    storage: Storage,
    /// Write the transfer for other software, too: .npz for NumPy, .glb with attributes
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    changed: args::Changed,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Transfer {
    Unshadowed,
    Shadowed,
    Interreflected,
}

impl Bake {
    /// Bakes and says where the result is.
    pub fn run(self) -> Result<()> {
        let settings = self.settings()?;
        let source = self.changed.open(&self.scene)?;
        source.notes.iter().for_each(|note| say::note(note));
        self.bake(source, settings)
    }

    fn bake(&self, source: Source, settings: Settings) -> Result<()> {
        let (bars, stop) = (Bars::default(), stop_at_interrupt()?);
        let (folder, storage, out) = (self.cache.clone(), self.storage, self.out.clone());
        let kept = umbrage_report::Bake { source, settings, folder, storage, out }.run(&bars, &stop)?;
        kept.notes.iter().for_each(|note| bars.note(note));
        let points: usize = kept.transfer.meshes.iter().map(|mesh| mesh.point_count()).sum();
        let bytes = kept.transfer.bytes();
        let how = if kept.was_kept { "was there" } else { "is baked" };
        let place = self.out.as_ref().unwrap_or(&kept.path);
        say::text(&format!("{}: {points} points, {bytes} bytes of coefficients; {how}\n", place.display()))
    }

    fn settings(&self) -> Result<Settings> {
        let kind = match (self.transfer, self.bounces) {
            (Transfer::Interreflected, bounces) => Kind::Interreflected { bounces: bounces.unwrap_or(2) },
            (_, Some(_)) => bail!("--bounces goes with `--transfer interreflected`"),
            (Transfer::Unshadowed, None) => Kind::Unshadowed,
            (Transfer::Shadowed, None) => Kind::Shadowed,
        };
        Ok(Settings {
            order: Order::new(self.order)?,
            kind,
            rays: self.bake_samples,
            detail: self.detail,
            sides: if self.both_sides { BakedSides::Both } else { BakedSides::Seen },
            ..Settings::default()
        })
    }
}

/// Is set by Ctrl-C, so that what is done can be kept. The second Ctrl-C ends the command at once.
fn stop_at_interrupt() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    // In this order: the first one finds nothing set yet.
    flag::register_conditional_shutdown(SIGINT, 130, stop.clone())
        .and_then(|_| flag::register(SIGINT, stop.clone()))
        .context("the bake could not be stopped with Ctrl-C")?;
    Ok(stop)
}

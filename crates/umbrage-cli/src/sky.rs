//! `umbrage sky`: the light of a sky as coefficients, for other software.

use crate::say;
use anyhow::Result;
use clap::Args;
use std::path::PathBuf;
use umbrage_report::{Probe, SkyProbe};

/// Writes the light of a sky as spherical harmonics, as other software has them
#[derive(Args)]
#[command(after_help = "\
Examples:
  umbrage sky courtyard --to filament -o sh.txt
  umbrage sky sh.txt --to three
  umbrage sky probe.json --to babylon

The forms are the text of Filament's cmgen, a LightProbe of three.js and SphericalHarmonics of Babylon.js; each is read \
as well. They have three bands. docs/harmonics.md has their scaling and signs.")]
pub struct Sky {
    /// A scene with an environment, or coefficients in a .txt or .json
    from: String,
    /// How to write them: filament, three, babylon
    #[arg(long, value_name = "FORM")]
    to: Probe,
    /// File to write [default: the standard output]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

impl Sky {
    /// Writes the coefficients.
    pub fn run(self) -> Result<()> {
        let probe = SkyProbe { from: self.from, form: self.to, path: self.output };
        probe.run()?.map_or(Ok(()), |text| say::text(&text))
    }
}

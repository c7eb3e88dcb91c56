//! The pictures of a report, as PNG files in memory.

use crate::error::Error;
use std::{collections::BTreeMap, path::Path};
use umbrage_core::Image;
use umbrage_io::pictures::{PngPixel, png_bytes};

/// PNG files by their name relative to the report.
#[derive(Clone, Debug, Default)]
pub struct Pictures {
    /// Name to bytes.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl Pictures {
    /// Adds a picture under `pictures/` and returns its name.
    pub(crate) fn add<P: PngPixel>(&mut self, name: &str, image: &Image<P>) -> Result<String, Error> {
        let plain = |c: char| if c.is_ascii_alphanumeric() || "-_.=".contains(c) { c } else { '-' };
        let name = format!("pictures/{}.png", name.chars().map(plain).collect::<String>());
        let bytes = png_bytes(Path::new(&name), image)?;
        self.files.insert(name.clone(), bytes);
        Ok(name)
    }
}

/// Visibility as it is looked at: black is umbra, white fully lit, magenta what is no number.
pub(crate) fn grey(visibility: &Image<f32>) -> Image<[u8; 3]> {
    visibility.map(|v| if v.is_nan() { [255, 0, 255] } else { [(v.clamp(0.0, 1.0) * 255.0).round() as u8; 3] })
}

/// A colour picture without its alpha, which is 1 everywhere.
pub(crate) fn opaque(color: &Image<[u8; 4]>) -> Image<[u8; 3]> {
    color.map(|&[r, g, b, _]| [r, g, b])
}

/// Depth as it is looked at: the nearest surface over the distance, 0 where nothing is.
pub(crate) fn inverse_depth(depth: &Image<f32>) -> Image<f32> {
    let nearest = depth.data.iter().copied().filter(|d| *d > 0.0).fold(f32::INFINITY, f32::min);
    depth.map(|&d| if d > 0.0 { nearest / d } else { 0.0 })
}

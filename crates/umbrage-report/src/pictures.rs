//! The pictures of a report, as PNG files in memory.

use crate::error::Error;
use std::{collections::BTreeMap, path::Path};
use umbrage_core::Image;
use umbrage_core::glam::Vec3;
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

/// The curve of the renderer's `tonemap.wgsl`: unchanged up to 0.8, then rolled off to 1, with the
/// hue kept; sRGB.
pub(crate) fn tone_mapped(radiance: Vec3) -> [u8; 4] {
    const SHOULDER: f32 = 0.8;
    let color = radiance.max(Vec3::ZERO);
    let peak = color.max_element();
    let (room, over) = (1.0 - SHOULDER, (peak - SHOULDER).max(0.0));
    let rolled = peak.min(SHOULDER) + room * over / (over + room);
    let encoded = |c: f32| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    let [r, g, b] = (color * (rolled / peak.max(1e-6))).to_array().map(|c| (encoded(c) * 255.0).round() as u8);
    [r, g, b, 255]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tones_are_those_of_the_renderer() {
        assert_eq!(tone_mapped(Vec3::ZERO), [0, 0, 0, 255]);
        assert_eq!(tone_mapped(Vec3::new(0.5, 0.5, 0.8)), [188, 188, 231, 255]);
        // 0.8 + 0.2 · 1.2 / 1.4 of 2.
        assert_eq!(tone_mapped(Vec3::new(2.0, 0.0, 0.0))[0], 252);
        assert_eq!(tone_mapped(Vec3::splat(1e9)), [255, 255, 255, 255]);
    }
}

//! Pictures that came from the GPU.

use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use std::path::Path;

/// A picture in linear RGB.
#[derive(Clone, Debug)]
pub struct Picture {
    pub size: (u32, u32),
    pub pixels: Vec<Vec3>,
}

impl Picture {
    /// From rows that may be padded at their ends.
    pub fn new((width, height): (u32, u32), format: TextureFormat, data: &[u8]) -> Self {
        let row = data.len() / height as usize;
        let half = |b: &[u8; 2]| f16_to_f32(u16::from_le_bytes(*b));
        let pixel = |bytes: &[u8]| match format {
            TextureFormat::Rgba16Float => {
                let [r, g, b, _] = *bytes.as_chunks::<2>().0 else { return Vec3::ZERO };
                Vec3::new(half(&r), half(&g), half(&b))
            }
            _ => Vec3::from_array([0, 1, 2].map(|i| linear(bytes[i]))),
        };
        let bytes = if format == TextureFormat::Rgba16Float { 8 } else { 4 };
        let rows = data.chunks_exact(row).flat_map(|row| row[..width as usize * bytes].chunks_exact(bytes));
        Self { size: (width, height), pixels: rows.map(pixel).collect() }
    }

    /// As a screen shows it, which has nothing over 1.
    pub fn luminance(&self) -> Vec<f32> {
        self.pixels.iter().map(|p| p.min(Vec3::ONE).dot(Vec3::new(0.2126, 0.7152, 0.0722))).collect()
    }

    /// As PNG, what is over 1 being white.
    pub fn save(&self, path: &Path) -> Result<()> {
        let mut encoder = png::Encoder::new(std::fs::File::create(path)?, self.size.0, self.size.1);
        encoder.set_color(png::ColorType::Rgb);
        let bytes = self.pixels.iter().flat_map(|p| p.to_array()).map(encoded).collect::<Vec<_>>();
        encoder.write_header()?.write_image_data(&bytes)?;
        Ok(())
    }
}

fn encoded(v: f32) -> u8 {
    let v = v.clamp(0.0, 1.0);
    let s = if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (s * 255.0 + 0.5) as u8
}

fn linear(byte: u8) -> f32 {
    let s = f32::from(byte) / 255.0;
    if s <= 0.040_45 { s / 12.92 } else { ((s + 0.055) / 1.055).powf(2.4) }
}

/// A half float, which the standard library can't read yet.
fn f16_to_f32(bits: u16) -> f32 {
    let (sign, exponent, fraction) = (bits >> 15, bits >> 10 & 31, f32::from(bits & 1023));
    let size = match exponent {
        0 => fraction * 2f32.powi(-24),
        31 => f32::NAN,
        _ => (1.0 + fraction / 1024.0) * 2f32.powi(i32::from(exponent) - 15),
    };
    if sign == 1 { -size } else { size }
}

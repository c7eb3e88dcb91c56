//! Surface appearance.

use glam::{Vec3, Vec4};

/// What a surface looks like under the standard lighting model (PX 2.2), and where it is cut out.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Linear RGB reflectance and opacity. Multiplied by the texture.
    pub base_color: Vec4,
    /// Index into [`crate::Scene::textures`] of the base-colour picture.
    pub texture: Option<usize>,
    /// Strength of the specular highlight, 0 and up.
    pub specular: f32,
    /// Exponent of the highlight, over 0.
    pub shininess: f32,
    /// Light given off, linear RGB.
    pub emissive: Vec3,
    /// Alpha mask: the surface is absent, for the eye and for light, where alpha is below this. `None`: opaque.
    pub alpha_cutoff: Option<f32>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            base_color: Vec4::new(0.8, 0.8, 0.8, 1.0),
            texture: None,
            specular: 0.0,
            shininess: 32.0,
            emissive: Vec3::ZERO,
            alpha_cutoff: None,
        }
    }
}

/// An 8-bit sRGB picture with straight alpha, row 0 at the top, sampled with repetition.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Where it came from, for messages.
    pub name: String,
    /// Pixels across, over 0.
    pub width: u32,
    /// Pixels down, over 0.
    pub height: u32,
    /// `width * height` pixels of R, G, B, A.
    pub rgba: Vec<[u8; 4]>,
}

impl Texture {
    /// Alpha in 0…1 at texture coordinates `uv` (row 0 is v = 0), bilinear with repetition: the same filter as the
    /// GPU's, so that a cut-out edge lies at the same place for a ray and for a rasteriser.
    pub fn alpha(&self, uv: glam::Vec2) -> f32 {
        let (w, h) = (self.width as i64, self.height as i64);
        let (x, y) = (uv.x as f64 * w as f64 - 0.5, uv.y as f64 * h as f64 - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = ((x - x0) as f32, (y - y0) as f32);
        let at = |dx: i64, dy: i64| {
            let (i, j) = ((x0 as i64 + dx).rem_euclid(w), (y0 as i64 + dy).rem_euclid(h));
            f32::from(self.rgba[(j * w + i) as usize][3]) / 255.0
        };
        let top = at(0, 0) * (1.0 - fx) + at(1, 0) * fx;
        let bottom = at(0, 1) * (1.0 - fx) + at(1, 1) * fx;
        top * (1.0 - fy) + bottom * fy
    }
}

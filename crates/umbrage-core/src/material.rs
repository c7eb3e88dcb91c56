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
    /// Alpha mask: the surface is absent, for the eye and for light, where alpha is below this.
    /// `None`: opaque.
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
    /// Alpha in 0…1 at texture coordinates `uv` (row 0 is v = 0), bilinear with repetition: the
    /// same filter as the GPU's, so that a cut-out edge lies at the same place for a ray and for a
    /// rasteriser.
    pub fn alpha(&self, uv: glam::Vec2) -> f32 {
        let (w, h) = (f64::from(self.width), f64::from(self.height));
        let (x, y) = (f64::from(uv.x) * w - 0.5, f64::from(uv.y) * h - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = ((x - x0) as f32, (y - y0) as f32);
        // Wrapped before they are made integers, which would not hold every float.
        let wrapped = |c: f64, size: f64| c.rem_euclid(size) as usize;
        let at = |dx: f64, dy: f64| {
            let (i, j) = (wrapped(x0 + dx, w), wrapped(y0 + dy, h));
            f32::from(self.rgba[j * self.width as usize + i][3]) / 255.0
        };
        let top = at(0.0, 0.0) * (1.0 - fx) + at(1.0, 0.0) * fx;
        let bottom = at(0.0, 1.0) * (1.0 - fx) + at(1.0, 1.0) * fx;
        top * (1.0 - fy) + bottom * fy
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;

    #[test]
    fn alpha_is_bilinear_and_repeats_however_far_off() {
        let texture = Texture { name: "two".into(), width: 2, height: 1, rgba: vec![[0, 0, 0, 0], [0, 0, 0, 255]] };
        for (u, want) in [(0.25, 0.0), (0.75, 1.0), (0.5, 0.5), (0.0, 0.5), (-0.25, 1.0), (7.25, 0.0), (-4.625, 0.25)] {
            assert_eq!(texture.alpha(Vec2::new(u, 0.3)), want, "u = {u}");
        }
        assert!((0.0..=1.0).contains(&texture.alpha(Vec2::new(f32::MAX, f32::MIN))));
    }
}

//! Surface appearance.

use glam::{Vec2, Vec3, Vec4};
use std::ops::{Add, Mul};

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

/// An 8-bit sRGB picture with straight alpha, row 0 at the top.
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
    /// How surfaces sample it.
    pub sampling: Sampling,
}

/// How a picture is continued beyond its borders and between its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sampling {
    /// Beyond the borders, along u and along v.
    pub wrap: [Wrap; 2],
    /// Between pixels.
    pub filter: Filter,
}

/// What lies beyond the borders of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The picture again.
    #[default]
    Repeat,
    /// The picture again, every other time mirrored.
    Mirror,
    /// The pixels at the border.
    Clamp,
}

/// What lies between the middles of pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// A mean of the four pixels around.
    #[default]
    Linear,
    /// The nearest pixel alone.
    Nearest,
}

impl Wrap {
    /// The pixel out of `size` that a whole number stands for.
    fn pixel(self, at: f64, size: f64) -> usize {
        // Wrapped before it is made an integer, which would not hold every float.
        let pixel = match self {
            Self::Repeat => at.rem_euclid(size),
            Self::Clamp => at.clamp(0.0, size - 1.0),
            Self::Mirror => {
                let around = at.rem_euclid(2.0 * size);
                around.min(2.0 * size - 1.0 - around)
            }
        };
        pixel as usize
    }
}

impl Texture {
    /// Alpha in 0…1 at texture coordinates `uv` (row 0 is v = 0): the same filter as the GPU's, so
    /// that a cut-out edge lies at the same place for a ray and for a rasteriser.
    pub fn alpha(&self, uv: Vec2) -> f32 {
        self.filtered(uv, |p| f32::from(p[3]) / 255.0)
    }

    /// Linear RGB at texture coordinates `uv`, by the same filter. Black for a picture without
    /// texels, and for coordinates that are no numbers.
    pub fn color(&self, uv: Vec2) -> Vec3 {
        if self.rgba.is_empty() || !uv.is_finite() {
            return Vec3::ZERO;
        }
        let linear = |c: u8| {
            let c = f32::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        self.filtered(uv, |p| Vec3::new(linear(p[0]), linear(p[1]), linear(p[2])))
    }

    fn filtered<T: Mul<f32, Output = T> + Add<Output = T>>(&self, uv: Vec2, of: impl Fn([u8; 4]) -> T) -> T {
        let (w, h) = (f64::from(self.width), f64::from(self.height));
        let (x, y) = (f64::from(uv.x) * w, f64::from(uv.y) * h);
        let [wrap_u, wrap_v] = self.sampling.wrap;
        let at = |x: f64, y: f64| {
            let (i, j) = (wrap_u.pixel(x, w), wrap_v.pixel(y, h));
            of(self.rgba[j * self.width as usize + i])
        };
        if self.sampling.filter == Filter::Nearest {
            return at(x.floor(), y.floor());
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = ((x - x0) as f32, (y - y0) as f32);
        let top = at(x0, y0) * (1.0 - fx) + at(x0 + 1.0, y0) * fx;
        let bottom = at(x0, y0 + 1.0) * (1.0 - fx) + at(x0 + 1.0, y0 + 1.0) * fx;
        top * (1.0 - fy) + bottom * fy
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alpha_is_bilinear_and_repeats_however_far_off() {
        let texture = two_pixels(Sampling::default());
        for (u, want) in [(0.25, 0.0), (0.75, 1.0), (0.5, 0.5), (0.0, 0.5), (-0.25, 1.0), (7.25, 0.0), (-4.625, 0.25)] {
            assert_eq!(texture.alpha(Vec2::new(u, 0.3)), want, "u = {u}");
        }
        assert!((0.0..=1.0).contains(&texture.alpha(Vec2::new(f32::MAX, f32::MIN))));
    }

    #[test]
    fn colours_are_means_of_linear_values() {
        let mut texture = two_pixels(Sampling::default());
        texture.rgba = vec![[0, 188, 0, 255], [255, 188, 0, 0]];
        let middle = texture.color(Vec2::new(0.5, 0.3));
        // 188 is the sRGB byte of a half.
        assert!((middle - Vec3::new(0.5, 0.503, 0.0)).length() < 1e-3, "{middle}");
        assert_eq!(texture.color(Vec2::NAN), Vec3::ZERO);
    }

    fn two_pixels(sampling: Sampling) -> Texture {
        Texture { name: "two".into(), width: 2, height: 1, rgba: vec![[0, 0, 0, 0], [0, 0, 0, 255]], sampling }
    }

    #[test]
    fn alpha_beyond_the_borders_is_mirrored_or_that_of_the_border() {
        let sampling = |wrap, filter| Sampling { wrap: [wrap, Wrap::Repeat], filter };
        for (wrap, at) in [
            (Wrap::Mirror, [(0.25, 0.0), (1.25, 1.0), (1.75, 0.0), (2.25, 0.0), (-0.75, 1.0), (1.0, 1.0), (1.5, 0.5)]),
            (Wrap::Clamp, [(0.25, 0.0), (1.25, 1.0), (1.75, 1.0), (9e9, 1.0), (-0.75, 0.0), (1.0, 1.0), (-9e9, 0.0)]),
        ] {
            let texture = two_pixels(sampling(wrap, Filter::Linear));
            at.iter().for_each(|&(u, want)| assert_eq!(texture.alpha(Vec2::new(u, 0.3)), want, "{wrap:?} {u}"));
        }
        let nearest = two_pixels(sampling(Wrap::Repeat, Filter::Nearest));
        for (u, want) in [(0.01, 0.0), (0.49, 0.0), (0.51, 1.0), (0.99, 1.0), (1.01, 0.0), (-0.01, 1.0)] {
            assert_eq!(nearest.alpha(Vec2::new(u, 0.3)), want, "nearest {u}");
        }
    }
}

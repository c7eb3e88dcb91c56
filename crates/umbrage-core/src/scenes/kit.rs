//! What the procedural scenes are made with: detail, chance, colours, placement.

use crate::environment::{Gradient, SkyPicture, direction_of, place_of_pixel};
use crate::light::{Light, LightShape};
use crate::material::Material;
use crate::{Image, Sky};
use glam::{DAffine3, DMat3, DVec3, Vec3};

/// How finely a scene is built; 1 is its normal state. Numbers of triangles or objects go by it.
#[derive(Clone, Copy)]
pub struct Detail(f64);

impl Detail {
    /// `detail` brought into `range`; what is no number counts as 1.
    pub fn within(detail: f32, range: std::ops::RangeInclusive<f32>) -> Self {
        let detail = if detail.is_nan() { 1.0 } else { detail };
        Self(f64::from(detail.clamp(*range.start(), *range.end())))
    }

    /// `normal` segments along one direction of a surface, changed so that its triangles go by the
    /// detail; at least `least`.
    pub fn segments(self, normal: u32, least: u32) -> u32 {
        ((f64::from(normal) * self.0.sqrt()).round() as u32).max(least)
    }

    /// `normal` objects, changed by the detail.
    pub fn count(self, normal: u32) -> u32 {
        (f64::from(normal) * self.0).round() as u32
    }
}

/// Random numbers that are the same on every run: SplitMix64 (Steele, Lea, Flood 2014).
pub struct Rng(u64);

impl Rng {
    /// A sequence of its own for every seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// A number in [low, high).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// One of 0 … n − 1; 0 for n = 0.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

/// A surface without highlight, linear RGB.
pub fn matte(r: f32, g: f32, b: f32) -> Material {
    Material { base_color: Vec3::new(r, g, b).extend(1.0), ..Material::default() }
}

/// A surface with a highlight, linear RGB.
pub fn glossy(r: f32, g: f32, b: f32) -> Material {
    Material { specular: 0.25, shininess: 40.0, ..matte(r, g, b) }
}

/// A surface that gives off light, linear RGB.
pub fn glowing(r: f32, g: f32, b: f32) -> Material {
    Material { emissive: Vec3::new(r, g, b), ..matte(0.0, 0.0, 0.0) }
}

/// Moves to `position`.
pub fn at(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

/// Stretches a unit shape to `size`, turns it by `turn_deg` around Y and centres it on `center`.
pub fn sized(center: DVec3, size: DVec3, turn_deg: f64) -> DAffine3 {
    let turn = DMat3::from_rotation_y(turn_deg.to_radians());
    DAffine3::from_mat3_translation(turn * DMat3::from_diagonal(size), center)
}

/// Like [`sized`], for a shape that stands on the height `ground.y`.
pub fn standing(ground: DVec3, size: DVec3, turn_deg: f64) -> DAffine3 {
    sized(ground + DVec3::Y * (size.y * 0.5), size, turn_deg)
}

/// The direction sunlight travels in that comes from `azimuth_deg` (from +Z towards +X) and
/// `elevation_deg` over the horizon.
pub fn sunlight(azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
    let (sin_e, cos_e) = elevation_deg.to_radians().sin_cos();
    -DVec3::new(sin_a * cos_e, sin_e, cos_a * cos_e)
}

/// A light of one colour, linear RGB.
pub fn light(shape: LightShape, color: [f32; 3], intensity: f32) -> Light {
    Light { color: Vec3::from(color), intensity, ..Light::new(shape) }
}

/// A sky without edges: blue above, pale at the horizon, dim below, and a broad sun, some twenty
/// degrees wide, in the direction `to_sun`.
pub fn soft_sky(to_sun: DVec3, sun: Vec3) -> Sky {
    let (zenith, horizon, nadir) = (Vec3::new(0.13, 0.21, 0.38), Vec3::new(0.36, 0.39, 0.42), Vec3::splat(0.1));
    let around = Sky::Gradient(Gradient { zenith, horizon, nadir });
    let size = (128, 64);
    let image = Image::from_fn(size.0, size.1, |x, y| {
        let direction = direction_of(place_of_pixel(size, x, y));
        let glow = (30.0 * (direction.dot(to_sun) - 1.0)).exp() as f32;
        (around.radiance(direction) + sun * glow).to_array()
    });
    SkyPicture::new(image).map_or(around, Sky::Picture)
}

/// Angular diameter of the sun seen from Earth, degrees.
pub const SUN_ANGLE_DEG: f64 = 0.53;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn detail_is_clamped_and_not_a_number_is_one() {
        let segments = |d| Detail::within(d, 0.05..=4.0).segments(100, 3);
        assert_eq!([segments(1.0), segments(4.0), segments(1e9), segments(f32::NAN)], [100, 200, 200, 100]);
        assert_eq!(Detail::within(-1.0, 0.05..=4.0).count(1000), 50);
    }

    #[test]
    fn random_numbers_are_the_known_ones_and_spread() {
        // The reference sequence of SplitMix64 with seed 1234567.
        assert_eq!(Rng::new(1_234_567).next(), 6_457_827_717_110_365_317);
        let mut rng = Rng::new(2);
        let mean = (0..100_000).map(|_| rng.range(2.0, 4.0)).sum::<f64>() / 100_000.0;
        assert!((mean - 3.0).abs() < 0.01, "{mean}");
        assert!((0..1000).all(|_| rng.below(7) < 7));
    }

    #[test]
    fn the_sun_shines_down_from_where_it_is_said_to_be() {
        let d = sunlight(90.0, 30.0);
        assert!(d.distance(DVec3::new(-0.75f64.sqrt(), -0.5, 0.0)) < 1e-12, "{d}");
    }
}

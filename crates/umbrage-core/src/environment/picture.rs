//! Equirectangular pictures.

use crate::Fnv;
use crate::image::Image;
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::{PI, TAU};
use std::fmt;
use std::sync::Arc;

/// A picture of everything around, whose pixels are finite and not negative.
#[derive(Clone, PartialEq)]
pub struct SkyPicture {
    image: Arc<Image<[f32; 3]>>,
    /// Of the pixels, so that text about it tells pictures apart.
    hash: u128,
}

/// The direction, a unit vector, that the point (u, v) of a picture shows; see the
/// [conventions](crate::environment).
pub fn direction_of(place: DVec2) -> DVec3 {
    let (sin_theta, cos_theta) = (PI * place.y).sin_cos();
    let (sin_phi, cos_phi) = (TAU * (place.x - 0.5)).sin_cos();
    DVec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi)
}

/// The point (u, v) of a picture that shows a direction, both 0…1; u is ½ at the poles.
pub fn place_of(direction: DVec3) -> DVec2 {
    // The arc tangent is exact near the poles, where the arc cosine is not.
    let theta = DVec2::new(direction.x, direction.z).length().atan2(direction.y);
    let phi = if direction.x == 0.0 && direction.z == 0.0 { 0.0 } else { direction.x.atan2(-direction.z) };
    DVec2::new((phi / TAU + 0.5).clamp(0.0, 1.0), theta / PI)
}

/// The point (u, v) where the pixel of a picture of this size is seen as it is; between these
/// points it is interpolated.
pub fn place_of_pixel((width, height): (u32, u32), x: u32, y: u32) -> DVec2 {
    let v = if height > 1 { f64::from(y) / f64::from(height - 1) } else { 0.5 };
    DVec2::new((f64::from(x) + 0.5) / f64::from(width.max(1)), v)
}

impl SkyPicture {
    /// Takes a picture in linear RGB, row 0 at +Y.
    ///
    /// # Errors
    /// What is wrong with it, and the remedy: no pixels, or not as many as its size tells; one that
    /// is not finite or below 0.
    pub fn new(image: Image<[f32; 3]>) -> Result<Self, String> {
        let (width, height) = image.size();
        if width == 0 || height == 0 || image.data.len() as u64 != u64::from(width) * u64::from(height) {
            let count = image.data.len();
            return Err(format!("has {count} pixels for {width} × {height}; hand over one or more, and all of them"));
        }
        let is_wrong = |p: &[f32; 3]| p.iter().any(|c| !(c.is_finite() && *c >= 0.0));
        if let Some(i) = image.data.iter().position(is_wrong) {
            let (x, y) = (i % width as usize, i / width as usize);
            let [r, g, b] = image.data[i];
            return Err(format!(
                "has the light {r}, {g}, {b} at pixel ({x}, {y}); radiance is finite and not negative: mend the picture"
            ));
        }
        let mut hash = Fnv::default();
        image.data.iter().flatten().for_each(|c| hash.add(&c.to_le_bytes()));
        Ok(Self { image: Arc::new(image), hash: hash.value() })
    }

    /// The pixels.
    pub fn image(&self) -> &Image<[f32; 3]> {
        &self.image
    }

    /// What is seen in a direction: interpolated between four pixels, and around the picture from
    /// its right to its left side.
    pub fn radiance(&self, direction: DVec3) -> Vec3 {
        let Image { width, height, .. } = *self.image;
        let place = place_of(direction);
        let place = DVec2::new(place.x * f64::from(width) - 0.5, place.y * f64::from(height - 1));
        let low = place.floor();
        let part = (place - low).as_vec2();
        let x = |x: f64| (x as i64).rem_euclid(i64::from(width)) as u32;
        let y = |y: f64| (y as u32).min(height - 1);
        let at = |x, y| Vec3::from(self.image[(x, y)]);
        let (x0, x1, y0, y1) = (x(low.x), x(low.x + 1.0), y(low.y), y(low.y + 1.0));
        at(x0, y0).lerp(at(x1, y0), part.x).lerp(at(x0, y1).lerp(at(x1, y1), part.x), part.y)
    }
}

impl fmt::Debug for SkyPicture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "SkyPicture({} × {}, {:032x})", self.image.width, self.image.height, self.hash)
    }
}

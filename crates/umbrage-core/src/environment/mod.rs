//! The light that comes from all around: a sky that may be turned.
//!
//! # Conventions
//! A picture of the sky is equirectangular. Row 0 is +Y. With u from 0 (left) to 1 (right) and v
//! from 0 (top) to 1 (bottom) its point shows the direction (sin θ sin φ, cos θ, −sin θ cos φ), θ =
//! π v, φ = 2π (u − ½): the middle of the picture is −Z, three quarters is +X. See
//! [`direction_of`]. Columns are spread evenly around, so that the middle of the first is half a
//! column from the left side; rows from pole to pole, so that the first is seen at +Y itself and
//! the last at −Y: [`place_of_pixel`]. In between both are interpolated.

mod daylight;
mod picture;
mod sampler;

pub use daylight::{Daylight, Sun};
pub use picture::{SkyPicture, direction_of, place_of, place_of_pixel};
pub use sampler::EnvironmentSampler;

use crate::image::Image;
use crate::light::{Light, LightShape};
use glam::{DMat3, DVec2, DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// A sky around the scene, infinitely far away.
///
/// A copy costs next to nothing: pictures are shared.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    /// What is seen where, before it is turned.
    pub sky: Sky,
    /// How far the sky is turned about +Y, degrees: what [`Self::sky`] shows in direction d is seen
    /// in direction R d, R x = (x cos a + z sin a, y, z cos a − x sin a).
    pub rotate_deg: f64,
    /// Multiplies the sky's radiance; finite, 0 and up.
    pub intensity: f32,
}

/// What is seen in every direction: radiance, linear RGB.
#[derive(Clone, Debug, PartialEq)]
pub enum Sky {
    /// The same from everywhere.
    Constant(Vec3),
    /// From the horizon up and down.
    Gradient(Gradient),
    /// A picture all around.
    Picture(SkyPicture),
    /// A clear sky by day, with its sun.
    Daylight(Daylight),
}

/// Three colours. In between radiance goes with the sine of the elevation, so that a horizontal
/// plane that faces up gets the irradiance π (horizon + 2 zenith) / 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    /// Radiance from +Y.
    pub zenith: Vec3,
    /// Radiance from the horizon.
    pub horizon: Vec3,
    /// Radiance from −Y.
    pub nadir: Vec3,
}

impl Environment {
    /// A sky as it is: not turned, of intensity 1.
    pub fn new(sky: Sky) -> Self {
        Self { sky, rotate_deg: 0.0, intensity: 1.0 }
    }

    /// What comes from `direction`, a unit vector **to** where it comes from: radiance, linear RGB.
    /// Between the middles of a picture's pixels it is interpolated.
    pub fn radiance(&self, direction: DVec3) -> Vec3 {
        self.sky.radiance(self.sky_from_world() * direction) * self.intensity
    }

    /// Turns a direction of the world into that of the sky.
    pub fn sky_from_world(&self) -> DMat3 {
        self.world_from_sky().transpose()
    }

    /// Turns a direction of the sky into that of the world.
    pub fn world_from_sky(&self) -> DMat3 {
        DMat3::from_rotation_y(self.rotate_deg.to_radians())
    }

    /// The environment as one more light: what techniques that answer with radiance get. Its colour
    /// is white and its intensity 1, since the environment has its own.
    pub fn light(&self) -> Light {
        Light::new(LightShape::Environment(self.clone()))
    }

    /// What is wrong with an environment that can't shine, and the remedy.
    ///
    /// # Errors
    /// A number that is not finite or below 0; a sun below the horizon.
    pub fn check(&self) -> Result<(), String> {
        let Self { rotate_deg, intensity, .. } = *self;
        if !rotate_deg.is_finite() {
            return Err(format!("the environment is turned by {rotate_deg}°; make it finite"));
        }
        let is_fine = |v: f32| v.is_finite() && v >= 0.0;
        if !is_fine(intensity) {
            return Err(format!("the environment has the intensity {intensity}; make it finite and at least 0"));
        }
        let color = |c: Vec3, what: &str| match c.to_array().into_iter().all(is_fine) {
            true => Ok(()),
            false => Err(format!("the environment's {what} is {c}; make it finite and at least 0")),
        };
        match &self.sky {
            Sky::Constant(c) => color(*c, "color"),
            Sky::Gradient(Gradient { zenith, horizon, nadir }) => {
                [(zenith, "zenith"), (horizon, "horizon"), (nadir, "nadir")]
                    .into_iter()
                    .try_for_each(|(c, what)| color(*c, what))
            }
            // Both were checked when they were made.
            Sky::Picture(_) | Sky::Daylight(_) => Ok(()),
        }
    }
}

impl Sky {
    /// What comes from `direction`, a unit vector, before the sky is turned.
    pub fn radiance(&self, direction: DVec3) -> Vec3 {
        match self {
            Self::Constant(color) => *color,
            Self::Gradient(gradient) => gradient.radiance(direction),
            Self::Picture(picture) => picture.radiance(direction),
            Self::Daylight(daylight) => daylight.radiance(direction),
        }
    }

    /// True for copies of a sky, told without a look at the pixels of pictures, which they share.
    pub fn is_copy_of(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Picture(a), Self::Picture(b)) => std::ptr::eq(a.image(), b.image()),
            _ => self == other,
        }
    }

    /// The sun, where it is apart from the rest.
    pub fn sun(&self) -> Option<&Sun> {
        match self {
            Self::Daylight(daylight) => Some(daylight.sun()),
            _ => None,
        }
    }

    /// The same without its sun, if that is apart.
    pub(crate) fn radiance_without_sun(&self, direction: DVec3) -> Vec3 {
        match self {
            Self::Daylight(daylight) => daylight.sky_radiance(direction),
            _ => self.radiance(direction),
        }
    }

    /// Means of the sky before it is turned over the rectangles of an equirectangular grid, both
    /// sides over 0: no light is lost, however small a sun is. The sum over pixels times their
    /// [`solid_angle`] is the integral over the sphere.
    pub fn picture(&self, width: u32, height: u32) -> Image<[f32; 3]> {
        let mut fine = 4;
        if let Self::Picture(picture) = self {
            let (w, h) = picture.image().size();
            fine = fine.max(2 * w.div_ceil(width.max(1)).max(h.div_ceil(height.max(1))));
        }
        let mut image = Image::from_fn(width, height, |x, y| {
            let at = DVec2::new(x.into(), y.into());
            let mut sum = (DVec3::ZERO, 0.0);
            for place in (0..fine * fine).map(|i| DVec2::new((i % fine).into(), (i / fine).into())) {
                let place = at + (place + 0.5) / f64::from(fine);
                let direction = direction_of(place / DVec2::new(width.into(), height.into()));
                let weight = DVec2::new(direction.x, direction.z).length();
                sum = (sum.0 + self.radiance_without_sun(direction).as_dvec3() * weight, sum.1 + weight);
            }
            (sum.0 / sum.1.max(f64::MIN_POSITIVE)).as_vec3().to_array()
        });
        if let Some(sun) = self.sun() {
            sun.add_to(&mut image);
        }
        image
    }
}

impl Gradient {
    fn radiance(&self, direction: DVec3) -> Vec3 {
        let y = direction.y.clamp(-1.0, 1.0) as f32;
        self.horizon.lerp(if y >= 0.0 { self.zenith } else { self.nadir }, y.abs())
    }
}

/// The solid angle of a rectangle of an equirectangular picture of `height` rows and `width`
/// columns, one pixel large, in row `y`.
pub fn solid_angle(width: u32, height: u32, y: u32) -> f64 {
    let cos = |y: u32| (PI * f64::from(y) / f64::from(height)).cos();
    TAU / f64::from(width) * (cos(y) - cos(y + 1))
}

#[cfg(test)]
mod tests;

//! A clear sky by day: Preetham, Shirley, Smits, "A Practical Analytic Model for Daylight", 1999.

use super::{direction_of, place_of, solid_angle};
use crate::image::Image;
use crate::sampling::{lattice, square_to_disc};
use glam::{DMat3, DVec2, DVec3, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A clear sky, its sun, and what the ground below the horizon reflects. Radiance is in thousands
/// of candela a square metre: an intensity of 0.05 or so suits a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Daylight {
    sun: Sun,
    turbidity: f64,
    ground: Vec3,
    /// Luminance and chromaticity (Y, x, y) over [`Self::perez`] towards the zenith.
    zenith: DVec3,
    /// What the ground sends up.
    ground_radiance: Vec3,
}

/// A bright disc in the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Unit vector to its middle.
    pub direction: DVec3,
    /// Angular diameter, degrees.
    pub angle_deg: f64,
    /// Radiance, linear RGB.
    pub radiance: Vec3,
}

/// Illuminance of the sun outside the atmosphere, thousands of lux.
const EXTRATERRESTRIAL: f64 = 128.0;

/// Wavelengths of the three colours, micrometres: those that the primaries of sRGB look like.
const WAVELENGTHS: [f64; 3] = [0.611, 0.549, 0.464];

/// Absorption of ozone there, a centimetre of it (table 2 of the paper, interpolated).
const OZONE: [f64; 3] = [0.118, 0.084, 0.007];

/// How much ozone there is, centimetres.
const OZONE_DEPTH: f64 = 0.35;

impl Daylight {
    /// The sun's angular diameter as it is seen from the Earth, degrees.
    pub const SUN_ANGLE_DEG: f64 = 0.53;

    /// A sky with the sun in the direction `to_sun`, of `sun_angle_deg` degrees in diameter, and a
    /// ground of the reflectance `ground`. `turbidity` is how hazy the air is: 2 is very clear, 10
    /// a haze.
    ///
    /// # Errors
    /// What is wrong, and the remedy: a sun that is not above the horizon, or of an angle out of
    /// 0.05 to 90; a turbidity out of 2 to 10; a reflectance out of 0 to 1.
    pub fn new(to_sun: DVec3, turbidity: f64, ground: Vec3, sun_angle_deg: f64) -> Result<Self, String> {
        let Some(direction) = to_sun.try_normalize().filter(|d| d.y > 0.0) else {
            return Err(format!("has its sun in the direction {to_sun}; the model needs it above the horizon"));
        };
        if !(2.0..=10.0).contains(&turbidity) {
            return Err(format!("has the turbidity {turbidity}; the model is for 2 (very clear) to 10 (hazy)"));
        }
        if !(0.05..=90.0).contains(&sun_angle_deg) {
            return Err(format!("has a sun of {sun_angle_deg}° in diameter; make it 0.05 to 90"));
        }
        if !ground.to_array().into_iter().all(|c| (0.0..=1.0).contains(&c)) {
            return Err(format!("has the ground {ground}; what reflects is from 0 to 1"));
        }
        let radiance =
            sun_irradiance(direction.y, turbidity) / (TAU * (1.0 - (sun_angle_deg.to_radians() * 0.5).cos()));
        let sun = Sun { direction, angle_deg: sun_angle_deg, radiance: radiance.as_vec3() };
        let zenith = zenith(direction.y.clamp(0.0, 1.0).acos(), turbidity);
        let mut sky = Self { sun, turbidity, ground, zenith, ground_radiance: Vec3::ZERO };
        sky.zenith /= sky.perez(1.0, direction.y);
        sky.ground_radiance = sky.irradiance_above() * ground / std::f32::consts::PI;
        Ok(sky)
    }

    /// The sun.
    pub fn sun(&self) -> &Sun {
        &self.sun
    }

    /// How hazy the air is.
    pub fn turbidity(&self) -> f64 {
        self.turbidity
    }

    /// Reflectance of the ground.
    pub fn ground(&self) -> Vec3 {
        self.ground
    }

    pub(super) fn radiance(&self, direction: DVec3) -> Vec3 {
        let sun = if self.sun.holds(direction) { self.sun.radiance } else { Vec3::ZERO };
        self.sky_radiance(direction) + sun
    }

    /// The same without the sun.
    pub(super) fn sky_radiance(&self, direction: DVec3) -> Vec3 {
        if direction.y <= 0.0 {
            return self.ground_radiance;
        }
        let [luminance, x, y] =
            (self.zenith * self.perez(direction.y, direction.dot(self.sun.direction))).max(DVec3::ZERO).to_array();
        let y = y.max(1e-6);
        rgb_from_xyz(DVec3::new(x / y, 1.0, (1.0 - x - y) / y) * luminance).max(DVec3::ZERO).as_vec3()
    }

    /// The distribution of Perez, for luminance and both chromaticities: of the cosines from the
    /// zenith and from the sun.
    fn perez(&self, cos_zenith: f64, cos_sun: f64) -> DVec3 {
        let t = self.turbidity;
        let a = DVec3::new(0.1787 * t - 1.4630, -0.0193 * t - 0.2592, -0.0167 * t - 0.2608);
        let b = DVec3::new(-0.3554 * t + 0.4275, -0.0665 * t + 0.0008, -0.0950 * t + 0.0092);
        let c = DVec3::new(-0.0227 * t + 5.3251, -0.0004 * t + 0.2125, -0.0079 * t + 0.2102);
        let d = DVec3::new(0.1206 * t - 2.5771, -0.0641 * t - 0.8989, -0.0441 * t - 1.6537);
        let e = DVec3::new(-0.0670 * t + 0.3703, -0.0033 * t + 0.0452, -0.0109 * t + 0.0529);
        let cos_sun = cos_sun.clamp(-1.0, 1.0);
        (1.0 + a * (b / cos_zenith.max(1e-3)).exp()) * (1.0 + c * (d * cos_sun.acos()).exp() + e * cos_sun * cos_sun)
    }

    /// What falls on the ground from sun and sky.
    fn irradiance_above(&self) -> Vec3 {
        const ROWS: u32 = 32;
        let sun = self.sun.radiance.as_dvec3() * self.sun.solid_angle() * self.sun.direction.y;
        let mut sum = sun;
        for y in 0..ROWS / 2 {
            for x in 0..2 * ROWS {
                let place =
                    DVec2::new((f64::from(x) + 0.5) / f64::from(2 * ROWS), (f64::from(y) + 0.5) / f64::from(ROWS));
                let direction = direction_of(place);
                let weight = solid_angle(2 * ROWS, ROWS, y) * direction.y;
                sum += self.sky_radiance(direction).as_dvec3() * weight;
            }
        }
        sum.as_vec3()
    }
}

impl Sun {
    /// Of its disc, steradians.
    pub fn solid_angle(&self) -> f64 {
        TAU * (1.0 - self.cos())
    }

    /// True where the unit vector `direction` goes to a point of it.
    pub fn holds(&self, direction: DVec3) -> bool {
        direction.dot(self.direction) >= self.cos()
    }

    /// The direction to the point of its disc that belongs to `u` in [0, 1]²; equal areas of the
    /// square go to equal solid angles.
    pub fn sample(&self, u: DVec2) -> DVec3 {
        let disc = square_to_disc(u);
        // Lambert's projection, which keeps areas: 1 − cos goes with the square of the radius.
        let fall = (1.0 - self.cos()) * disc.length_squared();
        let out = disc.normalize_or_zero() * (fall * (2.0 - fall)).max(0.0).sqrt();
        let (a, b) = self.direction.any_orthonormal_pair();
        DMat3::from_cols(a, b, self.direction) * out.extend(1.0 - fall)
    }

    fn cos(&self) -> f64 {
        (self.angle_deg.to_radians() * 0.5).cos()
    }

    /// Adds its light to the pixels of a picture that it is seen in.
    pub(super) fn add_to(&self, image: &mut Image<[f32; 3]>) {
        const POINTS: usize = 4096;
        let (width, height) = image.size();
        let light = self.radiance.as_dvec3() * self.solid_angle() / POINTS as f64;
        for u in lattice(POINTS) {
            let place = place_of(self.sample(u)) * DVec2::new(width.into(), height.into());
            let (x, y) = ((place.x as u32).min(width - 1), (place.y as u32).min(height - 1));
            let added = (light / solid_angle(width, height, y)).as_vec3();
            let pixel = &mut image[(x, y)];
            *pixel = (Vec3::from(*pixel) + added).to_array();
        }
    }
}

/// Luminance and chromaticity of the zenith: equations of the paper's appendix A.2, for the sun's
/// angle from it.
fn zenith(sun: f64, t: f64) -> DVec3 {
    let chi = (4.0 / 9.0 - t / 120.0) * (PI - 2.0 * sun.min(FRAC_PI_2));
    let luminance = (4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192;
    let cubic = |c: [f64; 4]| ((c[0] * sun + c[1]) * sun + c[2]) * sun + c[3];
    let in_haze = |rows: [[f64; 4]; 3]| (cubic(rows[0]) * t + cubic(rows[1])) * t + cubic(rows[2]);
    let x = in_haze([
        [0.00166, -0.00375, 0.00209, 0.0],
        [-0.02903, 0.06377, -0.03202, 0.00394],
        [0.11693, -0.21196, 0.06052, 0.25886],
    ]);
    let y = in_haze([
        [0.00275, -0.00610, 0.00317, 0.0],
        [-0.04214, 0.08970, -0.04153, 0.00516],
        [0.15346, -0.26756, 0.06670, 0.26688],
    ]);
    DVec3::new(luminance.max(0.0), x, y)
}

/// What falls on a plane across the sun's rays: what the air lets through (appendix A.1) of white
/// light. Water vapour and mixed gases hardly absorb at these wavelengths.
fn sun_irradiance(cos_zenith: f64, t: f64) -> DVec3 {
    let degrees = cos_zenith.clamp(0.0, 1.0).acos().to_degrees();
    let mass = 1.0 / (cos_zenith.max(0.0) + 0.15 * (93.885 - degrees).powf(-1.253));
    let haze = 0.046_083_65 * t - 0.045_860_25;
    let through = |i: usize| {
        let rayleigh = 0.008_735 * WAVELENGTHS[i].powf(-4.08);
        let aerosol = haze * WAVELENGTHS[i].powf(-1.3);
        (-(rayleigh + aerosol + OZONE[i] * OZONE_DEPTH) * mass).exp()
    };
    DVec3::new(through(0), through(1), through(2)) * EXTRATERRESTRIAL
}

/// Linear sRGB (IEC 61966-2-1).
fn rgb_from_xyz(xyz: DVec3) -> DVec3 {
    DVec3::new(
        xyz.dot(DVec3::new(3.240_625_5, -1.537_208, -0.498_628_6)),
        xyz.dot(DVec3::new(-0.968_930_7, 1.875_756_1, 0.041_517_5)),
        xyz.dot(DVec3::new(0.055_710_1, -0.204_021_1, 1.056_995_9)),
    )
}

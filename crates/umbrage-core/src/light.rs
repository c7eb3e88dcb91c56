//! Lights as data: every kind that the scene file knows.

use crate::environment::Environment;
use glam::{DMat3, DVec2, DVec3, DVec4, Vec3};

/// One light: its shape and place, and what it gives off.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Kind, place and size.
    pub shape: LightShape,
    /// Linear RGB.
    pub color: Vec3,
    /// Multiplies `color`.
    pub intensity: f32,
    /// Constant, linear and quadratic attenuation: light falls by 1 / (c + l·d + q·d²), and is
    /// never stronger than without (PX 2.2.4).
    pub attenuation: Vec3,
    /// No light beyond this distance, metres.
    pub range: Option<f64>,
    /// False: this light casts no shadow; its visibility is 1 everywhere.
    pub casts: bool,
}

impl Light {
    /// A white light of intensity 1 without attenuation.
    pub fn new(shape: LightShape) -> Self {
        Self {
            shape,
            color: Vec3::ONE,
            intensity: 1.0,
            attenuation: Vec3::new(1.0, 0.0, 0.0),
            range: None,
            casts: true,
        }
    }
}

/// Shape and place of a light, metres in world space.
#[derive(Clone, Debug, PartialEq)]
pub enum LightShape {
    /// Light from one point to all sides.
    Point {
        /// Where it is.
        position: DVec3,
    },
    /// Light from one point within a cone.
    Spot {
        /// Where it is.
        position: DVec3,
        /// The way the light travels, unit length.
        direction: DVec3,
        /// Half angle of the cone of full strength, degrees.
        inner_angle_deg: f64,
        /// Half angle at which the light has fallen to nothing, degrees; at least the inner one.
        outer_angle_deg: f64,
    },
    /// Parallel light, or with an angle a cone of directions such as the sun's.
    Directional {
        /// The way the light travels, unit length.
        direction: DVec3,
        /// Angular diameter, degrees; 0 is a hard light.
        angle_deg: f64,
    },
    /// A sphere.
    Sphere {
        /// Centre.
        position: DVec3,
        /// Radius.
        radius: f64,
    },
    /// A stretched sphere.
    Ellipsoid {
        /// Centre.
        position: DVec3,
        /// Half axes before rotation.
        radii: DVec3,
        /// Turns the half axes, a rotation.
        rotation: DMat3,
    },
    /// A flat disc.
    Disc {
        /// Centre.
        position: DVec3,
        /// Its emitting side, unit length.
        direction: DVec3,
        /// Radius.
        radius: f64,
    },
    /// A flat rectangle.
    Rect {
        /// Centre.
        position: DVec3,
        /// Its emitting side, unit length.
        direction: DVec3,
        /// Its second axis, unit length, perpendicular to `direction`.
        up: DVec3,
        /// Width across `up`, height along it.
        size: DVec2,
        /// Index into [`crate::Scene::textures`]: what it shows, weighting its points by luminance.
        /// Row 0 is on the side of `up`, column 0 on the left for somebody who looks at the
        /// emitting side.
        texture: Option<usize>,
    },
    /// A thin tube.
    Line {
        /// One end.
        from: DVec3,
        /// The other end.
        to: DVec3,
    },
    /// The sky all around. It is no `[[light]]` but the scene's [`crate::Scene::environment`], and
    /// its answer is radiance.
    Environment(Environment),
}

/// The kinds of light, without their data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LightKind {
    /// See [`LightShape::Point`].
    Point,
    /// See [`LightShape::Spot`].
    Spot,
    /// [`LightShape::Directional`] with angle 0.
    Directional,
    /// [`LightShape::Directional`] with an angle.
    Sun,
    /// See [`LightShape::Sphere`].
    Sphere,
    /// See [`LightShape::Ellipsoid`].
    Ellipsoid,
    /// See [`LightShape::Disc`].
    Disc,
    /// See [`LightShape::Rect`].
    Rect,
    /// See [`LightShape::Line`].
    Line,
    /// See [`LightShape::Environment`].
    Environment,
}

impl LightKind {
    /// All that a `[[light]]` can be, in the order of the scene file's table: those that a surface
    /// sees a share of. [`Self::Environment`] is not among them.
    pub const ALL: [Self; 9] = [
        Self::Point,
        Self::Spot,
        Self::Directional,
        Self::Sun,
        Self::Sphere,
        Self::Ellipsoid,
        Self::Disc,
        Self::Rect,
        Self::Line,
    ];

    /// The name users see: that of the scene file, and `sun` for a directional light with an angle.
    pub fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Spot => "spot",
            Self::Directional => "directional",
            Self::Sun => "sun",
            Self::Sphere => "sphere",
            Self::Ellipsoid => "ellipsoid",
            Self::Disc => "disc",
            Self::Rect => "rect",
            Self::Line => "line",
            Self::Environment => "environment",
        }
    }

    /// True where the light has an extent, so that shadows have penumbras.
    pub fn is_soft(self) -> bool {
        !matches!(self, Self::Point | Self::Spot | Self::Directional)
    }
}

/// A set of light kinds: what a technique can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightKinds(u16);

impl LightKinds {
    /// Every kind that a `[[light]]` can be, see [`LightKind::ALL`].
    pub const ALL: Self = Self::of(&LightKind::ALL);
    /// Those without extent.
    pub const HARD: Self = Self::of(&[LightKind::Point, LightKind::Spot, LightKind::Directional]);

    /// The set of `kinds`.
    pub const fn of(kinds: &[LightKind]) -> Self {
        let (mut bits, mut i) = (0, 0);
        while i < kinds.len() {
            bits |= 1 << kinds[i] as u16;
            i += 1;
        }
        Self(bits)
    }

    /// True where `kind` is in the set.
    pub const fn contains(self, kind: LightKind) -> bool {
        self.0 >> kind as u16 & 1 == 1
    }

    /// The kinds in the set, in the order of [`LightKind::ALL`], the environment last.
    pub fn iter(self) -> impl Iterator<Item = LightKind> {
        LightKind::ALL.into_iter().chain([LightKind::Environment]).filter(move |k| self.contains(*k))
    }
}

impl LightShape {
    /// Which kind it is. A shape without extent is still of its own kind: a sphere of radius 0 is a
    /// sphere.
    pub fn kind(&self) -> LightKind {
        match self {
            Self::Point { .. } => LightKind::Point,
            Self::Spot { .. } => LightKind::Spot,
            Self::Directional { angle_deg, .. } if *angle_deg > 0.0 => LightKind::Sun,
            Self::Directional { .. } => LightKind::Directional,
            Self::Sphere { .. } => LightKind::Sphere,
            Self::Ellipsoid { .. } => LightKind::Ellipsoid,
            Self::Disc { .. } => LightKind::Disc,
            Self::Rect { .. } => LightKind::Rect,
            Self::Line { .. } => LightKind::Line,
            Self::Environment(_) => LightKind::Environment,
        }
    }

    /// The light's centre in homogeneous coordinates: a point with w = 1, or with w = 0 the
    /// direction **to** a directional light; for the environment, up.
    pub fn center(&self) -> DVec4 {
        match *self {
            Self::Directional { direction, .. } => (-direction).extend(0.0),
            Self::Environment(_) => DVec3::Y.extend(0.0),
            Self::Line { from, to } => ((from + to) * 0.5).extend(1.0),
            Self::Point { position }
            | Self::Spot { position, .. }
            | Self::Sphere { position, .. }
            | Self::Ellipsoid { position, .. }
            | Self::Disc { position, .. }
            | Self::Rect { position, .. } => position.extend(1.0),
        }
    }

    /// Vector from `p` to the light's centre; of unit length for a directional light.
    pub fn to_center(&self, p: DVec3) -> DVec3 {
        let c = self.center();
        c.truncate() - p * c.w
    }

    /// Moves the light, metres. Parallel light and the sky stay: they come from everywhere.
    pub fn shift(&mut self, by: DVec3) {
        match self {
            Self::Directional { .. } | Self::Environment(_) => {}
            Self::Line { from, to } => {
                *from += by;
                *to += by;
            }
            Self::Point { position }
            | Self::Spot { position, .. }
            | Self::Sphere { position, .. }
            | Self::Ellipsoid { position, .. }
            | Self::Disc { position, .. }
            | Self::Rect { position, .. } => *position += by,
        }
    }

    /// Radius of the smallest known sphere around [`LightShape::center`] that contains the light; 0
    /// for hard lights. For a sun, the sine of half its angle: the radius at distance 1; for the
    /// environment 1.
    pub fn radius(&self) -> f64 {
        match *self {
            Self::Point { .. } | Self::Spot { .. } => 0.0,
            Self::Directional { angle_deg, .. } => (angle_deg.to_radians() * 0.5).sin(),
            Self::Sphere { radius, .. } | Self::Disc { radius, .. } => radius,
            Self::Ellipsoid { radii, .. } => radii.max_element(),
            Self::Rect { size, .. } => size.length() * 0.5,
            Self::Line { from, to } => from.distance(to) * 0.5,
            Self::Environment(_) => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_form_sets() {
        assert_eq!(LightKinds::ALL.iter().count(), 9);
        assert!(LightKinds::HARD.iter().all(|k| !k.is_soft()));
        assert!(!LightKinds::HARD.contains(LightKind::Sun));
    }

    #[test]
    fn a_sun_is_a_directional_light_with_an_angle() {
        let at = |angle_deg| LightShape::Directional { direction: DVec3::NEG_Y, angle_deg }.kind();
        assert_eq!((at(0.0), at(0.5)), (LightKind::Directional, LightKind::Sun));
    }
}

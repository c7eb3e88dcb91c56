//! Where the light of a light can be: within its range and, for a spot, its cone.

use crate::{
    bounds::Bounds,
    camera::CameraView,
    convex::Convex,
    light::{Light, LightShape},
    view_body::ViewBody,
    volume::{Side, Sphere, Volume},
};
use glam::{DVec3, DVec4};

/// The box around all that a light can light: its range, cut to the cone for a spot. `None` where
/// that is without limit: for a directional light, and where there is no range.
pub fn reach(light: &Light) -> Option<Bounds> {
    let sector = Sector::of(light)?;
    sector.range.is_finite().then(|| sector.bounds())
}

/// False only where no point of the box is within the range and the cone of the light. The shadow
/// of a caster there is where there is no light either.
pub fn may_be_reached(light: &Light, bounds: &Bounds) -> bool {
    let Some(sector) = Sector::of(light) else { return !bounds.is_empty() };
    let ball = Sphere { center: sector.apex, radius: sector.range };
    ball.side(bounds) != Side::Outside
        && sector.bounds().side(bounds) != Side::Outside
        && !sector.is_parted_from(&bounds.corners().map(|c| (c - sector.apex).extend(1.0)))
}

/// False only where the light reaches no point that the camera can see.
pub fn may_light_view(light: &Light, camera: &CameraView) -> bool {
    let Some(sector) = Sector::of(light) else { return true };
    let view = ViewBody::of(camera);
    let corners = view.corners();
    let apex = view.relative(sector.apex.extend(1.0)).truncate();
    let reached = |plane: &DVec4| {
        let normal = plane.truncate();
        normal.dot(apex) + plane.w + sector.farthest(normal) >= -sector.rounding
    };
    Convex::hull_about(DVec3::ZERO, &corners).planes().iter().all(reached)
        && !sector.is_parted_from(&corners.map(|c| (c.truncate() - apex * c.w).extend(c.w)))
}

/// The part of a sphere that is within a cone from its centre.
struct Sector {
    apex: DVec3,
    direction: DVec3,
    /// Sine and cosine of the angle between the axis and the side of the cone; 180 degrees for the
    /// whole sphere.
    sin: f64,
    cos: f64,
    /// Infinite where there is no limit.
    range: f64,
    /// Lengths below this may be due to rounding, metres.
    rounding: f64,
}

impl Sector {
    /// `None` for a directional light, which reaches everything.
    fn of(light: &Light) -> Option<Self> {
        let center = light.shape.center();
        if center.w == 0.0 {
            return None;
        }
        let apex = center.truncate();
        // What lies between a point of the light and one within the range is in the sphere only if
        // the light is.
        let range = light.range.map_or(f64::INFINITY, |r| r.max(light.shape.radius()));
        let limited = if range.is_finite() { range } else { 0.0 };
        let rounding = 1e-12 * (apex.abs().max_element() + limited);
        let (direction, angle_deg) = match light.shape {
            LightShape::Spot { direction, outer_angle_deg, .. } => (direction, outer_angle_deg.clamp(0.0, 180.0)),
            _ => (DVec3::X, 180.0),
        };
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        Some(Self { apex, direction, sin, cos, range: range + rounding, rounding })
    }

    /// How far the sector reaches from its apex along a unit vector.
    fn farthest(&self, along: DVec3) -> f64 {
        let cos = self.direction.dot(along);
        // Cosine of the angle to the nearest direction in the cone.
        let nearest = match cos >= self.cos {
            true => 1.0,
            false => cos * self.cos + (1.0 - cos * cos).max(0.0).sqrt() * self.sin,
        };
        if nearest > 0.0 { self.range * nearest } else { 0.0 }
    }

    fn bounds(&self) -> Bounds {
        let max = DVec3::from(DVec3::AXES.map(|axis| self.farthest(axis)));
        let min = DVec3::from(DVec3::AXES.map(|axis| self.farthest(-axis)));
        Bounds { min: self.apex - min, max: self.apex + max }.grown(self.rounding)
    }

    /// Whether a plane through the apex has the cone on one side and all of the points, given
    /// relative to the apex, on the other. Planes across the axis and those that touch the cone
    /// towards a point, or the middle of all, are tried.
    fn is_parted_from(&self, points: &[DVec4]) -> bool {
        // A cone of more than a half-space has no such plane.
        if self.cos < 0.0 {
            return false;
        }
        let beyond = |normal: DVec3| {
            points.iter().all(|p| normal.dot(p.truncate()) > 1e-12 * p.truncate().length() + self.rounding * p.w)
        };
        let touching = |toward: DVec3| {
            let across = toward - self.direction * self.direction.dot(toward);
            across.normalize_or_zero() * self.cos - self.direction * self.sin
        };
        let middle = points.iter().map(|p| p.truncate()).sum();
        let towards = points.iter().map(|p| p.truncate()).chain([middle]);
        beyond(-self.direction) || towards.map(touching).any(beyond)
    }
}

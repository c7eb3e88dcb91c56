//! Whether a light can shine, and its directions made to unit length: what hosts hand over is as
//! their own arithmetic left it.

use crate::light::{Light, LightShape};
use glam::{DMat3, DVec3};

/// Lengths that differ from 1 by less are those of unit vectors, which single precision leaves so.
const UNIT: f64 = 1e-6;

impl Light {
    /// The same light with directions of unit length, and the second axis of a rectangle
    /// perpendicular to the first; `None` where it is so already.
    ///
    /// # Errors
    /// What is wrong with a light that can't shine, and the remedy: a place, a size or an angle
    /// that is not finite or out of its range, a direction without length.
    pub fn usable(&self) -> Result<Option<Self>, String> {
        let kind = self.shape.kind().name();
        let usable = || {
            let shape = usable_shape(&self.shape)?;
            if !(self.color.is_finite() && self.intensity.is_finite() && self.attenuation.is_finite()) {
                let (color, intensity, attenuation) = (self.color, self.intensity, self.attenuation);
                return Err(format!(
                    "gives off {intensity} × {color}, attenuated by {attenuation}; make these numbers finite"
                ));
            }
            if let Some(range) = self.range.filter(|range| !(range.is_finite() && *range > 0.0)) {
                return Err(format!("has a range of {range} m; make it finite and over 0, or leave it out"));
            }
            Ok((shape != self.shape).then(|| Self { shape, ..self.clone() }))
        };
        usable().map_err(|what| format!("the {kind} light {what}"))
    }
}

fn usable_shape(shape: &LightShape) -> Result<LightShape, String> {
    let mut made = shape.clone();
    match &mut made {
        LightShape::Point { position } => finite("is at", *position)?,
        LightShape::Spot { position, direction, inner_angle_deg, outer_angle_deg } => {
            finite("is at", *position)?;
            make_unit("direction", direction)?;
            let (inner, outer) = (*inner_angle_deg, *outer_angle_deg);
            if !(0.0 <= inner && inner <= outer && 0.0 < outer && outer < 90.0) {
                return Err(format!(
                    "has half angles of {inner}° and {outer}°; make them at least 0° and below 90°, the inner one no \
                     larger than the outer one"
                ));
            }
        }
        LightShape::Directional { direction, angle_deg } => {
            make_unit("direction", direction)?;
            if !(0.0..180.0).contains(angle_deg) {
                return Err(format!("is {angle_deg}° across; make it at least 0° and below 180°"));
            }
        }
        LightShape::Sphere { position, radius } => {
            finite("is at", *position)?;
            at_least_0("a radius", *radius)?;
        }
        LightShape::Ellipsoid { position, radii, rotation } => {
            finite("is at", *position)?;
            radii.to_array().into_iter().try_for_each(|radius| at_least_0("a half axis", radius))?;
            let off = rotation.transpose() * *rotation - DMat3::IDENTITY;
            let is_rotation = off.to_cols_array().into_iter().all(|x| x.abs() < 1e-3) && rotation.determinant() > 0.0;
            if !is_rotation {
                return Err(format!("is turned by {rotation}, which is no rotation; make its columns unit vectors"));
            }
        }
        LightShape::Disc { position, direction, radius } => {
            finite("is at", *position)?;
            make_unit("direction", direction)?;
            at_least_0("a radius", *radius)?;
        }
        LightShape::Rect { position, direction, up, size, .. } => {
            finite("is at", *position)?;
            make_unit("direction", direction)?;
            make_unit("up", up)?;
            size.to_array().into_iter().try_for_each(|size| at_least_0("a side", size))?;
            if up.dot(*direction).abs() > UNIT {
                let Some(across) = up.reject_from_normalized(*direction).try_normalize() else {
                    return Err(format!("has its up along its direction, {direction}; give it another one"));
                };
                *up = across;
            }
        }
        LightShape::Line { from, to } => {
            finite("is from", *from)?;
            finite("is to", *to)?;
        }
        LightShape::Environment(environment) => environment.check()?,
    }
    Ok(made)
}

/// `how`: `is at`, to be followed by the place.
fn finite(how: &str, place: DVec3) -> Result<(), String> {
    if place.is_finite() { Ok(()) } else { Err(format!("{how} {place}; give it a finite place")) }
}

fn at_least_0(what: &str, size: f64) -> Result<(), String> {
    if size.is_finite() && size >= 0.0 {
        Ok(())
    } else {
        Err(format!("has {what} of {size} m; make it finite and at least 0"))
    }
}

fn make_unit(what: &str, direction: &mut DVec3) -> Result<(), String> {
    let length = direction.length();
    if (length - 1.0).abs() <= UNIT {
        return Ok(());
    }
    // Scaled first, since the square of a small number is 0.
    let largest = direction.abs().max_element();
    let scaled = (*direction / largest).try_normalize().filter(|_| direction.is_finite());
    *direction = scaled.ok_or_else(|| format!("has the {what} {direction}; give it a length, of 1 for choice"))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, Vec3};

    fn rect(direction: DVec3, up: DVec3) -> Light {
        let (position, size) = (DVec3::Y, DVec2::new(1.0, 2.0));
        Light::new(LightShape::Rect { position, direction, up, size, texture: None })
    }

    fn sun(direction: DVec3) -> Light {
        Light::new(LightShape::Directional { direction, angle_deg: 0.5 })
    }

    #[test]
    fn directions_get_unit_length() {
        for scale in [1e-300, 0.01, 2.0, 1e200] {
            assert_eq!(sun(DVec3::NEG_Y * scale).usable(), Ok(Some(sun(DVec3::NEG_Y))));
        }
        assert_eq!(sun(DVec3::NEG_Y).usable(), Ok(None));
        let in_single = Vec3::new(0.3, -0.8, 0.1).normalize().as_dvec3();
        assert_eq!(sun(in_single).usable(), Ok(None), "single precision is enough");
    }

    #[test]
    fn the_second_axis_of_a_rectangle_becomes_perpendicular() {
        let leaning = rect(DVec3::NEG_Y * 3.0, DVec3::new(0.0, 5.0, 7.0));
        assert_eq!(leaning.usable(), Ok(Some(rect(DVec3::NEG_Y, DVec3::Z))));
        let error = rect(DVec3::NEG_Y, DVec3::Y).usable().unwrap_err();
        assert!(error.contains("up along its direction"), "{error}");
    }

    #[test]
    fn what_can_not_shine_says_why() {
        let position = DVec3::new(f64::NAN, 0.0, 0.0);
        let spot = |inner_angle_deg, outer_angle_deg| {
            let (position, direction) = (DVec3::Y, DVec3::NEG_Y);
            LightShape::Spot { position, direction, inner_angle_deg, outer_angle_deg }
        };
        let rotation = DMat3::IDENTITY * 2.0;
        let rows = [
            (LightShape::Point { position }, "the point light is at [NaN, 0, 0]"),
            (LightShape::Sphere { position: DVec3::Y, radius: -1.0 }, "the sphere light has a radius of -1 m"),
            (LightShape::Sphere { position: DVec3::Y, radius: f64::INFINITY }, "a radius of inf m"),
            (LightShape::Directional { direction: DVec3::ZERO, angle_deg: 0.0 }, "has the direction [0, 0, 0]"),
            (LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: f64::NAN }, "is NaN° across"),
            (LightShape::Directional { direction: DVec3::INFINITY, angle_deg: 0.0 }, "has the direction [inf"),
            (spot(30.0, 20.0), "30° and 20°"),
            (spot(30.0, 90.0), "below 90°"),
            (LightShape::Ellipsoid { position: DVec3::Y, radii: DVec3::ONE, rotation }, "is no rotation"),
            (LightShape::Line { from: DVec3::Y, to: DVec3::INFINITY }, "the line light is to [inf"),
        ];
        for (shape, expected) in rows {
            let error = Light::new(shape).usable().unwrap_err();
            assert!(error.contains(expected), "{error} should say: {expected}");
        }
        let dim = Light { intensity: f32::NAN, ..sun(DVec3::NEG_Y) };
        assert!(dim.usable().unwrap_err().contains("gives off NaN"));
        let near = Light { range: Some(0.0), ..sun(DVec3::NEG_Y) };
        assert!(near.usable().unwrap_err().contains("a range of 0 m"));
    }
}

//! The light's extent as shaders read it.

use crate::shader::shader_struct;
use umbrage_core::LightShape;
use umbrage_core::glam::{DMat3, DVec3};

shader_struct! {
    /// The light as a surface, see `map_layers.wgsl`.
    pub(crate) struct LightExtent {
        right: [f32; 3],
        pad: f32,
        up: [f32; 3],
        pad_a: f32,
        ahead: [f32; 3],
        pad_b: f32,
        unit_right: [f32; 3],
        pad_c: f32,
        unit_up: [f32; 3],
        pad_d: f32,
        unit_ahead: [f32; 3],
        pad_e: f32,
    }
}

/// Narrowest half axis of a round light over its widest: what is flatter than that has no direction
/// of its own.
const FLATTEST: f64 = 1e-4;

/// True for lights that turn the same side to all receivers: spheres, and points, whatever kind of
/// light has shrunk to one.
pub(super) fn is_round(shape: &LightShape) -> bool {
    match *shape {
        LightShape::Directional { .. } => false,
        LightShape::Sphere { .. } | LightShape::Ellipsoid { .. } => true,
        _ => shape.radius() == 0.0,
    }
}

impl LightExtent {
    pub(super) fn of(shape: &LightShape) -> Self {
        match *shape {
            _ if is_round(shape) && shape.radius() == 0.0 => Self::round(DMat3::IDENTITY, DVec3::ZERO),
            LightShape::Point { .. } | LightShape::Spot { .. } => Self::round(DMat3::IDENTITY, DVec3::ZERO),
            LightShape::Directional { direction, angle_deg } => {
                let tangent = (angle_deg * 0.5).to_radians().clamp(0.0, 1.5).tan();
                let (right, up) = direction.any_orthonormal_pair();
                Self::flat(right * tangent, up * tangent, direction)
            }
            LightShape::Sphere { radius, .. } => Self::round(DMat3::IDENTITY, DVec3::splat(radius)),
            LightShape::Ellipsoid { radii, rotation, .. } => Self::round(rotation, radii),
            LightShape::Disc { direction, radius, .. } => {
                let (right, up) = direction.any_orthonormal_pair();
                Self::flat(right * radius, up * radius, direction)
            }
            LightShape::Rect { direction, up, size, .. } => {
                Self::flat(up.cross(direction) * (size.x * 0.5), up * (size.y * 0.5), direction)
            }
            LightShape::Line { from, to } => Self::flat((to - from) * 0.5, DVec3::ZERO, DVec3::ZERO),
            // No map shows it; this is the half of the sky around its middle.
            LightShape::Environment(_) => Self::round(DMat3::IDENTITY, DVec3::ONE),
        }
    }

    fn round(rotation: DMat3, radii: DVec3) -> Self {
        let widest = radii.max_element();
        // To where it is a sphere, times the widest radius; a light without extent is a sphere too.
        let narrow = if widest > 0.0 { (radii / widest).max(DVec3::splat(FLATTEST)) } else { DVec3::ONE };
        let axis = |i: usize| (rotation.col(i) * radii[i]).as_vec3().to_array();
        let unit = |i: usize| (rotation.col(i) / narrow[i]).as_vec3().to_array();
        Self {
            right: axis(0),
            up: axis(1),
            ahead: axis(2),
            unit_right: unit(0),
            unit_up: unit(1),
            unit_ahead: unit(2),
            ..Self::default()
        }
    }

    fn flat(right: DVec3, up: DVec3, normal: DVec3) -> Self {
        let [right, up, unit_ahead] = [right, up, normal].map(|v| v.as_vec3().to_array());
        Self { right, up, unit_ahead, ..Self::default() }
    }
}
